"""The ROS node with everything that can move an arm, and its thread.

The thread does nothing else, so that STOP does not wait for the scene or the plots.
"""

import logging
import queue
import threading
from typing import Any, Callable

import rclpy
from rclpy.clock import Clock, ClockType
from rclpy.executors import ExternalShutdownException, ShutdownException, SingleThreadedExecutor

logger = logging.getLogger(__name__)

WAIT_TIMEOUT = 1.0  # s
JOIN_TIMEOUT = 5.0  # s


def create_steady_timer(node: Any, period: float, callback: Callable[[], None]) -> Any:
    """Returns a timer that does not follow the system clock, which may be set, as the clock of the node does."""
    return node.create_timer(period, callback, clock=Clock(clock_type=ClockType.STEADY_TIME))


class ControlNode:
    """Before start(), entities are created in any thread; afterwards in the thread of the node alone, because the executor would
    use an entity that is only half created."""

    def __init__(self, context: rclpy.Context):
        self.node: Any = rclpy.create_node("ur_viewer_control", context=context, enable_rosout=False, start_parameter_services=False)
        self._context = context
        self._executor = SingleThreadedExecutor(context=context)
        self._executor.add_node(self.node)
        self._posted: "queue.SimpleQueue[Callable[[], Any]]" = queue.SimpleQueue()
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._spin, name="control", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def _spin(self) -> None:
        while self._context.ok() and not self._ended.is_set():
            try:
                self._executor.spin_once(timeout_sec=WAIT_TIMEOUT)
            except (ExternalShutdownException, ShutdownException):
                return
            except Exception:  # STOP has to work after a failed callback
                logger.exception("a callback of a command failed")

    def post(self, function: Callable[[], Any]) -> None:
        """Calls `function` in the thread of the node, unless it has ended, after those that were posted before. rclpy loses a response
        that arrives while another thread still sends the request, so every request is sent in this thread."""
        if not self._ended.is_set():
            self._posted.put(function)
            self._executor.create_task(self._run_oldest)  # one task per function: the executor begins with the newest task

    def _run_oldest(self) -> None:
        self._posted.get()()

    def close(self) -> None:
        self._ended.set()
        self._executor.wake()
        self._thread.join(JOIN_TIMEOUT)
        self._executor.shutdown()
        self.node.destroy_node()
