"""./ur plan: a plan without a robot, its figure, and the errors of a wrong file."""

import contextlib
import io
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import urllib.request

import pytest
from ur_tools import console, plan_goal
from ur_tools import plan as plan_module
from ur_tools.environment import program
from ur_tools.layout import Layout

BACKGROUND = True
ROOT = pathlib.Path(__file__).parents[2]
HOME = "[0.0, -1.57, 1.57, -1.57, -1.57, 0.0]"
PATH = f"""
blend_tolerance: 0.05
waypoints:
  - positions: {HOME}
  - positions: [0.6, -1.37, 1.37, -1.57, -1.57, 0.0]
  - {{positions: [0.6, -1.57, 1.57, -1.57, -1.57, 0.5]}}
"""
TIMED = f"""
trajectory:
  points:
    - {{positions: {HOME}}}
    - {{positions: [0.6, -1.37, 1.37, -1.57, -1.57, 0.0], time_from_start: {{sec: 2}}}}
"""
FAST = "time_from_start: {sec: 1, nanosec: 200000000}"


def command(tmp_path, text, *options):
    """Returns the command and its environment. The program runs directly, because ./ur would build first."""
    file = tmp_path / "plan.yaml"
    file.write_text(text)
    env = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT / "tools"), os.environ.get("PYTHONPATH", "")])}
    return [sys.executable, "-u", "-m", "ur_tools.plan", str(file), *map(str, options)], env


def plan(tmp_path, text, *options):
    program_and_arguments, env = command(tmp_path, text, *options)
    return subprocess.run(program_and_arguments, env=env, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=300)


@pytest.fixture
def rejection(tmp_path, monkeypatch):
    """Returns a function that plans in this process, which saves the start of two Pythons, and returns the printed error."""

    def convert(_layout, options, _env):
        output, error = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(error):
            code = plan_goal.main(str(options.file), options.model)
        if code != 0:
            raise console.Failure(error.getvalue().strip())
        return output.getvalue()

    def run(text):
        (tmp_path / "plan.yaml").write_text(text)
        monkeypatch.chdir(tmp_path)
        monkeypatch.setattr(plan_module, "_goal_as_json", convert)
        with pytest.raises(console.Failure) as failure:
            plan_module.run(plan_module.parse(["plan.yaml"]), Layout.of_environment())
        return str(failure.value)

    return run


def test_plans_and_draws_a_path(tmp_path):
    result = plan(tmp_path, PATH, "--model", "ur10e", "--plot", tmp_path / "plan.png", "--json", tmp_path / "plan.json")
    assert result.returncode == 0, result.stdout
    assert "3 waypoints" in result.stdout and "largest use of the limits" in result.stdout
    assert (tmp_path / "plan.png").read_bytes().startswith(b"\x89PNG")
    samples = json.loads((tmp_path / "plan.json").read_text())["samples"]
    assert samples["position"][0] == pytest.approx([0.0, -1.57, 1.57, -1.57, -1.57, 0.0])
    assert samples["velocity"][-1] == [0.0] * 6
    assert max(abs(value) for row in samples["jerk"] for value in row) <= 100.0


def test_plans_the_documented_file(tmp_path):
    page = (ROOT / "docs" / "use" / "trajectory.md").read_text()
    text, = re.findall(r"```yaml\n(.*?)```", page, re.S)
    result = plan(tmp_path, text)
    assert result.returncode == 0 and "3 waypoints" in result.stdout, result.stdout


def test_keeps_the_given_times(tmp_path):
    result = plan(tmp_path, TIMED)
    assert result.returncode == 0 and "2 waypoints, 2.000 s" in result.stdout, result.stdout


def velocities(tmp_path, text):
    result = plan(tmp_path, text, "--model", "ur10e", "--json", tmp_path / "plan.json")
    assert result.returncode == 0, result.stdout
    return [abs(value) for row in json.loads((tmp_path / "plan.json").read_text())["samples"]["velocity"] for value in row]


