"""Which Fast DDS profile `ur` uses."""

import os
import pathlib

import pytest
from ur_ros_rtde_cli import fastdds_profile

VARIABLES = [variable for variable, _, _ in fastdds_profile.SOURCES]
LOCAL_FILES = [local_file for _, local_file, _ in fastdds_profile.SOURCES]


@pytest.fixture(autouse=True)
def nothing_chosen(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    for variable in VARIABLES:
        monkeypatch.setenv(variable, "")  # so that it is restored afterwards
        monkeypatch.delenv(variable)


def chosen():
    return {variable: os.environ[variable] for variable in VARIABLES if variable in os.environ}


def test_the_profile_of_the_package_is_used():
    fastdds_profile.use()
    file, = chosen().values()
    assert "leaseDuration" in pathlib.Path(file).read_text()


@pytest.mark.parametrize("variable", VARIABLES)
def test_a_profile_in_the_environment_is_kept(monkeypatch, variable):
    monkeypatch.setenv(variable, "mine.xml")
    fastdds_profile.use()
    assert chosen() == {variable: "mine.xml"}


@pytest.mark.parametrize("name", LOCAL_FILES)
def test_a_profile_in_the_working_directory_is_kept(name):
    pathlib.Path(name).touch()
    fastdds_profile.use()
    assert chosen() == {}


def test_without_the_driver_on_this_machine_nothing_is_set(monkeypatch):
    monkeypatch.setenv("AMENT_PREFIX_PATH", "/nowhere")
    fastdds_profile.use()
    assert chosen() == {}
