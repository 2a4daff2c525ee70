"""`./ur plan`: a plan without a robot, its figure, and what it says to a bad file."""

import json
import os
import pathlib
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).parents[2]
HOME = "[0.0, -1.57, 1.57, -1.57, -1.57, 0.0]"
PATH = f"""
model: ur10e
blend_tolerance: 0.05
waypoints:
  - {HOME}
  - [0.6, -1.37, 1.37, -1.57, -1.57, 0.0]
  - [0.6, -1.57, 1.57, -1.57, -1.57, 0.5]
"""
TIMED = f"""
points:
  - {{time: 0.0, positions: {HOME}}}
  - {{time: 2.0, positions: [0.6, -1.37, 1.37, -1.57, -1.57, 0.0]}}
"""


def plan(tmp_path, text, *options):
    """Without ./ur in front, which would build."""
    file = tmp_path / "plan.yaml"
    file.write_text(text)
    env = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT / "tools"), os.environ.get("PYTHONPATH", "")])}
    return subprocess.run([sys.executable, "-m", "ur_tools.plan", str(file), *map(str, options)], env=env, cwd=tmp_path,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60)


def test_a_path_is_planned_and_drawn(tmp_path):
    result = plan(tmp_path, PATH, "--plot", tmp_path / "plan.png", "--json", tmp_path / "plan.json")
    assert result.returncode == 0, result.stdout
    assert "3 waypoints" in result.stdout and "largest use of the limits" in result.stdout
    assert (tmp_path / "plan.png").read_bytes().startswith(b"\x89PNG")
    samples = json.loads((tmp_path / "plan.json").read_text())["samples"]
    assert samples["position"][0] == pytest.approx([0.0, -1.57, 1.57, -1.57, -1.57, 0.0])
    assert samples["velocity"][-1] == [0.0] * 6
    assert max(abs(value) for row in samples["jerk"] for value in row) <= 100.0


def test_given_times_are_kept(tmp_path):
    result = plan(tmp_path, TIMED)
    assert result.returncode == 0 and "2 waypoints, 2.000 s" in result.stdout, result.stdout


def velocities(tmp_path, text):
    result = plan(tmp_path, text, "--json", tmp_path / "plan.json")
    assert result.returncode == 0, result.stdout
    return [abs(value) for row in json.loads((tmp_path / "plan.json").read_text())["samples"]["velocity"] for value in row]


def test_a_path_without_limits_is_slow_and_given_times_are_a_choice(tmp_path):
    far = f"model: ur10e\nwaypoints:\n  - {HOME}\n  - [1.2, -1.57, 1.57, -1.57, -1.57, 0.0]\n"
    assert 1.0 < max(velocities(tmp_path, far)) <= 1.05
    assert 1.7 < max(velocities(tmp_path, far + "max_velocity: [1.8, 1.8, 1.8, 1.8, 1.8, 1.8]\n"
                                "max_acceleration: [5, 5, 5, 5, 5, 5]\n")) <= 1.8
    assert 1.3 < max(velocities(tmp_path, TIMED.replace("2.0", "1.2").replace("0.6", "0.9")))


@pytest.mark.parametrize("text, what", [
    ("waypoints: [[0, 0, 0]]", "waypoint 0 has 3 values"),
    ("model: ur99\nwaypoints: [[0, 0, 0, 0, 0, 0]]", "ur99"),
    ("waypoint: []", "there is no field waypoint"),
    ("model: ur10e", "give either waypoints"),
    (PATH + "max_velocity: [1, 1, 0, 1, 1, 1]", "velocity limit of elbow_joint is 0"),
    (TIMED.replace("2.0", "0.1"), " of shoulder_pan_joint is "),
    ("waypoints: [", "while parsing"),
])
def test_what_cannot_be_planned_is_refused_with_the_reason(tmp_path, text, what):
    result = plan(tmp_path, text)
    assert result.returncode == 1 and what in result.stdout, result.stdout


def test_the_help_needs_no_build():
    result = subprocess.run([sys.executable, str(ROOT / "ur"), "plan", "--help"], stdout=subprocess.PIPE, text=True, timeout=60)
    assert result.returncode == 0 and "--plot" in result.stdout and "blend_tolerance" in result.stdout