def test_default_limits_are_slow_and_given_limits_and_times_may_be_faster(tmp_path):
    far = f"waypoints:\n  - positions: {HOME}\n  - positions: [1.2, -1.57, 1.57, -1.57, -1.57, 0.0]\n"
    assert 1.0 < max(velocities(tmp_path, far)) <= 1.05
    assert 1.7 < max(velocities(tmp_path, far + "max_velocity: [1.8, 1.8, 1.8, 1.8, 1.8, 1.8]\n"
                                "max_acceleration: [5, 5, 5, 5, 5, 5]\n")) <= 1.8
    assert 1.3 < max(velocities(tmp_path, TIMED.replace("time_from_start: {sec: 2}", FAST).replace("0.6", "0.9")))


INVALID = [
    ("waypoints: [{positions: [0, 0, 0]}]", "plan.yaml: waypoint 0 has 3 values"),
    ("waypoint: []", "plan.yaml:1: there is no field waypoint; did you mean waypoints?"),
    (f"waypoints:\n  - {HOME}",
     "plan.yaml:2: waypoints[0] is [0.0, -1.57, 1.57, -1.57, -1.57, 0.0]: expected a mapping of fields: positions"),
    ("model: ur10e", "plan.yaml: there is no field model: use the option --model"),
    ("", "plan.yaml: "),
    (PATH + "max_velocity: [1, 1, 0, 1, 1, 1]", "max_velocity[2] (elbow_joint) is 0 rad/s, it must be above 0"),
    (PATH + "max_acceleration: [1, 1, 1, 1, 1, 1000000]", "max_acceleration[5] (wrist_3_joint) is 1000000 rad/s^2, it must be above 0"),
    (PATH + "speed_fraction: 0.001", "speed_fraction is 0.001, it must be at least 0.01 and at most 1"),
    (PATH + "max_velocity: [1, 1, x, 1, 1, 1]", "plan.yaml:7: max_velocity[2] is 'x': expected a number"),
    (PATH + "gain: fast", "plan.yaml:7: gain is 'fast'"),
    (TIMED.replace("{sec: 2}", "{nanosec: 100000000}"), " of shoulder_pan_joint is "),
    (TIMED.replace(f"{{positions: {HOME}}}", f"{{positions: {HOME}, time_from_start: {{sec: 1}}}}"), "points[0].time_from_start is 1 s"),
    (TIMED.replace(HOME, "[0, 0]"), "trajectory.points[0].positions has 2 values: expected 6"),
    (TIMED + "  joint_names: [a, b]", "trajectory.joint_names is a, b: expected shoulder_pan_joint, "),
    ("trajectory: {}", "trajectory.points is empty"),
    ("waypoints: [", "not YAML"),
    ("waypoints: []\nwaypoints: []", "plan.yaml:2: not YAML: the field waypoints is given twice"),
    ("7", "plan.yaml:1: the goal is 7: expected a mapping"),
]


def test_an_invalid_goal_is_rejected_with_the_reason(rejection):
    for text, what in INVALID:
        found = rejection(text)
        assert what in found and "json" not in found.lower() and found.count("plan.yaml") == 1, (text, found)


def test_the_program_prints_the_reason_of_a_rejection(tmp_path):
    for text, what in (("waypoints: [", "not YAML"), (PATH + "max_velocity: [1, 1, 0, 1, 1, 1]", "max_velocity[2] (elbow_joint) is 0")):
        result = plan(tmp_path, text)
        assert result.returncode == 1 and what in result.stdout, result.stdout
        assert "Traceback" not in result.stdout and "json" not in result.stdout.lower() and result.stdout.count("plan.yaml") == 1


def test_a_missing_file_is_reported(tmp_path):
    result = plan(tmp_path, PATH, "--model", "ur99")
    assert result.returncode == 1 and 'model is "ur99"' in result.stdout, result.stdout
    result = subprocess.run([sys.executable, "-m", "ur_tools.plan", "nowhere.yaml"], cwd=ROOT / "tools", stdout=subprocess.PIPE,
                            text=True, timeout=300)
    assert result.returncode == 1 and "nowhere.yaml: No such file" in result.stdout, result.stdout


