"""Tests move_down_until_force, which the driver loads from this package, on the simulated robot."""

import pytest
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import WrenchStamped
from support import wait_for
from ur_ros_rtde_tutorials.action import MoveDownUntilForce

from ur_ros_rtde_msgs.msg import ErrorCode


def height(simulator):
    return simulator.state()["actual_tcp_pose"][2]


def down(client, **fields):
    return client.send(MoveDownUntilForce, "move_down_until_force", **fields)


def test_a_surface_stops_the_motion(robot, simulator):
    start = height(simulator)
    simulator.control("place_surface", z=start - 0.1, stiffness=15000.0, damping=80.0)
    goal = down(robot)
    result = goal.succeeded(20.0)
    assert simulator.is_at_rest()
    assert 20.0 < abs(result.force) < 40.0
    assert result.distance == pytest.approx(0.1, abs=0.005)
    assert start - height(simulator) == pytest.approx(result.distance, abs=0.002)
    assert 0.0 < result.stopping_time < 0.5
    assert "flange" in result.message
    assert result.final_state.tcp_pose.position.z == pytest.approx(height(simulator), abs=0.001)
    progress = [feedback.motion.progress for feedback in goal.feedback]
    distance = [feedback.distance for feedback in goal.feedback]
    assert len(progress) > 10 and progress == sorted(progress) and 0.05 < progress[-1] < 0.12
    assert distance[-1] == pytest.approx(progress[-1] * 1.0, abs=1e-6)


@pytest.mark.parametrize("axis", ["x", "y"])
def test_lateral_forces_are_ignored(robot, simulator, axis):
    wrenches = robot.subscribe(WrenchStamped, "wrench")
    goal = down(robot, distance=0.1)
    wait_for(lambda: goal.feedback and goal.feedback[-1].distance > 0.01, 10.0, "the arm to move down")
    push = [0.0] * 6
    push["xyz".index(axis)] = 30.0
    simulator.control("push", wrench=push, duration=0.3, frame="tool")
    wait_for(lambda: any(abs(getattr(w.wrench.force, axis)) > 25.0 for w in list(wrenches)), 10.0, "the force of the push")
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == ErrorCode.NOT_REACHED, result.message
    assert result.distance == pytest.approx(0.1, abs=0.003)


def test_a_force_along_the_axis_stops_the_motion(robot, simulator):
    goal = down(robot, distance=0.3)
    wait_for(lambda: goal.feedback and goal.feedback[-1].distance > 0.01, 10.0, "the arm to move down")
    simulator.control("push", wrench=[0.0, 0.0, -30.0, 0.0, 0.0, 0.0], duration=0.4, frame="tool")
    result = goal.succeeded()
    assert result.force < -20.0 and result.distance < 0.2


def test_fails_with_not_reached_without_contact(robot, simulator):
    status, result = down(robot, distance=0.05).wait_for_result()
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == ErrorCode.NOT_REACHED
    assert "20 N" in result.message and "0.05 m" in result.message
    assert simulator.is_at_rest()


def test_the_sensor_is_zeroed_at_the_start(robot, simulator):
    simulator.control("attach_load", mass=3.0)
    try:
        wait_for(lambda: abs(simulator.state()["actual_tcp_force"][2]) > 20.0, 5.0, "the force of the load")
        assert down(robot, distance=0.05).result().error_code == ErrorCode.NOT_REACHED
    finally:
        simulator.control("attach_load", mass=0.0)


def test_cancel_decelerates_to_standstill(robot, simulator):
    goal = down(robot, distance=0.3)
    wait_for(lambda: goal.feedback and goal.feedback[-1].distance > 0.02, 10.0, "the arm to move down")
    goal.cancel()
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_CANCELED and result.error_code == ErrorCode.CANCELED
    assert simulator.is_at_rest() and result.distance > 0.02


@pytest.mark.parametrize("field, value", [("force", 0.0), ("distance", 0.0), ("speed", 2.0), ("acceleration", float("nan")),
                                          ("deceleration", 0.0)])
def test_an_invalid_goal_is_rejected(robot, field, value):
    goal = down(robot, **{field: value})
    assert not goal.accepted
    rejection = robot.rejection(goal)
    assert rejection.error_code == ErrorCode.INVALID_GOAL and rejection.message.startswith(f"{field} is")
