#!/usr/bin/env python3
"""Sends a move_j goal for the base joint, prints the goal id, and spins until it is terminated, without canceling the goal.

move_j_client.py <base joint in rad> <namespace> [destroy]

With `destroy`, it destroys its action client at the first line on stdin and keeps running.
"""

import sys

import rclpy
from rclpy.action import ActionClient
from support import HOME

from ur_ros_rtde_msgs.action import MoveJ


def main():
    rclpy.init()
    node = rclpy.create_node("move_j_client", namespace=sys.argv[2] or None)
    client = ActionClient(node, MoveJ, "move_j")
    assert client.wait_for_server(timeout_sec=20.0)
    sent = client.send_goal_async(MoveJ.Goal(joint_positions=[float(sys.argv[1]), *HOME[1:]], speed=0.2, acceleration=0.5))
    rclpy.spin_until_future_complete(node, sent)
    assert sent.result().accepted
    print("goal", bytes(sent.result().goal_id.uuid).hex(), flush=True)
    if sys.argv[3:] == ["destroy"]:
        sys.stdin.readline()
        client.destroy()
        print("destroyed", flush=True)
    rclpy.spin(node)


if __name__ == "__main__":
    main()
