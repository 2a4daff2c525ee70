"""A node for as long as a command of the command line lasts."""

import contextlib
import signal
import time
from typing import Callable, Iterator, Optional, TypeVar

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

T = TypeVar("T")


class Session:
    def __init__(self, namespace: str):
        self.context = rclpy.Context()
        # Ctrl-C is ours: it cancels a goal. It is looked at between two callbacks, as rclpy does not survive it within one.
        self._interrupted = False
        self._previous = signal.signal(signal.SIGINT, self._interrupt)
        rclpy.init(context=self.context, signal_handler_options=SignalHandlerOptions.NO)
        self.node: Node = rclpy.create_node("ur_cli", namespace=namespace or None, context=self.context)
        self._executor = SingleThreadedExecutor(context=self.context)
        self._executor.add_node(self.node)

    def _interrupt(self, _number: int, _frame: object) -> None:
        self._interrupted = True

    def close(self) -> None:
        signal.signal(signal.SIGINT, self._previous)
        self._executor.shutdown()
        self.node.destroy_node()
        self.context.try_shutdown()

    def wait(self, condition: Callable[[], Optional[T]], limit: Optional[float] = None) -> Optional[T]:
        """The first value of `condition` that counts as true; None after `limit` s. Ctrl-C ends it by KeyboardInterrupt."""
        end = None if limit is None else time.monotonic() + limit
        while True:
            value = condition()
            if value:
                return value
            if end is not None and time.monotonic() >= end:
                return None
            self._executor.spin_once(timeout_sec=0.05)
            if self._interrupted:
                self._interrupted = False
                raise KeyboardInterrupt

    def answer(self, future, limit: Optional[float] = None):
        """What a future brings; None after `limit` s."""
        return future.result() if self.wait(future.done, limit) else None


@contextlib.contextmanager
def session(namespace: str) -> Iterator[Session]:
    made = Session(namespace)
    try:
        yield made
    finally:
        made.close()
