"""What a command leaves behind before or after its goal: objects that end, goals that were abandoned, supervisions. The commands are those
of test/plugins."""

import pytest
from action_msgs.msg import GoalStatus
from plugin_prefix import driver_of_test_commands
from robot_fixtures import make_ready
from support import HOME, wait_for

from ur_ros_rtde_msgs.action import MoveJ, SendScript, SpeedJ
from ur_ros_rtde_msgs.msg import ErrorCode

WRIST = 5
DOOR = 7  # digital input of watches_a_door


@pytest.fixture(scope="module")
def driver(simulator, tmp_path_factory):
    with driver_of_test_commands(simulator, tmp_path_factory.mktemp("prefix"), "move_j", "stop", "asks_during_a_motion", "checks_again",
                                 "ends_its_scope", "never_looks", "outlasts_the_link", "turns_as_mode", "watches_a_door") as driver:
        yield driver


@pytest.mark.parametrize("when", ["during", "late"])
def test_a_query_does_not_end_the_wait_for_a_motion(robot, simulator, when):
    start = simulator.state()["actual"]["position"][WRIST]
    robot.send(SendScript, "asks_during_a_motion", script=when).succeeded()
    assert simulator.state()["actual"]["position"][WRIST] == pytest.approx(start + 0.4, abs=0.006)


def test_a_check_that_is_repeated_asks_the_robot(robot):
    result = robot.send(SendScript, "checks_again", script="out of reach").result()
    assert (result.error_code, result.message) == (ErrorCode.UNREACHABLE, "out of reach")


@pytest.mark.parametrize("what", ["mode", "payload", "stream"])
def test_the_arm_is_at_rest_when_an_object_has_ended_and_the_goal_goes_on(robot, simulator, what):
    goal = robot.send(SendScript, "ends_its_scope", script=what, timeout=4.0)
    goal.wait_until(lambda: not simulator.is_at_rest(), 10.0, "a motion")

    def has_ended():
        state = simulator.state()
        return simulator.is_at_rest() and not state["force_mode"] and state["payload"]["mass"] == 0.0

    goal.wait_until(has_ended, 10.0, "a standstill without a mode and a payload")
    message = goal.succeeded().message
    assert not message, message


def test_a_payload_is_put_back_after_a_cancel_in_force_mode(robot, simulator):
    goal = robot.send(SendScript, "ends_its_scope", script="payload and mode", timeout=0.0)
    goal.wait_until(lambda: simulator.state()["force_mode"], 10.0, "force mode")
    assert simulator.state()["payload"]["mass"] == pytest.approx(2.0)
    goal.cancel()
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_CANCELED and "put back" not in result.message, result.message
    state = simulator.state()
    assert not state["force_mode"] and state["payload"]["mass"] == 0.0


def turning(robot, time):
    return turning_by(robot, "never_looks", time)


def turning_by(robot, action, time):
    return robot.send(SpeedJ, action, joint_velocities=[0.0] * 5 + [0.2], acceleration=1.0, time=time)


def test_a_command_is_not_executed_again_before_its_abandoned_goal_has_returned(robot, simulator):
    goal = turning(robot, 6.0)
    wait_for(lambda: goal.accepted and not simulator.is_at_rest(), 10.0, "a motion")
    goal.cancel()
    status, _ = goal.wait_for_result()
    assert status == GoalStatus.STATUS_CANCELED
    early = turning(robot, 0.1)
    assert not early.accepted
    assert "an earlier goal of /never_looks has been abandoned" in robot.rejection(early).message
    robot.send(MoveJ, "move_j", joint_positions=HOME, speed=1.0).succeeded()  # other commands are
    wait_for(lambda: turning(robot, 0.1).accepted, 15.0, "the end of the abandoned goal")


def test_a_command_that_has_not_seen_the_loss_of_the_connection_has_not_succeeded(robot, simulator):
    goal = turning_by(robot, "outlasts_the_link", 20.0)
    wait_for(lambda: goal.accepted and not simulator.is_at_rest(), 10.0, "a motion")
    simulator.control("drop_links", which="rtde")
    result = goal.result(30.0)
    assert result.error_code == ErrorCode.LINK_LOST and "did not return" not in result.message, result.message
    assert simulator.is_at_rest()


def open_door(simulator, is_open):
    simulator.control("set_digital_input", number=DOOR, value=is_open)


def move(robot, target):
    return robot.send(MoveJ, "move_j", joint_positions=[*HOME[:WRIST], target], speed=0.2)


def test_a_supervision_rejects_what_would_move_the_arm_until_its_reason_has_gone(robot, simulator):
    goal = move(robot, 1.0)
    goal.wait_until(lambda: not simulator.is_at_rest(), 10.0, "a motion")
    open_door(simulator, True)
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_ABORTED and (result.error_code, result.message) == (ErrorCode.NOT_READY, "the door is open")
    rejected = move(robot, 0.0)
    assert not rejected.accepted and robot.rejection(rejected).message == "the door is open"
    beside = robot.send(SpeedJ, "turns_as_mode", joint_velocities=[0.0] * 5 + [0.2], acceleration=1.0)
    assert not beside.accepted and robot.rejection(beside).message == "the door is open"
    open_door(simulator, False)
    make_ready(robot)
    robot.send(SendScript, "watches_a_door", script="end").succeeded()
    open_door(simulator, True)
    move(robot, 0.3).succeeded()
    open_door(simulator, False)
