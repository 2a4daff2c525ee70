#!/usr/bin/env python3
"""t01: sends a goal, shows its progress and reads its result.

Rotates wrist 3 by a quarter turn. Ctrl-C, SIGTERM, SIGHUP and a closed output cancel the goal.

ros2 run ur_ros_rtde_tutorials t01_send_a_goal.py
"""

import math
import os
import signal
import sys

import rclpy
from goal_client import cancel_on_signals, received_signals, wait_for, wait_for_result
from rclpy.action import ActionClient
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from ur_ros_rtde_msgs.action import MoveJ
from ur_ros_rtde_msgs.srv import GetJointState


def show_progress(message):
    try:
        print(f"\r{100 * message.feedback.motion.progress:5.1f} %", end="", flush=True)
    except BrokenPipeError:  # the output was closed
        received_signals.append(signal.SIGPIPE)
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def main():
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = Node("t01_send_a_goal")

    # The current joint positions, in the order of the goal.
    state = node.create_client(GetJointState, "get_joint_state")
    if not state.wait_for_service(timeout_sec=10.0):
        raise SystemExit("robot_state_receiver is not running: start the driver first")
    response = wait_for(node, state.call_async(GetJointState.Request()), 5.0, "response of get_joint_state")
    if not response.success:
        raise SystemExit(response.message)

    goal = MoveJ.Goal(joint_positions=list(response.joint_state.position), speed=0.5, acceleration=1.0)
    goal.joint_positions[5] += -math.pi / 2 if goal.joint_positions[5] > 0 else math.pi / 2

    client = ActionClient(node, MoveJ, "move_j")
    if not client.wait_for_server(timeout_sec=10.0):
        raise SystemExit("command_server is not running: start the driver first")
    cancel_on_signals()
    handle = wait_for(node, client.send_goal_async(goal, feedback_callback=show_progress), 10.0, "response to the goal")
    if not handle.accepted:
        raise SystemExit("rejected: see the log of command_server or the topic goal_rejections for the reason")
    result = wait_for_result(node, handle, 60.0).result
    print(f"\n{'done' if result.success else 'failed'}, error_code {result.error_code}, {result.message or 'no message'}")

    node.destroy_node()
    rclpy.try_shutdown()
    return 128 + received_signals[0] if received_signals else 0 if result.success else 1


if __name__ == "__main__":
    sys.exit(main())
