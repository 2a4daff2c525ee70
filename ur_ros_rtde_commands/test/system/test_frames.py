"""Goals whose poses are given in a frame of TF."""

import math

import pytest
from geometry_msgs.msg import Point, Pose, Quaternion, TransformStamped, Vector3
from publisher import Publisher
from ros_client import TRANSIENT_LOCAL
from support import wait_for
from tf2_msgs.msg import TFMessage

from ur_ros_rtde_msgs.action import ExecuteCartesianPath, GetInverseKinematics, MoveC, MoveJIK, MoveL, MoveP, MovePath, ServoC, ServoL
from ur_ros_rtde_msgs.msg import ErrorCode, PathWaypoint
from ur_ros_rtde_msgs.srv import GetTcpPose

TABLE = "table"
ORIGIN = Vector3(x=0.2, y=-0.4, z=0.1)  # of the table in the base, turned by 90 degrees about z
LIMITS = {"speed": 0.25, "acceleration": 1.2}


def transform(parent, child, translation=ORIGIN, angle=math.pi / 2.0):
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id = parent
    message.transform.translation = translation
    message.transform.rotation = Quaternion(z=math.sin(angle / 2.0), w=math.cos(angle / 2.0))
    return message


def on_table(position, **offset):
    """Returns a position in the base as a pose on the table, with offsets there."""
    x, y, z = position.x - ORIGIN.x, position.y - ORIGIN.y, position.z - ORIGIN.z
    return Pose(position=Point(x=y + offset.get("x", 0.0), y=-x + offset.get("y", 0.0), z=z + offset.get("z", 0.0)))


def in_table(q):
    """Returns an orientation in the base, turned back by the rotation of the table."""
    r = math.sqrt(0.5)
    return Quaternion(x=r * (q.x + q.y), y=r * (q.y - q.x), z=r * (q.z - q.w), w=r * (q.w + q.z))


@pytest.fixture(scope="module")
def table(client):
    """Publishes where the table is, once, as static_transform_publisher does."""
    publisher = client.node.create_publisher(TFMessage, "/tf_static", TRANSIENT_LOCAL)
    publisher.publish(TFMessage(transforms=[transform("base", TABLE)]))
    yield TABLE
    client.node.destroy_publisher(publisher)


def tcp(robot):
    return robot.call(GetTcpPose, "get_tcp_pose").tcp_pose.pose


def assert_at(robot, expected):
    p = tcp(robot).position
    assert (p.x, p.y, p.z) == pytest.approx((expected.x, expected.y, expected.z), abs=0.003)


GOALS = {
    "move_l": (MoveL, lambda via, pose: {"pose": pose}),
    "move_j_ik": (MoveJIK, lambda via, pose: {"pose": pose}),
    "servo_l": (ServoL, lambda via, pose: {"pose": pose}),
    "servo_c": (ServoC, lambda via, pose: {"pose": pose}),
    "move_c": (MoveC, lambda via, pose: {"via": via, "pose": pose}),
    "move_p": (MoveP, lambda via, pose: {"poses": [via, pose]}),
    "move_path": (MovePath, lambda via, pose: {"waypoints": [PathWaypoint(type=PathWaypoint.MOVE_C, via=via, pose=pose, **LIMITS)]}),
    "execute_cartesian_path": (ExecuteCartesianPath, lambda via, pose: {"poses": [via, pose]}),
}


@pytest.mark.parametrize("name", GOALS)
def test_poses_are_given_in_the_frame_of_the_goal(robot, table, name):
    action, goal = GOALS[name]
    start = tcp(robot)
    via, pose = on_table(start.position, x=0.03, y=0.03), on_table(start.position, x=0.06)
    via.orientation = pose.orientation = in_table(start.orientation)
    robot.send(action, name, frame_id=table, **goal(via, pose)).succeeded()
    assert_at(robot, Point(x=start.position.x, y=start.position.y + 0.06, z=start.position.z))
    q, now = start.orientation, tcp(robot).orientation
    assert abs(q.x * now.x + q.y * now.y + q.z * now.z + q.w * now.w) == pytest.approx(1.0, abs=1e-4)


def test_a_position_alone_keeps_the_orientation_of_the_tool(robot, table):
    start = tcp(robot)
    robot.send(MoveL, "move_l", frame_id=table, pose=on_table(start.position, z=-0.05)).succeeded()
    assert_at(robot, Point(x=start.position.x, y=start.position.y, z=start.position.z - 0.05))
    assert tcp(robot).orientation.x == pytest.approx(start.orientation.x, abs=0.005)


def test_base_needs_no_tf(robot):
    start = tcp(robot)
    robot.send(MoveL, "move_l", frame_id="base", pose=start).succeeded()
    assert_at(robot, start.position)


def test_a_query_takes_a_frame(robot, table, simulator):
    pose = on_table(tcp(robot).position)
    pose.orientation = in_table(tcp(robot).orientation)
    solution = robot.send(GetInverseKinematics, "get_inverse_kinematics", frame_id=table, pose=pose).succeeded()
    assert list(solution.joint_positions) == pytest.approx(simulator.state()["actual"]["position"], abs=0.01)


def test_an_unknown_frame_is_named_and_nothing_moves(robot, table, simulator):
    before = simulator.state()["actual"]["position"]
    goal = robot.send(MoveL, "move_l", frame_id="tabel", pose=on_table(tcp(robot).position, x=0.1))
    assert not goal.accepted
    rejection = robot.rejection(goal)
    assert rejection.error_code == ErrorCode.INVALID_GOAL
    assert 'frame_id: TF has no frame "tabel"' in rejection.message, rejection.message
    assert simulator.state()["actual"]["position"] == pytest.approx(before, abs=0.002)


def test_a_pose_out_of_reach_in_the_base_is_rejected(robot, table):
    goal = robot.send(MoveL, "move_l", frame_id=table, pose=on_table(tcp(robot).position, x=3.0))
    assert not goal.accepted
    assert "pose" in robot.rejection(goal).message


def rejection_in(robot, frame):
    """Returns why a goal is rejected whose pose is given in a frame; empty if it is accepted."""
    goal = robot.send(GetInverseKinematics, "get_inverse_kinematics", frame_id=frame, pose=on_table(tcp(robot).position))
    return "" if goal.accepted else robot.rejection(goal).message


def test_a_frame_that_is_published_again_and_again_is_taken_where_it_is_until_it_is_lost(robot):
    assert 'TF has no frame "part"' in rejection_in(robot, "part")  # the driver listens to TF from now on
    start = tcp(robot)
    with Publisher(robot, TFMessage, "/tf", lambda _: TFMessage(transforms=[transform("base", "part")])):
        robot.send(MoveL, "move_l", frame_id="part", pose=on_table(start.position, x=0.05)).succeeded()
    assert_at(robot, Point(x=start.position.x, y=start.position.y + 0.05, z=start.position.z))
    message = wait_for(lambda: rejection_in(robot, "part"), 20.0, "the transform to be too old")
    assert 'the transform from "base" to "part" was published' in message, message
