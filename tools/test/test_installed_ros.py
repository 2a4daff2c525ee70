"""`./ur --ros installed`: the distribution whose setup script has been sourced takes the place of the wheels."""

import os

import pytest
from ur_tools import build, console, docs, venv
from ur_tools.environment import build_environment, run_environment
from ur_tools.layout import INSTALLED, Layout, sourced
from ur_tools.packages import discover_with_interfaces

BACKGROUND = True


@pytest.fixture
def setup_script(monkeypatch, tmp_path):
    """The variables that the setup script of an installation sets. Returns a function that sources that of a distribution."""
    def source(distribution):
        for name in ("ROS_WHEELS_PREFIX", "_ROS_WHEELS_BOOTSTRAP_COMPLETE", "UR_LAYOUT", "UR_PYTHON"):
            monkeypatch.delenv(name, raising=False)
        for name, folder in (("AMENT_PREFIX_PATH", ""), ("LD_LIBRARY_PATH", "lib"), ("PYTHONPATH", "python")):
            monkeypatch.setenv(name, str(tmp_path / folder))
        monkeypatch.setenv("ROS_DISTRO", distribution)
        return tmp_path

    return source


def test_a_sourced_distribution_is_the_default(setup_script, monkeypatch):
    setup_script("humble")
    assert Layout.of_environment() == Layout(INSTALLED) and Layout(INSTALLED).base.name == "installed_humble"
    monkeypatch.setenv("ROS_WHEELS_PREFIX", "/venv")  # our own shell
    assert sourced() == "" and Layout.of_environment() == Layout()


def test_its_variables_are_kept_behind_ours(setup_script):
    prefix = setup_script("humble")
    layout = Layout(INSTALLED)
    env = run_environment(layout)
    assert env["AMENT_PREFIX_PATH"] == f"{layout.install}{os.pathsep}{prefix}"
    assert env["LD_LIBRARY_PATH"] == f"{layout.install / 'lib'}{os.pathsep}{prefix / 'lib'}"
    assert env["PYTHONPATH"].endswith(f"{os.pathsep}{prefix / 'python'}") and env["ROS_DISTRO"] == "humble"
    assert build_environment(layout, 1)["PYTHONPATH"] == str(prefix / "python")
    assert not {"ROS_WHEELS_PREFIX", "_ROS_WHEELS_BOOTSTRAP_COMPLETE"} & env.keys()


def test_its_variables_do_not_reach_the_wheels(setup_script):
    prefix = setup_script("humble")
    env = run_environment(Layout("kilted"))
    assert env["ROS_DISTRO"] == "kilted" and not [name for name, value in env.items() if str(prefix) in value.split(os.pathsep)]


def test_the_build_is_not_adapted_to_wheels(setup_script):
    setup_script("humble")
    arguments = " ".join(build.cmake_arguments(build.Options(Layout(INSTALLED)), False))
    assert "wheels" not in arguments.lower() and "wheels" in " ".join(build.cmake_arguments(build.Options(Layout("kilted")), False)).lower()


def test_interfaces_that_it_has_are_not_built(setup_script):
    prefix = setup_script("humble")
    manifest = prefix / "share" / "tf2_msgs" / "package.xml"
    manifest.parent.mkdir(parents=True)
    manifest.write_text("<package/>")
    found = discover_with_interfaces([str(prefix)])
    assert "control_msgs" in found and "tf2_msgs" not in found and "tf2_msgs" in discover_with_interfaces()


def test_another_distribution_is_rejected(setup_script):
    for distribution, found in (("foxy", "ROS 2 foxy is sourced"), ("", "No ROS 2 is sourced")):
        setup_script(distribution)
        with pytest.raises(console.Failure) as failure:
            venv.python_of_ros(Layout(INSTALLED))
        text = str(failure.value)
        assert found in text and "humble, jazzy, kilted, lyrical, rolling" in text and "--ros jazzy" in text, text


def test_its_python_builds_the_site(monkeypatch, tmp_path):
    """That of Lyrical is newer than those that the wheels exist for."""
    python = tmp_path / "python3.14"
    python.write_text(f'#!/bin/sh\n[ "$1" = -c ] && echo "3.14 1" || echo "$@" > "{tmp_path}/created"\n')
    python.chmod(0o755)
    monkeypatch.setattr(venv, "_candidates", lambda: [str(python)])
    monkeypatch.setattr(docs, "FOLDER", tmp_path / "docs")
    monkeypatch.setattr(docs.pins, "install", lambda *_: (tmp_path / "docs" / "venv").mkdir(parents=True))
    docs.ensure_sphinx()
    assert (tmp_path / "created").read_text() == f"-m venv {tmp_path}/docs/venv\n"
    with pytest.raises(console.Failure, match="The ROS 2 wheels need Python 3.10 to 3.12(.|\n)*is 3.14"):
        venv.find_python()


def test_a_python_without_its_rclpy_is_rejected(setup_script, monkeypatch, tmp_path):
    setup_script("humble")
    python = tmp_path / "python3"
    python.write_text("#!/bin/sh\necho 'No module named rclpy'; exit 1\n")
    python.chmod(0o755)
    monkeypatch.setenv("UR_PYTHON", str(python))
    with pytest.raises(console.Failure, match="No module named rclpy(.|\n)*UR_PYTHON"):
        venv.python_of_ros(Layout(INSTALLED))
