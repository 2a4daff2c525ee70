"""Poses without an orientation: (0, 0, 0, 1) keeps the orientation of the tool unless identity_orientation is set."""

import math

import numpy as np
import pytest
from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from robot_fixtures import make_ready
from ur10e import flange, matrix

from ur_ros_rtde_msgs.action import ExecuteCartesianPath, MoveC, MoveJIK, MoveL, MoveLRelative, MoveP, MovePath, ServoC, ServoL
from ur_ros_rtde_msgs.msg import PathWaypoint
from ur_ros_rtde_msgs.srv import GetTcpPose

POSE_COMMANDS = [(MoveL, "move_l"), (MoveJIK, "move_j_ik"), (ServoL, "servo_l"), (ServoC, "servo_c")]
QUARTER_TURN = math.pi / 2.0
# Joint positions at which the axes of tool and base coincide.
IDENTITY = [0.0, -QUARTER_TURN, QUARTER_TURN, -QUARTER_TURN, QUARTER_TURN, QUARTER_TURN]


def flange_pose(simulator):
    """Returns the position and the rotation matrix of the flange, from the simulated joint positions."""
    frame = flange(simulator.state()["actual"]["position"])
    return frame[:3, 3], frame[:3, :3]


def angle(a, b):
    return math.acos(np.clip((np.trace(a.T @ b) - 1.0) / 2.0, -1.0, 1.0))


def position_only(robot, x=0.0, y=0.0, z=0.0):
    """Returns a pose near the TCP whose orientation is left at its default."""
    p = robot.call(GetTcpPose, "get_tcp_pose").tcp_pose.pose.position
    return Pose(position=Point(x=p.x + x, y=p.y + y, z=p.z + z))


@pytest.fixture
def turn_tool(client, driver):
    """Returns a function that turns the tool by an angle about the z axis of the base, from the orientation of the base."""

    def turn(angle):
        make_ready(client, joint_positions=[*IDENTITY[:5], IDENTITY[5] + angle])

    return turn


@pytest.mark.parametrize("action, name", POSE_COMMANDS, ids=[name for _, name in POSE_COMMANDS])
def test_a_pose_without_orientation_keeps_the_orientation(robot, simulator, action, name):
    robot.send(MoveLRelative, "move_l_relative", rotation=Vector3(z=0.4, x=0.2), speed=0.4, acceleration=1.0).succeeded()
    target = position_only(robot, y=0.1, z=-0.05)
    _, before = flange_pose(simulator)
    result = robot.send(action, name, pose=target).succeeded()
    position, after = flange_pose(simulator)
    assert angle(before, after) < 0.01
    assert position == pytest.approx([target.position.x, target.position.y, target.position.z], abs=0.005)
    assert not result.message or "orientation" not in result.message


@pytest.mark.parametrize("identity", [True, False])
@pytest.mark.parametrize("action, name", POSE_COMMANDS, ids=[name for _, name in POSE_COMMANDS])
def test_an_identity_orientation_is_applied_if_identity_orientation_is_set(client, turn_tool, simulator, action, name, identity):
    turn_tool(0.3)
    target = position_only(client, y=0.05)
    client.send(action, name, pose=target, identity_orientation=identity).succeeded()
    assert angle(flange_pose(simulator)[1], np.eye(3)) == pytest.approx(0.0 if identity else 0.3, abs=0.01)


@pytest.mark.parametrize("action, name", POSE_COMMANDS, ids=[name for _, name in POSE_COMMANDS])
def test_any_other_orientation_is_applied(robot, simulator, action, name):
    target = position_only(robot, z=-0.05)
    target.orientation = Quaternion(x=math.sin(math.radians(50)), y=math.cos(math.radians(50)), z=0.0, w=0.0)
    robot.send(action, name, pose=target).succeeded()
    assert angle(flange_pose(simulator)[1], matrix(target)[:3, :3]) < 0.01


LIMITS = {"speed": 0.25, "acceleration": 1.2}  # m/s and m/s^2: higher values would make the rotation exceed a joint speed limit
PATHS = [
    ("move_p", MoveP, "poses[0]", lambda pose, via: {"poses": [pose], **LIMITS}),
    ("move_c", MoveC, "pose", lambda pose, via: {"via": via, "pose": pose, **LIMITS}),
    ("move_path", MovePath, "waypoints[0].pose",
     lambda pose, via: {"waypoints": [PathWaypoint(type=PathWaypoint.MOVE_L, pose=pose, **LIMITS)]}),
    ("execute_cartesian_path", ExecuteCartesianPath, "poses[0]",
     lambda pose, via: {"poses": [pose], "rotation_speed": 2.0, "max_velocity": [2.0] * 6, "max_acceleration": [10.0] * 6}),
]


@pytest.mark.parametrize("name, action, field, goal", PATHS, ids=[path[0] for path in PATHS])
def test_a_path_that_turns_the_tool_to_the_identity_causes_a_warning(client, turn_tool, driver, name, action, field, goal):
    turn_tool(2.0)
    fields = goal(position_only(client, y=0.05), position_only(client, y=0.025, x=0.025))
    before = len(driver.lines)  # of an attempt that a stall of the host ended
    message = client.send(action, name, **fields).succeeded().message
    assert f"{field} turns the tool by 115 degrees" in message and "only its position is given" in message, message
    warnings = [line for line in driver.lines[before:] if "WARN" in line and f"/{name}: goal" in line and message in line]
    assert len(warnings) == 1, driver.output()


@pytest.mark.parametrize("name, action, field, goal", PATHS, ids=[path[0] for path in PATHS])
def test_a_path_with_orientations_causes_no_warning(client, turn_tool, name, action, field, goal):
    turn_tool(0.3)
    poses = [position_only(client, y=0.05), position_only(client, y=0.025, x=0.025)]
    for pose in poses:
        pose.orientation = client.call(GetTcpPose, "get_tcp_pose").tcp_pose.pose.orientation
    assert "turns the tool" not in client.send(action, name, **goal(*poses)).succeeded().message
