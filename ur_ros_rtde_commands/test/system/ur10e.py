"""Forward kinematics of the UR10e from the published DH parameters, as a reference for the controller's results."""

import math

import numpy as np

A = [0.0, -0.6127, -0.57155, 0.0, 0.0, 0.0]  # m
D = [0.1807, 0.0, 0.0, 0.17415, 0.11985, 0.11655]  # m
ALPHA = [math.pi / 2, 0.0, 0.0, math.pi / 2, -math.pi / 2, 0.0]


def _link(angle, a, d, alpha):
    c, s, ca, sa = math.cos(angle), math.sin(angle), math.cos(alpha), math.sin(alpha)
    return np.array([[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0.0, sa, ca, d], [0.0, 0.0, 0.0, 1.0]])


def flange(q):
    """Returns the flange pose in the base frame as a 4 x 4 matrix."""
    frame = np.eye(4)
    for angle, a, d, alpha in zip(q, A, D, ALPHA):
        frame = frame @ _link(angle, a, d, alpha)
    return frame


def matrix(pose):
    """Converts a geometry_msgs/Pose to a 4 x 4 matrix."""
    o, p = pose.orientation, pose.position
    x, y, z, w = np.array([o.x, o.y, o.z, o.w]) / math.sqrt(o.x**2 + o.y**2 + o.z**2 + o.w**2)
    frame = np.eye(4)
    frame[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    frame[:3, 3] = [p.x, p.y, p.z]
    return frame


def jacobian(q, tcp=None, step=1e-6):
    """Returns the Jacobian of the TCP (default: the flange) in the base frame, by central differences."""
    tcp = np.eye(4) if tcp is None else tcp
    columns = []
    for joint in range(6):
        forward, backward = (flange(np.array(q) + sign * step * np.eye(6)[joint]) @ tcp for sign in (1, -1))
        linear = (forward[:3, 3] - backward[:3, 3]) / (2 * step)
        turn = (forward[:3, :3] - backward[:3, :3]) / (2 * step) @ (flange(q) @ tcp)[:3, :3].T
        columns.append([*linear, turn[2, 1], turn[0, 2], turn[1, 0]])
    return np.array(columns).T
