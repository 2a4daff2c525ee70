"""Sends goals to a driver one after the other and records its memory. Started by `./ur bench --scale`."""

import argparse
import json
import time
from pathlib import Path

import rclpy
from process_load import resident_megabytes
from rclpy.action import ActionClient
from rclpy.node import Node

from ur_ros_rtde_msgs.action import SetPayload

LIMIT = 30.0  # s, of one response
POINTS = 100


def finish(node, future):
    rclpy.spin_until_future_complete(node, future, timeout_sec=LIMIT)
    if not future.done():
        raise SystemExit(f"bench: no response within {LIMIT:g} s")
    return future.result()


def send_goals(node, client, count, on_goal):
    """Sends `count` goals. Each has ended before the next one is sent, and before `on_goal(number)` is called."""
    for number in range(count):
        handle = finish(node, client.send_goal_async(SetPayload.Goal(mass=0.5 + 0.01 * (number % 10))))
        if not handle.accepted:
            raise SystemExit("bench: a goal was rejected; see the topic goal_rejections")
        answer = finish(node, handle.get_result_async())
        if not answer.result.success:
            raise SystemExit(f"bench: a goal failed: {answer.result.message}")
        on_goal(number + 1)


def growth(memory):
    """Returns the growth over the second half, from the medians of its first and its last fifth.

    In the first half the memory grows: a driver keeps each result for some seconds, and the allocator keeps what it has used.
    """
    half = memory[len(memory) // 2:]
    part = max(1, len(half) // 5)
    middle = [sorted(values)[len(values) // 2] for values in (half[:part], half[-part:])]
    return middle[1] - middle[0]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--pid", type=int, required=True, help="the driver")
    parser.add_argument("--goals", type=int, required=True)
    parser.add_argument("--output", required=True, type=Path, metavar="FILE", help="file for the figures")
    options = parser.parse_args()
    rclpy.init()
    node = Node("bench_goals")
    client = ActionClient(node, SetPayload, "set_payload")
    if not client.wait_for_server(timeout_sec=15.0):
        raise SystemExit("bench: the action set_payload was not found")
    memory, every = [], max(1, options.goals // POINTS)

    def record(number):
        if number % every == 0:
            memory.append((number, resident_megabytes(options.pid)))

    begin = time.monotonic()
    send_goals(node, client, options.goals, record)
    duration = 1e3 * (time.monotonic() - begin) / options.goals
    rclpy.try_shutdown()
    figures = {"growth": growth([megabytes for _, megabytes in memory]), "duration": duration}
    options.output.write_text(json.dumps({"figures": figures, "samples": memory}))


if __name__ == "__main__":
    main()
