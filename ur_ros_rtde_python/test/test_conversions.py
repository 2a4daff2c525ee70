"""Converts numpy arrays to goals, and recordings to numpy arrays. Needs no robot."""

import numpy as np
import pytest
from ur_ros_rtde import pose, read_recording, trajectory
from ur_ros_rtde.commands import _goal_message
from ur_ros_rtde.conversions import interface, numbers
from ur_ros_rtde.errors import Rejected

BACKGROUND = True
QUARTER = np.sqrt(0.5)


def goal(name, **fields):
    return _goal_message(name, interface(f"ur_ros_rtde_msgs/action/{name}"), (), fields)


def test_a_pose_has_a_quaternion_or_a_rotation_vector():
    assert np.allclose(pose([1, 2, 3]), [1, 2, 3, 0, 0, 0, 1])
    assert np.allclose(pose([1, 2, 3], [0, 0, np.pi / 2]), [1, 2, 3, 0, 0, QUARTER, QUARTER])
    assert np.allclose(pose([1, 2, 3], [0, 0, 0]), [1, 2, 3, 0, 0, 0, 1])
    assert np.allclose(pose([1, 2, 3], [QUARTER, 0, 0, QUARTER]), [1, 2, 3, QUARTER, 0, 0, QUARTER])
    with pytest.raises(ValueError, match="orientation has 2 numbers"):
        pose([1, 2, 3], [1, 2])
    with pytest.raises(ValueError, match="position has 2 numbers"):
        pose([1, 2])


@pytest.mark.parametrize("given", [np.arange(7.0), list(range(7)), tuple(range(7)), list(np.arange(7, dtype=np.float32)),
                                   pose([0, 1, 2], [3, 4, 5, 6]),
                                   {"position": [0, 1, 2], "orientation": np.arange(3.0, 7.0)}])
def test_numbers_become_a_pose(given):
    assert np.array_equal(numbers(goal("MoveL", pose=given).pose), np.arange(7.0))


def test_a_position_keeps_the_orientation_of_the_message():
    assert np.array_equal(numbers(goal("MoveL", pose=[1, 2, 3]).pose), [1, 2, 3, 0, 0, 0, 1])


def test_a_message_is_taken_as_it_is():
    given = goal("MoveL", pose=np.arange(7.0)).pose
    assert goal("MoveL", pose=given).pose == given


@pytest.mark.parametrize("given", [[], np.arange(5.0), np.arange(8.0), ["a"] * 7, [True] * 7, 3.0])
def test_numbers_that_are_no_pose_are_rejected(given):
    with pytest.raises(Rejected, match="pose is .*expected a mapping of fields") as rejected:
        goal("MoveL", pose=given)
    assert rejected.value.field == "pose"


def test_rows_become_waypoints():
    waypoints = goal("ExecuteTrajectory", waypoints=np.arange(12.0).reshape(2, 6)).waypoints
    assert [list(waypoint.positions) for waypoint in waypoints] == [[0, 1, 2, 3, 4, 5], [6, 7, 8, 9, 10, 11]]


def test_a_message_with_other_fields_is_not_made_of_numbers():
    with pytest.raises(Rejected, match=r"waypoints\[0\]"):
        goal("MovePath", waypoints=np.arange(12.0).reshape(2, 6))


def test_numpy_scalars_are_numbers():
    message = goal("SetDigitalOutput", pin=np.int64(3), state=np.bool_(True))
    assert (message.pin, message.state) == (3, True)


def test_a_trajectory_has_times_and_columns():
    message = trajectory([0.0, 1.9999999999, 2.5], np.zeros((3, 6)), np.ones((3, 6)))
    assert [(point.time_from_start.sec, point.time_from_start.nanosec) for point in message.points] == [(0, 0), (2, 0), (2, 500000000)]
    assert list(message.points[1].velocities) == [1.0] * 6 and not message.points[1].accelerations


@pytest.mark.parametrize("arguments, text", [
    (([0.0, 1.0], np.zeros((3, 6))), r"positions has the shape \(3, 6\): expected \(2, 6\)"),
    (([0.0], np.zeros((1, 6)), np.zeros(6)), r"velocities has the shape \(6,\)"),
    ((0.0, np.zeros((1, 6))), "times has the shape")])
def test_arrays_of_a_wrong_shape_are_named(arguments, text):
    with pytest.raises(ValueError, match=text):
        trajectory(*arguments)


def test_only_a_trajectory_with_joint_names_starts_at_a_time():
    message = trajectory([0.0, 1.0], np.zeros((2, 6)), joint_names=["a", "b"], start_at=12.25)
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (12, 250000000)
    with pytest.raises(ValueError, match="start_at needs joint_names"):
        trajectory([0.0, 1.0], np.zeros((2, 6)), start_at=12.25)


@pytest.mark.parametrize("text, fields", [
    ("timestamp,actual_q_0,actual_q_1\n1,2,3\n4,5,6\n", {"timestamp": [1, 4], "actual_q": [[2, 3], [5, 6]]}),
    ("output_int_register_0,timestamp\n1,2\n", {"output_int_register_0": [1], "timestamp": [2]}),
    ("timestamp\n", {"timestamp": []})])
def test_the_columns_of_an_output_form_one_field(tmp_path, text, fields):
    (tmp_path / "run.csv").write_text(text)
    recording = read_recording(tmp_path / "run.csv")
    assert recording.dtype.names == tuple(fields)
    assert all(np.array_equal(recording[name], values) for name, values in fields.items())
