"""Helpers of the examples that send goals: waits with a time limit, and cancellation by signals."""

import signal
import time

import rclpy

received_signals: list[int] = []  # signals that end the example


def wait_for(node, future, seconds, what):
    """Returns the result of a future, or exits with an error message after `seconds`."""
    rclpy.spin_until_future_complete(node, future, timeout_sec=seconds)
    if not future.done():
        raise SystemExit(f"no {what} within {seconds} s: check that the nodes are running")
    return future.result()


def cancel_on_signals():
    """Stores signals in `received_signals`. The handlers of rclpy would close the connection to the driver instead."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda number, _: received_signals.append(number))


def wait_for_result(node, handle, seconds):
    """Waits for the result. Cancels the goal after a signal or after `seconds`. The result then arrives at standstill."""
    result = handle.get_result_async()
    end = time.monotonic() + seconds
    while not result.done() and not received_signals and time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.05)
    if not result.done():
        for number in received_signals:
            signal.signal(number, signal.SIG_DFL)  # a second signal ends the program at once
        handle.cancel_goal_async()
    return wait_for(node, result, 10.0, "result of the canceled goal")
