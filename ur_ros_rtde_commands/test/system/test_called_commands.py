"""Commands that execute goals of other commands: Run::call(). The commands are those of test/plugins."""

import pytest
from action_msgs.msg import GoalStatus
from plugin_prefix import driver_of_test_commands
from support import wait_for
from trajectories import TargetRecorder

from ur_ros_rtde_msgs.action import SendScript, SpeedJ
from ur_ros_rtde_msgs.msg import ErrorCode

WRIST = 5


@pytest.fixture(scope="module")
def driver(simulator, tmp_path_factory):
    with driver_of_test_commands(simulator, tmp_path_factory.mktemp("prefix"), "move_j", "move_j_relative", "move_l", "speed_j", "stop",
                                 "calls_speed_j", "calls_move_j_relative", "calls_itself", "calls_without_the_arm", "leaves_turning",
                                 "moves_on") as driver:
        yield driver


def wrist(simulator):
    return simulator.state()["actual"]["position"][WRIST]


def call(client, name, speed=0.5):
    """Sends a goal of calls_move_j_relative, which calls the command `name`."""
    return client.send(SendScript, "calls_move_j_relative", script=name, timeout=speed)


def turning(client, action, **fields):
    return client.send(SpeedJ, action, joint_velocities=[0.5, 0.0, 0.0, 0.0, 0.0, 0.0], acceleration=2.0, **fields)


def test_a_called_command_moves_the_arm_and_returns_its_result(robot, simulator):
    start = wrist(simulator)
    result = call(robot, "move_j_relative").succeeded(20.0)
    assert wrist(simulator) == pytest.approx(start + 0.2 - 0.1, abs=0.005)
    assert result.output[0] == "success" and float(result.output[2]) == pytest.approx(start + 0.2, abs=0.005)


@pytest.mark.parametrize("name, code, text", [
    ("move_k", ErrorCode.NOT_SUPPORTED, "move_k cannot be called: command_server has no such command"),
    ("move_l", ErrorCode.NOT_SUPPORTED, "move_l cannot be called: its action has another type"),
    ("stop", ErrorCode.NOT_SUPPORTED, "stop cannot be called: its action has another type"),
])
def test_a_command_that_cannot_be_called_is_named_and_the_caller_goes_on(robot, simulator, name, code, text):
    start = wrist(simulator)
    result = call(robot, name).result(20.0)
    assert result.error_code == code and text in result.message, result.message
    assert wrist(simulator) == pytest.approx(start - 0.1, abs=0.005)


def test_an_invalid_goal_of_a_called_command_is_its_reason(robot, simulator):
    start = wrist(simulator)
    result = call(robot, "move_j_relative", speed=9.0).result(20.0)
    assert result.error_code == ErrorCode.INVALID_GOAL
    assert result.message == "move_j_relative: speed is 9 rad/s, it must be above 0 and at most 3.14 rad/s", result.message
    assert wrist(simulator) == pytest.approx(start - 0.1, abs=0.005)


def test_a_command_that_calls_itself_fails(robot, simulator):
    result = robot.send(SendScript, "calls_itself", script="x").result(20.0)
    assert result.error_code == ErrorCode.NOT_SUPPORTED and "does it call itself?" in result.message, result.message


def test_a_command_without_the_arm_cannot_call_a_motion(robot, simulator):
    start = wrist(simulator)
    result = robot.send(SendScript, "calls_without_the_arm", script="x").result(20.0)
    assert result.error_code == ErrorCode.NOT_SUPPORTED
    assert "it needs the resource motion, and the command that calls it has io" in result.message, result.message
    assert wrist(simulator) == pytest.approx(start, abs=1e-3)


def test_what_a_failed_command_leaves_moving_is_stopped_and_the_caller_goes_on(robot, simulator):
    start = wrist(simulator)
    result = turning(robot, "moves_on").result(20.0)
    assert result.error_code == ErrorCode.NOT_REACHED and result.message == "leaves_turning: left turning", result.message
    assert wrist(simulator) == pytest.approx(start - 0.1, abs=0.005) and simulator.is_at_rest()


def test_cancel_ends_the_called_command(robot, simulator):
    goal = turning(robot, "calls_speed_j", time=20.0)
    wait_for(lambda: not simulator.is_at_rest(), 10.0, "a motion")
    goal.cancel()
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_CANCELED and result.error_code == ErrorCode.CANCELED, result.message
    assert simulator.is_at_rest()


def test_cancel_stops_the_arm_as_the_called_command_asks(robot, simulator):
    """The one that calls it does not say how."""
    goal = turning(robot, "calls_speed_j", time=20.0, deceleration=6.0)
    wait_for(lambda: max(map(abs, simulator.state()["target"]["velocity"])) > 0.49, 10.0, "the speed")
    recorder = TargetRecorder(simulator)
    goal.cancel()
    recorder.record_until_finished(goal)
    assert recorder.max_deceleration() == pytest.approx(6.0, rel=0.1)
