"""The environment of the programs that `./ur` starts."""

import os
import pathlib
import subprocess
import sys

import pytest
from ur_tools.environment import FASTDDS_PROFILES, run_environment, workspace_environment
from ur_tools.layout import Layout

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
