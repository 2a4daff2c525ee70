"""A node for as long as a command of the command line lasts."""

import contextlib
import select
import signal
import sys
import time
from typing import Callable, Iterator, Optional, TypeVar

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

T = TypeVar("T")

# `timeout` sends its signal twice, to the process and to its group: what comes within this time is one request.
SECOND_SIGNAL_AFTER = 1.0  # s


class Interrupted(Exception):
    """The program is asked to end, by a signal; SIGPIPE stands for an output that is closed."""

    def __init__(self, number: int):
        super().__init__(signal.Signals(number).name)
        self.number = number

    @property
    def exit_code(self) -> int:
        return 128 + self.number


class _Interruptions:
    """Signals and closed outputs, kept until they are asked for: rclpy does not survive an exception within a callback."""

    def __init__(self) -> None:
        self._pending: Optional[int] = None
        self._last: Optional[float] = None
        self._previous = {}
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            if number != signal.SIGHUP or signal.getsignal(number) != signal.SIG_IGN:  # nohup ignores SIGHUP
                self._previous[number] = signal.signal(number, lambda number, _: self._add(number))
        self._outputs = select.poll()
        for stream in filter(None, (sys.stdout, sys.stderr)):
            self._outputs.register(stream.fileno(), 0)  # errors are reported without being asked for

    def _add(self, number: int) -> None:
        now = time.monotonic()
        if self._last is None or now - self._last >= SECOND_SIGNAL_AFTER:
            self._last, self._pending = now, number

    def restore(self) -> None:
        for number, handler in self._previous.items():
            signal.signal(number, handler)

    def take(self) -> Optional[Interrupted]:
        # Outputs stay closed: that is told once, and only if nothing else has interrupted the program before.
        if self._last is None and any(event & (select.POLLERR | select.POLLHUP) for _, event in self._outputs.poll(0)):
            self._add(signal.SIGPIPE)
        number, self._pending = self._pending, None
        return None if number is None else Interrupted(number)


class Session:
    def __init__(self, namespace: str):
        self.context = rclpy.Context()
        self._interruptions = _Interruptions()
        rclpy.init(context=self.context, signal_handler_options=SignalHandlerOptions.NO)
        self.node: Node = rclpy.create_node("ur_cli", namespace=namespace or None, context=self.context)
        self._executor = SingleThreadedExecutor(context=self.context)
        self._executor.add_node(self.node)

    def close(self) -> None:
        self._executor.shutdown()
        self.node.destroy_node()
        self.context.try_shutdown()
        self._interruptions.restore()

    def wait(self, condition: Callable[[], Optional[T]], limit: Optional[float] = None) -> Optional[T]:
        """The first value of `condition` that counts as true; None after `limit` s. Raises Interrupted."""
        end = None if limit is None else time.monotonic() + limit
        while True:
            value = condition()
            if value:
                return value
            if end is not None and time.monotonic() >= end:
                return None
            self._executor.spin_once(timeout_sec=0.05)
            interrupted = self._interruptions.take()
            if interrupted:
                raise interrupted

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
