"""Reads the topics of one robot into its RobotState."""

import time
from typing import Any, Optional

import numpy as np
from geometry_msgs.msg import PoseStamped, WrenchStamped
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float64
from ur_ros_rtde_description.models import JOINTS

from ur_ros_rtde_msgs.msg import ActiveModes, DriverState, GoalRejected, IOState, RobotMode, SafetyMode

from ..state.robot_state import MAX_REJECTIONS, DriverStatus, Joints, Pose, Rejection, RobotState, Signals
from .latest_topic import LatestTopic
from .nodes import Nodes


def seconds(stamp: Any) -> float:
    return float(stamp.sec + 1e-9 * stamp.nanosec)


def read_joints(message: JointState) -> Optional[Joints]:
    """Returns the six joints in their usual order. The names may have a prefix; None if a joint is missing."""
    positions = np.asarray(message.position)
    if len(message.name) != len(JOINTS) or len(positions) != len(JOINTS):
        return None
    order = [next((index for index, name in enumerate(message.name) if name.endswith(joint)), None) for joint in JOINTS]
    if None in order:
        return None

    def values(field: Any) -> np.ndarray:
        array = np.asarray(field)
        return array[order] if len(array) == len(JOINTS) else np.zeros(len(JOINTS))

    return Joints(seconds(message.header.stamp), positions[order], values(message.velocity), values(message.effort))


class RobotTopics:
    """Topics with the rate of the controller are polled; topics that are published on changes have callbacks."""

    def __init__(self, nodes: Nodes, namespace: str):
        self._nodes = nodes
        self.namespace = namespace
        self.state = RobotState()
        self.joint_names = JOINTS  # with the prefix of the driver, once a message was received
        self._last_received = self._last_pose = -float("inf")
        self._joints = self._latest(JointState, "joint_states")
        self._target = self._latest(JointState, "target_joint_states")
        self._tcp_pose = self._latest(PoseStamped, "tcp_pose")
        self._wrench = self._latest(WrenchStamped, "wrench")
        self._signals = self._latest(IOState, "io_state")
        self._actual: Optional[LatestTopic] = None
        self._subscribe()

    def name_of(self, name: str) -> str:
        """Returns the full name of a topic, service or action of this robot."""
        return f"/{self.namespace}/{name}" if self.namespace else f"/{name}"

    def _latest(self, message_type: Any, topic: str) -> LatestTopic:
        return LatestTopic(self._nodes.polled, message_type, self.name_of(topic))

    def _subscribe(self) -> None:
        state = self.state

        def subscribe(message_type: Any, topic: str, store: Any, depth: int = 1) -> None:
            qos = QoSProfile(depth=depth, durability=DurabilityPolicy.TRANSIENT_LOCAL)
            self._nodes.node.create_subscription(message_type, self.name_of(topic), store, qos)

        subscribe(RobotMode, "robot_mode", lambda message: setattr(state, "robot_mode", message.name))
        subscribe(SafetyMode, "safety_mode", lambda message: setattr(state, "safety_mode", message.name))
        subscribe(Bool, "program_running", lambda message: setattr(state, "program_running", message.data))
        subscribe(Bool, "joint_states_are_fake", lambda message: setattr(state, "joint_states_are_fake", message.data))
        subscribe(Float64, "speed_scaling", lambda message: setattr(state, "speed_scaling", message.data))
        subscribe(ActiveModes, "active_modes", lambda message: setattr(state, "active_modes", tuple(message.names)))
        subscribe(DriverState, "driver_state", lambda message: setattr(
            state, "driver", DriverStatus(message.name, message.cause, message.message)))
        subscribe(GoalRejected, "goal_rejections", lambda message: state.rejections.append(
            Rejection(seconds(message.stamp), message.action, message.message)), depth=MAX_REJECTIONS)

    def _receive_actual_joints(self, on: bool) -> None:
        """Subscribes to actual_joint_states, which the driver publishes only while there is a subscriber."""
        if on and self._actual is None:
            self._actual = self._latest(JointState, "actual_joint_states")
        elif not on and self._actual is not None:
            self._actual.close()
            self._actual, self.state.actual_joints = None, None

    def poll(self) -> None:
        """Takes the newest messages of the polled topics. Called once per update."""
        state = self.state
        state.joints = self._read_joints(self._joints, state.joints)
        state.target_joints = self._read_joints(self._target, state.target_joints)
        self._receive_actual_joints(state.joint_states_are_fake)
        if self._actual is not None:
            state.actual_joints = self._read_joints(self._actual, state.actual_joints)
        pose = self._tcp_pose.take()
        if pose is not None:
            self._last_pose = time.monotonic()
            p, q = pose.pose.position, pose.pose.orientation
            state.tcp_pose = Pose(np.array((p.x, p.y, p.z)), np.array((q.w, q.x, q.y, q.z)))
        wrench = self._wrench.take()
        if wrench is not None:
            f, t = wrench.wrench.force, wrench.wrench.torque
            state.wrench = np.array((f.x, f.y, f.z, t.x, t.y, t.z))
        io = self._signals.take()
        if io is not None:
            values = (io.digital_inputs, io.digital_outputs, io.analog_inputs, io.analog_outputs)
            state.signals = Signals(*map(tuple, values))
        now = time.monotonic()
        state.age, state.pose_age = now - self._last_received, now - self._last_pose

    def _learn_names(self, message: JointState) -> None:
        first = next((name for name in message.name if name.endswith(JOINTS[0])), None)
        if first is not None:
            self.joint_names = tuple(first[:-len(JOINTS[0])] + joint for joint in JOINTS)

    def _read_joints(self, topic: LatestTopic, previous: Optional[Joints]) -> Optional[Joints]:
        message = topic.take()
        if message is None:
            return previous
        if topic is self._joints:
            self._last_received = time.monotonic()
            self._learn_names(message)
        return read_joints(message) or previous
