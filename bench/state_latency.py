"""Latency from a package of the controller to a subscriber, from received messages and the simulator's trace.

The stamp of a message is the time at which the driver received the package: the package is the last one sent before it.
"""

import bisect
import time

import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState

# The stamp is derived from a monotonic clock; the two clocks are read one after the other.
CLOCK_TOLERANCE = 20_000  # ns


def percentile(values, fraction):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(fraction * len(ordered)))]


def latencies(received, trace):
    """Returns the latencies in ms of messages [(stamp, time of reception)] in ns."""
    sent = [published for _, published, _ in trace["cycles"]]
    result = []
    for stamp, when in received:
        index = bisect.bisect_right(sent, stamp + CLOCK_TOLERANCE) - 1
        if index >= 0:
            result.append((when - sent[index]) * 1e-6)
    return result


def receive_in_python(seconds):
    """Returns [(stamp, time of reception)] in ns of joint_states."""
    received = []

    def on_joint_state(message):
        stamp = message.header.stamp
        received.append((stamp.sec * 1_000_000_000 + stamp.nanosec, time.time_ns()))

    node = Node("bench_subscriber")
    qos = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
    node.create_subscription(JointState, "joint_states", on_joint_state, qos)
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(node)
    limit = time.monotonic() + 15.0
    while not received and time.monotonic() < limit:
        executor.spin_once(timeout_sec=0.1)
    received.clear()
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        executor.spin_once(timeout_sec=0.1)
    node.destroy_node()
    return received
