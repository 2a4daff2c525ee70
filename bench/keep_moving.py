"""Moves the arm back and forth until it is stopped. Started by `./ur bench --viewer`."""

import itertools

import rclpy
from many_goals import finish
from rclpy.action import ActionClient
from rclpy.node import Node

from ur_ros_rtde_msgs.action import MoveJ

POSITIONS = ([0.5, -1.57, 1.57, -1.57, -1.57, 0.3], [-0.5, -1.2, 1.2, -1.57, -1.2, -0.3])  # rad
SERVER_TIMEOUT = 30.0  # s


def main():
    rclpy.init()
    node = Node("bench_motion")
    client = ActionClient(node, MoveJ, "move_j")
    if not client.wait_for_server(timeout_sec=SERVER_TIMEOUT):
        raise SystemExit("bench: the action move_j was not found")
    for positions in itertools.cycle(POSITIONS):
        handle = finish(node, client.send_goal_async(MoveJ.Goal(joint_positions=positions, speed=0.3)))
        if not handle.accepted:
            raise SystemExit("bench: a goal was rejected; see the topic goal_rejections")
        finish(node, handle.get_result_async())


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        pass
