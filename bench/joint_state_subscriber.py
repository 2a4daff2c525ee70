"""Receives joint_states in Python."""

import time

import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState

DISCOVERY_TIME = 1.0  # s, after the first message, in which the node still discovers: as in joint_state_latency.cpp


def receive_in_python(seconds, topic="joint_states"):
    """Returns [(stamp, time of reception)] in ns of joint states."""
    received = []

    def on_joint_state(message):
        stamp = message.header.stamp
        received.append((stamp.sec * 1_000_000_000 + stamp.nanosec, time.time_ns()))

    node = Node("bench_subscriber")
    qos = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
    node.create_subscription(JointState, topic, on_joint_state, qos)
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(node)
    limit = time.monotonic() + 15.0
    while not received and time.monotonic() < limit:
        executor.spin_once(timeout_sec=0.1)
    _spin(executor, DISCOVERY_TIME)
    received.clear()
    _spin(executor, seconds)
    node.destroy_node()
    return received


def _spin(executor, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        executor.spin_once(timeout_sec=0.1)
