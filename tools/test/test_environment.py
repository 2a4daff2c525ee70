"""The environment of the programs that `./ur` starts."""

import os
import pathlib
import subprocess
import sys

import pytest
from ur_tools.environment import FASTDDS_PROFILES, build_environment, run_environment, shell_environment, workspace_environment
from ur_tools.layout import INSTALLED, Layout

BACKGROUND = True
PARTICIPANT = "import rclpy; rclpy.init(); rclpy.create_node('reader_of_profiles'); rclpy.shutdown()"
VARIABLES = tuple(FASTDDS_PROFILES)
HEARTBEAT = {"FASTDDS_DEFAULT_PROFILES_FILE": "heartbeat_period", "FASTRTPS_DEFAULT_PROFILES_FILE": "heartbeatPeriod"}


@pytest.fixture
def layout(monkeypatch):
    for variable in VARIABLES:
        monkeypatch.delenv(variable, raising=False)
    return Layout.of_environment()


def output_with(variable, profiles):
    env = {name: value for name, value in os.environ.items() if name not in VARIABLES}
    result = subprocess.run([sys.executable, "-c", PARTICIPANT], env={**env, variable: str(profiles)}, capture_output=True,
                            text=True, timeout=300)
    return result.stdout + result.stderr


def test_sets_a_valid_fast_dds_profile(layout, tmp_path):
    env = run_environment(layout)
    variable, = (name for name in VARIABLES if name in env)
    profiles = pathlib.Path(env[variable])
    assert output_with(variable, profiles) == ""
    wrong = tmp_path / "wrong.xml"
    wrong.write_text(profiles.read_text().replace(HEARTBEAT[variable], "heart_period"))
    assert "XML" in output_with(variable, wrong)


def test_nodes_on_other_hosts_are_found_only_if_the_user_asks_for_it(layout, monkeypatch):
    monkeypatch.delenv("ROS_AUTOMATIC_DISCOVERY_RANGE", raising=False)
    assert workspace_environment(layout)["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "LOCALHOST"
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET")
    assert workspace_environment(layout)["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "SUBNET"


def test_keeps_the_profile_of_the_user(layout, monkeypatch):
    for variable in VARIABLES:
        with monkeypatch.context() as user:
            user.setenv(variable, "mine.xml")
            env = run_environment(layout)
        assert {name: env.get(name) for name in VARIABLES} == {**dict.fromkeys(VARIABLES), variable: "mine.xml"}


@pytest.mark.parametrize("user, localhost_only", [({}, "1"), ({"ROS_LOCALHOST_ONLY": "0"}, "0")])
def test_on_humble_another_variable_does_so(monkeypatch, user, localhost_only):
    monkeypatch.delenv("ROS_WHEELS_PREFIX", raising=False)
    monkeypatch.delenv("ROS_LOCALHOST_ONLY", raising=False)
    for name, value in {"AMENT_PREFIX_PATH": "/opt/ros/humble", "ROS_DISTRO": "humble", **user}.items():
        monkeypatch.setenv(name, value)
    assert run_environment(Layout(INSTALLED))["ROS_LOCALHOST_ONLY"] == localhost_only
    assert "ROS_LOCALHOST_ONLY" not in run_environment(Layout("jazzy"))


def test_variables_that_select_tests_or_a_repository_are_removed(layout, monkeypatch):
    removed = {"GTEST_FILTER": "None.*", "PYTEST_ADDOPTS": "-k none", "GIT_DIR": "/home/.git", "GIT_INDEX_FILE": "/home/.git/index.lock"}
    kept = {"GIT_AUTHOR_NAME": "a", "GIT_SSL_CAINFO": "/etc/ca.pem"}
    for name, value in {**removed, **kept}.items():
        monkeypatch.setenv(name, value)
    for env in (build_environment(layout, 1), run_environment(layout)):
        assert not removed.keys() & env.keys() and kept.items() <= env.items()


def test_only_a_shell_writes_and_only_what_has_changed(tmp_path, monkeypatch):
    """`./ur call stop` has to work on a full disk."""
    monkeypatch.setattr("ur_tools.layout.STATE", tmp_path)
    layout = Layout("kilted")
    assert "COLCON_DEFAULTS_FILE" not in workspace_environment(layout) and not layout.base.exists()
    layout.base.mkdir()
    file = pathlib.Path(shell_environment(layout)["COLCON_DEFAULTS_FILE"])
    os.utime(file, (0, 0))
    shell_environment(layout)
    assert file.stat().st_mtime == 0
    file.write_text("{}")
    shell_environment(layout)
    assert "ROS_WHEELS_PREFIX" in file.read_text()
