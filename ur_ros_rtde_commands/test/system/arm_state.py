"""The state of the arm as the driver reports it, and positions relative to the home position."""

import copy

from support import HOME, wait_for

from ur_ros_rtde_msgs.srv import GetJointState, GetTcpPose

AT_REST = 0.01  # rad/s, maximum speed of any joint of an arm at rest


def get_tcp_pose(client):
    return client.call(GetTcpPose, "get_tcp_pose").tcp_pose.pose


def get_joint_state(client):
    return client.call(GetJointState, "get_joint_state").joint_state


def get_joint_positions(client):
    return list(get_joint_state(client).position)


def get_joint_speed(client):
    """Returns the speed of the fastest joint in rad/s."""
    return max(map(abs, get_joint_state(client).velocity))


def is_at_rest(client):
    return get_joint_speed(client) < AT_REST


def wait_until_moving(client, speed=0.05):
    """Waits until a joint is faster than `speed` in rad/s."""
    wait_for(lambda: get_joint_speed(client) > speed, 10.0, "the arm to move")


def home_plus(*angles):
    """Returns the home position with these angles in rad added, from the base joint on."""
    return [home + angle for home, angle in zip(HOME, [*angles, *[0.0] * (len(HOME) - len(angles))])]


def translated(pose, x=0.0, y=0.0, z=0.0):
    """Returns a copy of the pose, translated along the axes of the base frame in m."""
    pose = copy.deepcopy(pose)
    pose.position.x += x
    pose.position.y += y
    pose.position.z += z
    return pose