def test_accepts_joints_in_any_order_and_with_a_prefix(tmp_path):
    names = ["left_elbow_joint", "left_shoulder_pan_joint", *(f"left_{name}_joint" for name in
             ("shoulder_lift", "wrist_1", "wrist_2", "wrist_3"))]
    points = "".join(f"    - {{positions: [1.57, {pan}, -1.57, 0, 0, 0], time_from_start: {{sec: {time}}}}}\n"
                     for time, pan in enumerate((0.0, 0.3)))
    result = plan(tmp_path, f"trajectory:\n  joint_names: [{', '.join(names)}]\n  points:\n{points}", "--json", tmp_path / "plan.json")
    assert result.returncode == 0, result.stdout
    positions = json.loads((tmp_path / "plan.json").read_text())["samples"]["position"]
    assert positions[0] == pytest.approx([0.0, -1.57, 1.57, 0.0, 0.0, 0.0])
    assert positions[-1] == pytest.approx([0.3, -1.57, 1.57, 0.0, 0.0, 0.0])


def test_the_file_has_the_format_of_an_action_goal(tmp_path):
    """`ur call` accepts the file, and `./ur plan` accepts the output of `ur call --show`."""
    for action, text in (("execute_trajectory", PATH), ("execute_parametrized_trajectory", TIMED)):
        first = plan(tmp_path, text).stdout
        command = [str(program(Layout.of_environment(), "ur_ros_rtde_cli", "ur")), "call", action, "--show", "--file", "plan.yaml"]
        shown = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=300)
        assert shown.returncode == 0, shown.stderr
        second = plan(tmp_path, shown.stdout).stdout
        assert first.split(", planned")[0] == second.split(", planned")[0] and " waypoints, " in first, (first, second)


def test_shows_the_plan_in_the_browser_until_ctrl_c(tmp_path):
    program_and_arguments, env = command(tmp_path, PATH, "--model", "ur10e", "--view")
    with subprocess.Popen(program_and_arguments, env=env, cwd=tmp_path, stdout=subprocess.PIPE, text=True) as running:
        address = next((match for line in running.stdout if (match := re.search(r"viewer runs at (\S+) until", line))), None)
        try:
            assert address is not None
            with urllib.request.urlopen(address.group(1), timeout=60) as page:
                assert b"<html" in page.read()
        finally:
            running.send_signal(signal.SIGINT)
        assert running.wait(60) == 130


def test_files_that_cannot_be_written_are_reported_before_the_build(run_without_build, tmp_path):
    for options, status, text in ((("--json", "/missing/x.json"), 1, "/missing/x.json cannot be written: there is no folder /missing"),
                                  (("--plot", "/missing/x.png"), 1, "/missing/x.png cannot be written: there is no folder /missing"),
                                  (("--plot", "x.txt"), 2, "--plot x.txt: the name of a figure ends with .png, .pdf, .svg"),
                                  (("--plot", "plan"), 2, "--plot plan: the name of a figure ends with .png, .pdf, .svg")):
        code, output = run_without_build("plan", tmp_path / "plan.yaml", *options)
        assert code == status and text in output, output


def test_a_file_that_cannot_be_written_is_reported(tmp_path):
    for name in ("plan.json", "plan.png"):
        (tmp_path / name).mkdir()
        result = plan(tmp_path, PATH, "--model", "ur10e", f"--{'json' if name == 'plan.json' else 'plot'}", name)
        assert result.returncode == 1 and name in result.stdout and "Is a directory" in result.stdout, result.stdout
        assert "Traceback" not in result.stdout


def test_a_page_needs_the_model_of_the_arm(tmp_path):
    result = plan(tmp_path, PATH, "--view")
    assert result.returncode == 2 and "--model" in result.stdout
