#!/usr/bin/env python3
"""t03: cancel a goal: the tool moves up slowly, and is stopped after half a second by a cancel, decelerating.

ros2 run ur_ros_rtde_tutorials t03_cancel_a_goal.py
"""

import sys
import time

import rclpy
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import Twist, Vector3
from rclpy.action import ActionClient
from rclpy.node import Node

from ur_ros_rtde_msgs.action import SpeedL


def wait(node, future, seconds, what):
    rclpy.spin_until_future_complete(node, future, timeout_sec=seconds)
    if not future.done():
        raise SystemExit(f"{what} took longer than {seconds} s")
    return future.result()


def main():
    rclpy.init()
    node = Node("t03_cancel_a_goal")
    client = ActionClient(node, SpeedL, "speed_l")
    if not client.wait_for_server(timeout_sec=10.0):
        raise SystemExit("there is no command_server: start the driver first")

    goal = SpeedL.Goal(twist=Twist(linear=Vector3(z=0.03)), time=5.0)
    handle = wait(node, client.send_goal_async(goal), 10.0, "the answer to the goal")
    if not handle.accepted:
        raise SystemExit("refused: the log of command_server and the topic goal_refusals say why")
    end = time.monotonic() + 0.5
    while time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.05)
    wait(node, handle.cancel_goal_async(), 5.0, "the answer to the cancel request")
    answer = wait(node, handle.get_result_async(), 10.0, "the standstill")
    canceled = answer.status == GoalStatus.STATUS_CANCELED
    height = answer.result.final_state.tcp_pose.position.z
    print(f"{'canceled' if canceled else 'not canceled'}: {answer.result.message}; the tool stands at {height:.3f} m")

    node.destroy_node()
    rclpy.try_shutdown()
    return 0 if canceled else 1


if __name__ == "__main__":
    sys.exit(main())
