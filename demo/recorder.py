"""Joins samples of joint_states, wrench and tcp_pose into rows. Messages of one cycle have the same stamp."""

import csv
import math

from force_figure import FORCES, JOINTS, POSITIONS, VELOCITIES, force_column
from geometry_msgs.msg import PoseStamped, WrenchStamped
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState

QOS = QoSProfile(depth=50, reliability=ReliabilityPolicy.BEST_EFFORT)


def _nanoseconds(stamp):
    return stamp.sec * 1_000_000_000 + stamp.nanosec


class Recorder:
    def __init__(self, node):
        self.rows = []
        self.height = math.nan  # m; unknown until the first message
        self._latest_force = None
        self._stamp = None
        self._origin = None
        self._pending = {}
        self._subscriptions = [
            node.create_subscription(JointState, "joint_states", self._on_joints, QOS),
            node.create_subscription(WrenchStamped, "wrench", self._on_wrench, QOS),
            node.create_subscription(PoseStamped, "tcp_pose", self._on_pose, QOS),
        ]

    def complete(self):
        """Returns whether a message of each topic has been received."""
        return not math.isnan(self.height) and None not in (self._latest_force, self._stamp)

    def start(self):
        self.rows.clear()
        self._pending.clear()
        self._origin = self._stamp

    def now(self):
        """Returns the time since start() according to the stamps, s."""
        assert self._stamp is not None and self._origin is not None
        return (self._stamp - self._origin) * 1e-9

    def force(self):
        return self._latest_force

    def _on_joints(self, message):
        names = [name.removesuffix("_joint") for name in message.name]
        self._stamp = _nanoseconds(message.header.stamp)
        order = [names.index(joint) for joint in JOINTS]
        self._join(self._stamp, dict(zip((*POSITIONS, *VELOCITIES), [*(message.position[i] for i in order),
                                                                     *(message.velocity[i] for i in order)])))

    def _on_wrench(self, message):
        force = message.wrench.force
        self._latest_force = (force.x, force.y, force.z)
        self._join(_nanoseconds(message.header.stamp), dict(zip(FORCES, self._latest_force)))

    def _on_pose(self, message):
        self.height = message.pose.position.z
        self._join(_nanoseconds(message.header.stamp), {"height": self.height})

    def _join(self, stamp, fields):
        if self._origin is None or stamp < self._origin:
            return
        row = self._pending.setdefault(stamp, {})
        row.update(fields)
        if len(row) == len(FORCES) + len(POSITIONS) + len(VELOCITIES) + 1:
            self.rows.append({"timestamp": (stamp - self._origin) * 1e-9, **self._pending.pop(stamp)})


def mark_events(rows, pushes, threshold):
    """Returns (row index, "ignored x") where a push first exceeds the threshold, and (row index, "stop z") where the contact does."""
    events = []
    for pushed_at, axis in pushes:
        events += _first_above(rows, pushed_at, axis, threshold, f"ignored {axis}")
    return events + _first_above(rows, 0.0, "z", threshold, "stop z")


def _first_above(rows, since, axis, threshold, event):
    for index, row in enumerate(rows):
        if row["timestamp"] >= since and abs(row[force_column(axis)]) > threshold:
            return [(index, event)]
    return []


def write_csv(path, rows, events):
    marked = dict(events)
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        names = ["timestamp", *POSITIONS, *VELOCITIES, *FORCES, "height"]
        writer.writerow([*names, "event"])
        for index, row in enumerate(rows):
            writer.writerow([*(f"{row[name]:.6f}" for name in names), marked.get(index, "")])
