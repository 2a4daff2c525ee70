#!/usr/bin/env python3
"""t03: cancels a goal.

The tool moves up slowly. The goal is canceled after half a second, or by a signal, and the arm decelerates to standstill.

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


signals = []  # received signals that end this program


def wait(node, future, seconds, what):
    rclpy.spin_until_future_complete(node, future, timeout_sec=seconds)
    if not future.done():
        raise SystemExit(f"no {what} within {seconds} s")
    return future.result()


def cancel_on_signals():
    """Stores signals in `signals`. The handlers of rclpy would close the connection to the driver instead."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda number, _: signals.append(number))


def wait_for_result(node, handle, seconds):
    """Waits for the result. Cancels the goal after a signal or after `seconds`. The result then arrives at standstill."""
    result = handle.get_result_async()
    end = time.monotonic() + seconds
    while not result.done() and not signals and time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.05)
    if not result.done():
        for number in signals:
            signal.signal(number, signal.SIG_DFL)  # a second signal ends the program at once
        handle.cancel_goal_async()
    return wait(node, result, 10.0, "result of the canceled goal")


def main():
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = Node("t03_cancel_a_goal")
    client = ActionClient(node, SpeedL, "speed_l")
    if not client.wait_for_server(timeout_sec=10.0):
        raise SystemExit("command_server is not running: start the driver first")

    goal = SpeedL.Goal(twist=Twist(linear=Vector3(z=0.03)), time=5.0)
    cancel_on_signals()
    handle = wait(node, client.send_goal_async(goal), 10.0, "response to the goal")
    if not handle.accepted:
        raise SystemExit("refused: see the log of command_server or the topic goal_refusals for the reason")
    response = wait_for_result(node, handle, 0.5)
    canceled = response.status == GoalStatus.STATUS_CANCELED
    height = response.result.final_state.tcp_pose.position.z
    print(f"{'canceled' if canceled else 'not canceled'}: {response.result.message}; the height of the tool is {height:.3f} m")

    node.destroy_node()
    rclpy.try_shutdown()
    return 128 + signals[0] if signals else 0 if canceled else 1


if __name__ == "__main__":
    sys.exit(main())
