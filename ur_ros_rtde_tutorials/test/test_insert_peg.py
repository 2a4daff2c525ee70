"""Tests insert_peg on the simulated robot: the TCP is the tip of the peg, and four boxes leave a hole between them."""

import math

import pytest
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import Quaternion, TransformStamped, Vector3
from ros_client import TRANSIENT_LOCAL
from support import wait_for
from tf2_msgs.msg import TFMessage
from ur_ros_rtde_tutorials.action import InsertPeg

from ur_ros_rtde_msgs.msg import ErrorCode

HALF_WIDTH = 0.003  # m, of the hole
SURFACE = 0.01  # m, below the tip of the peg


def position(simulator):
    return simulator.state()["actual_tcp_pose"][:3]


def place_plate(simulator, offset, thickness=0.04):
    """A plate below the tip, with a hole at this offset along x."""
    x, y, z = position(simulator)
    center = z - SURFACE - 0.5 * thickness
    beside = HALF_WIDTH + 0.05
    for dx, dy, size in ((-beside, 0.0, [0.1, 0.3, thickness]), (beside, 0.0, [0.1, 0.3, thickness]),
                         (0.0, -beside, [2.0 * HALF_WIDTH, 0.1, thickness]), (0.0, beside, [2.0 * HALF_WIDTH, 0.1, thickness])):
        simulator.control("place_box", center=[x + offset + dx, y + dy, center], size=size)


def insert(client, **fields):
    return client.send(InsertPeg, "insert_peg", **fields)


def ends_at_rest_without_force_mode(simulator):
    return simulator.is_at_rest() and not simulator.state()["force_mode"]


def test_the_peg_is_inserted_into_a_hole_beside_it(robot, simulator):
    start = position(simulator)
    place_plate(simulator, 0.005)
    goal = insert(robot, depth=0.012)
    result = goal.succeeded(60.0)
    end = position(simulator)
    assert start[2] - end[2] == pytest.approx(SURFACE + 0.012, abs=0.004)
    assert abs(end[0] - start[0] - 0.005) < HALF_WIDTH + 0.001 and abs(end[1] - start[1]) < HALF_WIDTH + 0.001
    assert result.offset == pytest.approx(math.dist(start[:2], end[:2]), abs=0.002)
    assert max(feedback.depth for feedback in goal.feedback) > 0.005
    assert ends_at_rest_without_force_mode(simulator)


def test_the_peg_is_moved_to_a_hole_that_tf_has(robot, simulator):
    place_plate(simulator, 0.06)
    x, y, z = position(simulator)
    hole = TransformStamped(child_frame_id="hole")
    hole.header.frame_id = "base"
    hole.transform.translation = Vector3(x=x + 0.055, y=y, z=z - SURFACE)  # 5 mm beside the hole
    hole.transform.rotation = Quaternion(z=math.sqrt(0.5), w=math.sqrt(0.5))  # as the tool
    publisher = robot.node.create_publisher(TFMessage, "/tf_static", TRANSIENT_LOCAL)
    publisher.publish(TFMessage(transforms=[hole]))
    insert(robot, hole="hole", depth=0.012).succeeded(60.0)
    end = position(simulator)
    assert end[2] == pytest.approx(z - SURFACE - 0.012, abs=0.004)
    assert abs(end[0] - x - 0.06) < HALF_WIDTH + 0.001 and abs(end[1] - y) < HALF_WIDTH + 0.001
    robot.node.destroy_publisher(publisher)


def test_without_its_hole_the_peg_is_not_moved(robot, simulator):
    start = position(simulator)
    result = insert(robot, hole="hloe").result(60.0)
    assert result.error_code == ErrorCode.INVALID_GOAL
    assert 'move_l: frame_id: TF has no frame "hloe"' in result.message, result.message
    assert position(simulator) == pytest.approx(start, abs=0.001)


def test_fails_with_not_reached_without_a_hole(robot, simulator):
    start = position(simulator)
    place_plate(simulator, 0.02)
    status, result = insert(robot, radius=0.004).wait_for_result(60.0)
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == ErrorCode.NOT_REACHED, result.message
    assert result.message == "no hole within 0.004 m: start closer to it, or increase radius"
    assert start[2] - position(simulator)[2] == pytest.approx(SURFACE, abs=0.003)
    assert ends_at_rest_without_force_mode(simulator)


def test_fails_with_not_reached_if_the_hole_is_not_deep_enough(robot, simulator):
    place_plate(simulator, 0.005)
    simulator.control("place_surface", z=position(simulator)[2] - SURFACE - 0.005)
    result = insert(robot).result(60.0)
    assert result.error_code == ErrorCode.NOT_REACHED and "it is jammed, or the hole ends" in result.message, result.message
    assert ends_at_rest_without_force_mode(simulator)


def test_fails_with_not_reached_without_a_surface(robot, simulator):
    result = insert(robot, distance=0.02).result(60.0)
    assert result.error_code == ErrorCode.NOT_REACHED and "no surface within 0.02 m" in result.message, result.message
    assert simulator.is_at_rest()


def test_cancel_during_the_search_ends_force_mode(robot, simulator):
    place_plate(simulator, 0.05)
    goal = insert(robot, radius=0.03)
    wait_for(lambda: simulator.state()["force_mode"], 20.0, "force mode")
    goal.cancel()
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_CANCELED and result.error_code == ErrorCode.CANCELED, result.message
    assert ends_at_rest_without_force_mode(simulator)


def test_a_protective_stop_during_the_search_aborts_with_its_error_code(robot, simulator):
    place_plate(simulator, 0.05)
    goal = insert(robot, radius=0.03)
    wait_for(lambda: simulator.state()["force_mode"], 20.0, "force mode")
    simulator.control("protective_stop", reason="of the test")
    assert goal.result().error_code == ErrorCode.PROTECTIVE_STOP
    assert simulator.is_at_rest()
    wait_for(lambda: not simulator.state()["force_mode"], 10.0, "the end of force mode, with the control program")
