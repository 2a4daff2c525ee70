#!/usr/bin/env python3
"""t03: cancels a goal.

The tool moves up slowly. The goal is canceled after half a second, or by a signal, and the arm decelerates to standstill.

ros2 run ur_ros_rtde_tutorials t03_cancel_a_goal.py
"""

import sys

import rclpy
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import Twist, Vector3
from goal_client import cancel_on_signals, received_signals, wait_for, wait_for_result
from rclpy.action import ActionClient
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from ur_ros_rtde_msgs.action import SpeedL


def main():
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = Node("t03_cancel_a_goal")
    client = ActionClient(node, SpeedL, "speed_l")
    if not client.wait_for_server(timeout_sec=10.0):
        raise SystemExit("command_server is not running: start the driver first")

    goal = SpeedL.Goal(twist=Twist(linear=Vector3(z=0.03)), time=5.0)
    cancel_on_signals()
    handle = wait_for(node, client.send_goal_async(goal), 10.0, "response to the goal")
    if not handle.accepted:
        raise SystemExit("rejected: see the log of command_server or the topic goal_rejections for the reason")
    response = wait_for_result(node, handle, 0.5)
    canceled = response.status == GoalStatus.STATUS_CANCELED
    height = response.result.final_state.tcp_pose.position.z
    print(f"{'canceled' if canceled else 'not canceled'}: {response.result.message}; the height of the tool is {height:.3f} m")

    node.destroy_node()
    rclpy.try_shutdown()
    return 128 + received_signals[0] if received_signals else 0 if canceled else 1


if __name__ == "__main__":
    sys.exit(main())
