"""A node that exists as long as one command of the command line runs."""

import contextlib
import time
from typing import Callable, Iterator, Optional, TypeVar

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from .interruptions import PendingInterruption

T = TypeVar("T")

POLL_PERIOD = 0.05  # s, for signals; messages and results wake the executor
GRAPH_POLL_PERIOD = 0.01  # s; changes of the ROS graph do not wake the executor


class Session:
    def __init__(self, namespace: str):
        self.context = rclpy.Context()
        self._interruption = PendingInterruption()
        rclpy.init(context=self.context, signal_handler_options=SignalHandlerOptions.NO)
        # Each endpoint that is left out makes the start and the discovery shorter.
        self.node: Node = rclpy.create_node("ur_cli", namespace=namespace or None, context=self.context, enable_rosout=False,
                                            start_parameter_services=False)
        self._executor = SingleThreadedExecutor(context=self.context)
        self._executor.add_node(self.node)

    def close(self) -> None:
        self._executor.shutdown()
        self.node.destroy_node()
        self.context.try_shutdown()
        self._interruption.restore_handlers()

    def wait(self, condition: Callable[[], Optional[T]], limit: Optional[float] = None, period: float = POLL_PERIOD) -> Optional[T]:
        """Returns the first true value of `condition`, or None after `limit` s. Raises Interrupted."""
        end = None if limit is None else time.monotonic() + limit
        while True:
            value = condition()
            if value:
                return value
            if end is not None and time.monotonic() >= end:
                return None
            self._executor.spin_once(timeout_sec=period)
            interrupted = self._interruption.take()
            if interrupted:
                raise interrupted

    def result(self, future, limit: Optional[float] = None):
        """The result of a future, or None after `limit` s."""
        return future.result() if self.wait(future.done, limit) else None


@contextlib.contextmanager
def session(namespace: str) -> Iterator[Session]:
    created = Session(namespace)
    try:
        yield created
    finally:
        created.close()
