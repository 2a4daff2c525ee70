#!/usr/bin/env python3
"""t01: send a goal, show its progress, read its result.

Turns wrist 3 by a quarter turn. Ctrl-C, SIGTERM, SIGHUP and a closed output cancel the goal.

ros2 run ur_ros_rtde_tutorials t01_send_a_goal.py
"""

import math
import os
import signal
import sys
import time

import rclpy
from rclpy.action import ActionClient
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from ur_ros_rtde_msgs.action import MoveJ
from ur_ros_rtde_msgs.srv import GetJointState


signals = []  # that ask this program to end


def wait(node, future, seconds, what):
    rclpy.spin_until_future_complete(node, future, timeout_sec=seconds)
    if not future.done():
        raise SystemExit(f"{what} took longer than {seconds} s: do the nodes run?")
    return future.result()


def cancel_on_signals():
    """A signal is kept in `signals`, and nothing else happens: rclpy's own handlers would end the connection to the driver."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda number, _: signals.append(number))


def result_of(node, handle, seconds):
    """Waits for the result. After a signal, or `seconds`, the goal is canceled: the arm decelerates, then the result comes."""
    result = handle.get_result_async()
    end = time.monotonic() + seconds
    while not result.done() and not signals and time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.05)
    if not result.done():
        for number in signals:
            signal.signal(number, signal.SIG_DFL)  # a second one ends the program at once
        handle.cancel_goal_async()
    return wait(node, result, 10.0, "the standstill")


def show_progress(message):
    try:
        print(f"\r{100 * message.feedback.motion.progress:5.1f} %", end="", flush=True)
    except BrokenPipeError:  # nobody reads it any more
        signals.append(signal.SIGPIPE)
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def main():
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
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
    cancel_on_signals()
    handle = wait(node, client.send_goal_async(goal, feedback_callback=show_progress), 10.0, "the answer to the goal")
    if not handle.accepted:
        raise SystemExit("refused: the log of command_server and the topic goal_refusals say why")
    result = result_of(node, handle, 60.0).result
    print(f"\n{'done' if result.success else 'failed'}, error_code {result.error_code}, {result.message or 'no message'}")

    node.destroy_node()
    rclpy.try_shutdown()
    return 128 + signals[0] if signals else 0 if result.success else 1


if __name__ == "__main__":
    sys.exit(main())
