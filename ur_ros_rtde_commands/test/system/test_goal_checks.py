"""Checks of goals that wait for the controller do not delay other goals."""

import pytest
from action_msgs.srv import CancelGoal
from arm_state import get_tcp_pose, translated
from geometry_msgs.msg import Pose

from ur_ros_rtde_msgs.action import MoveL, SetDigitalOutput, SetWatchdog, Stop
from ur_ros_rtde_msgs.msg import ErrorCode


def pose_below(robot):
    return translated(get_tcp_pose(robot), z=-0.05)


@pytest.fixture
def known_servers(robot):
    """So that none is discovered while a check is pending."""
    assert not robot.send(MoveL, "move_l", speed=-1.0).accepted
    robot.send(SetDigitalOutput, "set_standard_digital_output", pin=1).succeeded()
    robot.send(Stop, "stop").succeeded()
    robot.call(CancelGoal, "move_l/_action/cancel_goal")


@pytest.fixture
def silent_controller(robot, simulator, known_servers):
    """The control program receives no commands. Queries remain unanswered until its watchdog stops it after 1 s."""
    pose = pose_below(robot)
    robot.send(SetWatchdog, "set_watchdog", min_frequency=1.0).succeeded()
    simulator.control("lose_commands", which="rtde", clients="control", count=100000)
    yield pose


def test_executes_another_goal_while_a_check_is_pending(robot, silent_controller):
    waiting = robot.send(MoveL, "move_l", pose=silent_controller)
    robot.send(SetDigitalOutput, "set_standard_digital_output", pin=1, state=True).succeeded()
    assert not waiting.answered()
    assert not waiting.accepted
    assert robot.rejection(waiting).error_code != ErrorCode.NONE


def test_stop_preempts_a_goal_whose_check_is_pending(robot, silent_controller):
    waiting = robot.send(MoveL, "move_l", pose=silent_controller)
    stop = robot.send(Stop, "stop")
    assert stop.accepted
    assert not waiting.accepted
    assert robot.rejection(waiting).error_code == ErrorCode.PREEMPTED


def test_a_goal_canceled_during_its_check_does_not_move_the_arm(robot, simulator, known_servers):
    pose = pose_below(robot)
    before = simulator.state()["actual"]["position"]
    simulator.control("delay_links", which="rtde", clients="control", ms=300)
    waiting = robot.send(MoveL, "move_l", pose=pose)
    robot.call(CancelGoal, "move_l/_action/cancel_goal")
    simulator.control("delay_links", which="rtde", clients="control", ms=0)
    assert not waiting.accepted
    assert simulator.state()["actual"]["position"] == pytest.approx(before, abs=1e-3)


def test_an_unreachable_pose_is_rejected_after_the_check(robot):
    pose = Pose(position=get_tcp_pose(robot).position)
    pose.position.z += 1.1
    goal = robot.send(MoveL, "move_l", pose=pose)
    assert not goal.accepted
    assert robot.rejection(goal).error_code in (ErrorCode.UNREACHABLE, ErrorCode.SAFETY_VIOLATION)
