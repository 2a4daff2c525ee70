"""Checks messages from YAML and the error messages."""

import math
import pathlib

import pytest
from geometry_msgs.msg import Inertia
from std_msgs.msg import Int8, UInt8MultiArray
from ur_ros_rtde_cli import fields
from ur_ros_rtde_cli.errors import CliError

from ur_ros_rtde_msgs.action import DashboardText, ExecuteParametrizedTrajectory, ExecuteTrajectory, ForceMode, MoveJ, SetDigitalOutput

BACKGROUND = True


def read(text, message):
    return fields.Document(text).fill(message)


@pytest.mark.parametrize("text, value", [("1", 1.0), ("1e-3", 0.001), ("-2E3", -2000.0), ("inf", math.inf), ("-inf", -math.inf),
                                         (".inf", math.inf), ("+.5", 0.5), ("-Infinity", -math.inf)])
def test_accepts_common_notations_of_numbers(text, value):
    assert read(f"speed: {text}", MoveJ.Goal()).speed == value
    assert list(read(f"joint_positions: [{text}]", MoveJ.Goal()).joint_positions) == [value]


@pytest.mark.parametrize("text", ["nan", ".nan", ".NaN", "NaN", "-nan"])
def test_nan_is_a_number(text):
    assert math.isnan(read(f"speed: {text}", MoveJ.Goal()).speed)


def test_0_and_1_are_false_and_true():
    assert list(read("compliant: [0, 1, false, true, 0, 1]", ForceMode.Goal()).compliant) == [False, True] * 3


def test_omitted_fields_keep_their_values():
    goal = read("", MoveJ.Goal(acceleration=3.0))
    assert (goal.speed, goal.acceleration) == (0.5, 3.0)


def test_reads_nested_messages_and_lists_of_messages():
    goal = read("trajectory: {joint_names: [a], points: [{positions: [1], time_from_start: {sec: 2}}]}",
                ExecuteParametrizedTrajectory.Goal())
    point, = goal.trajectory.points
    assert (list(point.positions), point.time_from_start.sec, goal.trajectory.joint_names) == ([1.0], 2, ["a"])


@pytest.mark.parametrize("message, text, expected", [
    (MoveJ.Goal, "speed: true", "speed is True: expected a number"),
    (MoveJ.Goal, "speed: 1.2.3", "speed is '1.2.3': expected a number"),
    (MoveJ.Goal, "speed:", "speed is None: expected a number"),
    (MoveJ.Goal, "joint_positions: [0, fast]", "joint_positions[1] is 'fast': expected a number"),
    (MoveJ.Goal, "joint_positions: {a: 1}", "joint_positions is {'a': 1}: expected a list of numbers"),
    (MoveJ.Goal, "[1]", "the goal is [1]: expected a mapping of fields, as in {speed: 0.5}"),
    (ForceMode.Goal, "compliant: [true]", "compliant has 1 values: expected a list of 6 boolean values"),
    (ForceMode.Goal, "compliant: [1, 0, 2, 1, 1, 1]", "compliant[2] is 2: expected true or false"),
    (SetDigitalOutput.Goal, "pin: 256", "pin is 256: expected an integer from 0 to 255"),
    (SetDigitalOutput.Goal, "pin: -1", "pin is -1: expected an integer from 0 to 255"),
    (SetDigitalOutput.Goal, "pin: 1.0", "pin is 1.0: expected an integer from 0 to 255"),
    (SetDigitalOutput.Goal, "pin: true", "pin is True: expected an integer from 0 to 255"),
    (SetDigitalOutput.Goal, "state: on it", "state is 'on it': expected true or false"),
    (Int8, "data: 128", "data is 128: expected an integer from -128 to 127"),
    (UInt8MultiArray, "data: [256]", "data[0] is 256: expected an integer from 0 to 255"),
    (DashboardText.Goal, "text: 5", "text is 5: expected a string; put it in quotes"),
    (ExecuteTrajectory.Goal, "waypoints: [[0, 1]]", "waypoints[0] is [0, 1]: expected a mapping of fields: positions"),
    (ExecuteTrajectory.Goal, "waypoints: {positions: []}", "expected a list of ur_ros_rtde_msgs/JointWaypoint"),
    (ExecuteTrajectory.Goal, "waypoints: [{position: []}]", "there is no field waypoints[0].position; did you mean positions?"),
    (ExecuteTrajectory.Goal, "1: 2", "there is no field [1]. The fields are: waypoints, "),
    (Inertia, "com: {x: [1]}", "com.x is [1]: expected a number"),
    (MoveJ.Goal, "speed: 1\nspeed: 2", "the field speed is given twice"),
    (MoveJ.Goal, "speed: 1\n---\nspeed: 2", "not YAML: "),
    (MoveJ.Goal, "joint_positions: &a [*a]", "joint_positions[0] is [[...]]: expected a number"),
    (MoveJ.Goal, "joint_positions: *a", "undefined alias"),
    (MoveJ.Goal, "speed: !!python/object:os.system 1", "not YAML: "),
    (MoveJ.Goal, "{speed: [", "not YAML: line "),
    (MoveJ.Goal, "speed: \x00", "not YAML"),
])
def test_an_error_states_field_value_and_expected_type(message, text, expected):
    with pytest.raises(CliError) as error:
        read(text, message())
    assert expected in str(error.value)


@pytest.mark.parametrize("text, line, expected", [
    ("# a path\nwaypoints:\n  - {positions: [0]}\n  - {positions: [1, x]}\n", 4, "waypoints[1].positions[1] is 'x'"),
    ("waypoints:\n  - positions: [0]\n\n  - sped: 1\n", 4, "no field waypoints[1].sped"),
    ("waypoints: []\n\nspeed_fraction: x\n", 3, "speed_fraction is 'x'"),
    ("waypoints: []\ngain:\n  [1,\n   2]\n", 2, "gain is [1, 2]"),
    ("waypoints: [\n  {positions: [0]}\n  {positions: [0]}\n]\n", 3, "not YAML"),
    ("gain: 1\nwaypoints: []\ngain: 2\n", 3, "gain is given twice"),
    ("gain: 1\n\tgain: 2\n", 2, "not YAML"),
    ("7\n", 1, "expected a mapping"),
])
def test_an_error_in_a_file_states_file_and_line(tmp_path, text, line, expected):
    file = tmp_path / "goal.yaml"
    file.write_text(text)
    with pytest.raises(CliError) as error:
        fields.read_file(file, ExecuteTrajectory.Goal())
    assert str(error.value).startswith(f"{file}:{line}: ") and expected in str(error.value)


@pytest.mark.parametrize("content, expected", [(None, "No such file"), (b"\xff\xfe", "is not a text file")])
def test_an_unreadable_file_is_reported(tmp_path, content, expected):
    file = pathlib.Path(tmp_path, "goal.yaml")
    if content is not None:
        file.write_bytes(content)
    with pytest.raises(CliError) as error:
        fields.read_file(file, MoveJ.Goal())
    assert str(file) in str(error.value) and expected in str(error.value)


def test_printed_messages_can_be_read_back():
    goal = ForceMode.Goal(compliant=[True, False, True, False, False, False])
    assert read(fields.to_yaml(goal), ForceMode.Goal()) == goal
    assert "\n" not in fields.to_yaml_line(goal) and read(fields.to_yaml_line(goal), ForceMode.Goal()) == goal
