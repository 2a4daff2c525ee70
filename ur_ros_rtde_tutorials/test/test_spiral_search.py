"""Tests spiral_search, an extension of the control script, on the simulated robot."""

import math

import pytest
from action_msgs.msg import GoalStatus
from support import HOME, wait_for
from ur_ros_rtde_tutorials.action import SpiralSearch

from ur_ros_rtde_msgs.action import MoveJ
from ur_ros_rtde_msgs.msg import ErrorCode


def search(client, **fields):
    return client.send(SpiralSearch, "spiral_search", **{"pitch": 0.01, "speed": 0.04, **fields})


def position(simulator):
    return simulator.state()["actual_tcp_pose"][:3]


def test_a_wall_stops_the_search(robot, simulator):
    start = position(simulator)
    simulator.control("place_surface", point=[start[0] - 0.008, 0.0, 0.0], normal=[1, 0, 0])
    result = search(robot).succeeded(60.0)
    end = position(simulator)
    assert end[0] == pytest.approx(start[0] - 0.008, abs=0.003) and end[2] == pytest.approx(start[2], abs=0.001)
    assert result.distance == pytest.approx(math.dist(start, end), abs=0.004)


def test_fails_with_not_reached_within_the_radius_without_contact(robot, simulator):
    start = position(simulator)
    result = search(robot, radius=0.01).result(60.0)
    assert not result.success and result.error_code == ErrorCode.NOT_REACHED, result.message
    assert math.dist(start, position(simulator)) < 0.013


def test_cancel_ends_the_loop_on_the_controller_and_stops_the_arm(robot, simulator):
    goal = search(robot, radius=0.05)
    # The search starts slowly: joints below 0.01 rad/s count as standing still.
    wait_for(lambda: math.hypot(*simulator.state()["actual_tcp_speed"][:3]) > 0.02, 20.0, "the arm to move")
    goal.cancel()
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_CANCELED and result.error_code == ErrorCode.CANCELED
    assert simulator.state()["at_rest"]
    robot.send(MoveJ, "move_j", joint_positions=HOME, speed=2.0).succeeded()


def test_an_error_of_the_snippet_is_the_reason(robot):
    stretched = [HOME[0], -1.2, 0.05, -0.4, HOME[4], HOME[5]]
    robot.send(MoveJ, "move_j", joint_positions=stretched, speed=2.0).succeeded()
    result = search(robot, radius=0.05).result(60.0)
    assert result.error_code == ErrorCode.REJECTED_BY_ROBOT and "spiral_search" in result.message, result.message


def test_a_protective_stop_aborts_with_its_error_code(robot, simulator):
    goal = search(robot, radius=0.05)
    wait_for(lambda: not simulator.state()["at_rest"], 20.0, "the arm to move")
    simulator.control("protective_stop", reason="of the test")
    assert goal.result().error_code == ErrorCode.PROTECTIVE_STOP
    assert simulator.is_at_rest()
