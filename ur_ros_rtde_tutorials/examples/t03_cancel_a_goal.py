#!/usr/bin/env python3
"""t03: cancel a goal: the tool moves up slowly, is canceled after half a second, and decelerates. So do signals cancel it.

ros2 run ur_ros_rtde_tutorials t03_cancel_a_goal.py
"""

import signal
import sys
import time

import rclpy
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import Twist, Vector3
from rclpy.action import ActionClient
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from ur_ros_rtde_msgs.action import SpeedL


signals = []  # that ask this program to end


def wait(node, future, seconds, what):
    rclpy.spin_until_future_complete(node, future, timeout_sec=seconds)
    if not future.done():
        raise SystemExit(f"{what} took longer than {seconds} s")
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


def main():
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = Node("t03_cancel_a_goal")
    client = ActionClient(node, SpeedL, "speed_l")
    if not client.wait_for_server(timeout_sec=10.0):
        raise SystemExit("there is no command_server: start the driver first")

    goal = SpeedL.Goal(twist=Twist(linear=Vector3(z=0.03)), time=5.0)
    cancel_on_signals()
    handle = wait(node, client.send_goal_async(goal), 10.0, "the answer to the goal")
    if not handle.accepted:
        raise SystemExit("refused: the log of command_server and the topic goal_refusals say why")
    answer = result_of(node, handle, 0.5)
    canceled = answer.status == GoalStatus.STATUS_CANCELED
    height = answer.result.final_state.tcp_pose.position.z
    print(f"{'canceled' if canceled else 'not canceled'}: {answer.result.message}; the tool stands at {height:.3f} m")

    node.destroy_node()
    rclpy.try_shutdown()
    return 128 + signals[0] if signals else 0 if canceled else 1


if __name__ == "__main__":
    sys.exit(main())
