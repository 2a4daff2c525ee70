"""A node that subscribes to all visible topics of a robot, like a careless user's. Runs until it is stopped."""

import importlib
import time

import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

SEARCH = 2.0  # s between searches for new topics


def is_hidden(topic):
    """Returns whether a topic is hidden, as those of actions are: a part of its name begins with an underscore."""
    return "/_" in topic


def message_class(kind):
    """Returns the class of a type such as "std_msgs/msg/String"; None if it is not installed."""
    package, _, name = kind.split("/")
    try:
        return getattr(importlib.import_module(f"{package}.msg"), name)
    except ImportError:
        return None


def main():
    rclpy.init()
    node = Node("bench_everything")
    known, count = set(), 0

    def on_message(_):
        nonlocal count
        count += 1

    def subscribe_to_new_topics():
        for topic, kinds in node.get_topic_names_and_types():
            kind = None if is_hidden(topic) else message_class(kinds[0])
            if topic not in known and kind is not None:
                known.add(topic)
                node.create_subscription(kind, topic, on_message, QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT))

    node.create_timer(SEARCH, subscribe_to_new_topics)
    begin = time.monotonic()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        print(f"{len(known)} topics, {count / (time.monotonic() - begin):.0f} messages per second", flush=True)
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
