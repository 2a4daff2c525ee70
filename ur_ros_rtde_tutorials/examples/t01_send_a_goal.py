#!/usr/bin/env python3
"""t01: send a goal, show its progress, read its result.

Turns wrist 3 by a quarter turn, to wherever it is not.   ros2 run ur_ros_rtde_tutorials t01_send_a_goal.py
"""

import math
import sys

import rclpy
from rclpy.action import ActionClient
from rclpy.node import Node

from ur_ros_rtde_msgs.action import MoveJ
from ur_ros_rtde_msgs.srv import GetJointState


def wait(node, future, seconds, what):
    rclpy.spin_until_future_complete(node, future, timeout_sec=seconds)
    if not future.done():
        raise SystemExit(f"{what} took longer than {seconds} s: do the nodes run?")
    return future.result()


def main():
    rclpy.init()
    node = Node("t01_send_a_goal")

    # Where the arm is: the joints in the order in which goals take them.
    state = node.create_client(GetJointState, "get_joint_state")
    if not state.wait_for_service(timeout_sec=10.0):
        raise SystemExit("there is no robot_state_receiver: start the driver first")
    answer = wait(node, state.call_async(GetJointState.Request()), 5.0, "the answer of get_joint_state")
    if not answer.success:
        raise SystemExit(answer.message)

    goal = MoveJ.Goal(joint_positions=list(answer.joint_state.position), speed=0.5, acceleration=1.0)
    goal.joint_positions[5] += -math.pi / 2 if goal.joint_positions[5] > 0 else math.pi / 2

    client = ActionClient(node, MoveJ, "move_j")
    if not client.wait_for_server(timeout_sec=10.0):
        raise SystemExit("there is no command_server: start the driver first")
    sent = client.send_goal_async(
        goal, feedback_callback=lambda message: print(f"\r{100 * message.feedback.motion.progress:5.1f} %", end=""))
    handle = wait(node, sent, 10.0, "the answer to the goal")
    if not handle.accepted:
        raise SystemExit("refused: the log of command_server and the topic goal_refusals say why")
    result = wait(node, handle.get_result_async(), 60.0, "the motion").result
    print(f"\n{'done' if result.success else 'failed'}, error_code {result.error_code}, {result.message or 'no message'}")

    node.destroy_node()
    rclpy.try_shutdown()
    return 0 if result.success else 1


if __name__ == "__main__":
    sys.exit(main())
