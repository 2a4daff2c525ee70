"""The environment in which programs run."""

import pathlib
import subprocess
import sys

import pytest
from ur_tools.environment import run_environment
from ur_tools.layout import Layout

PARTICIPANT = "import rclpy; rclpy.init(); rclpy.create_node('reader_of_profiles'); rclpy.shutdown()"


def said_with(profiles):
    env = {**run_environment(Layout.of_environment()), "FASTDDS_DEFAULT_PROFILES_FILE": str(profiles)}
    result = subprocess.run([sys.executable, "-c", PARTICIPANT], env=env, capture_output=True, text=True, timeout=60)
    return result.stdout + result.stderr


def test_the_profiles_for_fast_dds_are_set_and_understood(tmp_path):
    if Layout.of_environment().ros != "kilted":
        pytest.skip("they are written for Fast DDS 3")
    profiles = pathlib.Path(run_environment(Layout.of_environment())["FASTDDS_DEFAULT_PROFILES_FILE"])
    assert "XML" not in said_with(profiles)
    wrong = tmp_path / "wrong.xml"
    wrong.write_text(profiles.read_text().replace("heartbeat_period", "heart_period"))
    assert "XML" in said_with(wrong)


def test_profiles_of_the_users_own_are_kept(monkeypatch):
    monkeypatch.setenv("FASTDDS_DEFAULT_PROFILES_FILE", "mine.xml")
    assert run_environment(Layout.of_environment())["FASTDDS_DEFAULT_PROFILES_FILE"] == "mine.xml"
