"""Checks which Fast DDS profile `ur` uses."""

import os
import pathlib

import pytest
from ur_ros_rtde_cli import fastdds_profile

VARIABLES = [variable for variable, _, _ in fastdds_profile.SOURCES]
LOCAL_FILES = [local_file for _, local_file, _ in fastdds_profile.SOURCES]


@pytest.fixture(autouse=True)
def no_profile(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    for variable in VARIABLES:
        monkeypatch.setenv(variable, "")  # restored after the test
        monkeypatch.delenv(variable)


def selected_profiles():
    return {variable: os.environ[variable] for variable in VARIABLES if variable in os.environ}


def test_uses_the_profile_of_the_package():
    fastdds_profile.use()
    file, = selected_profiles().values()
    assert "leaseDuration" in pathlib.Path(file).read_text()


@pytest.mark.parametrize("variable", VARIABLES)
def test_keeps_a_profile_in_the_environment(monkeypatch, variable):
    monkeypatch.setenv(variable, "mine.xml")
    fastdds_profile.use()
    assert selected_profiles() == {variable: "mine.xml"}


@pytest.mark.parametrize("name", LOCAL_FILES)
def test_keeps_a_profile_in_the_working_directory(name):
    pathlib.Path(name).touch()
    fastdds_profile.use()
    assert selected_profiles() == {}


def test_sets_no_profile_without_an_installed_driver(monkeypatch):
    monkeypatch.setenv("AMENT_PREFIX_PATH", "/nowhere")
    fastdds_profile.use()
    assert selected_profiles() == {}
