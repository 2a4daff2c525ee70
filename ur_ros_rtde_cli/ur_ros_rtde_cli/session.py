"""A ROS node for the duration of one command."""

import contextlib
import os
import time
from typing import Any, Callable, Iterator, Optional, TypeVar

import rclpy
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.qos import QoSProfile
from rclpy.signals import SignalHandlerOptions

from .errors import CliError
from .interruptions import PendingInterruption

T = TypeVar("T")

POLL_PERIOD = 0.05  # s, for signals; messages and results wake the executor
MOST_DOMAIN = 232  # the ports of a higher one do not exist
GRAPH_POLL_PERIOD = 0.01  # s; changes of the ROS graph do not wake the executor


def _start_discovery(context: rclpy.Context) -> Any:
    """Creates a bare node, which starts the discovery of other nodes.

    An rclpy Node imports numpy and many interfaces. The import takes about half as long as the discovery and can run at the same
    time. The bare node is not part of the public API of rclpy. Returns None if its signature is unknown.
    """
    arguments = ("_ur_cli_discovery", "", context.handle, None, False, False)
    for rosout_qos in ((), (QoSProfile(depth=1).get_c_qos_profile(),)):  # the second since Kilted
        try:
            with context.handle:
                return rclpy_implementation.Node(*arguments, *rosout_qos)
        except (AttributeError, TypeError):
            continue
    return None


def _check_domain(text: str) -> None:
    if text and not (text.isdecimal() and int(text) <= MOST_DOMAIN):
        raise CliError(f"ROS_DOMAIN_ID is \"{text}\": it must be a number from 0 to {MOST_DOMAIN}")


class Session:
    def __init__(self, namespace: str):
        _check_domain(os.environ.get("ROS_DOMAIN_ID", ""))
        self.context = rclpy.Context()
        self._interruption = PendingInterruption()
        rclpy.init(context=self.context, signal_handler_options=SignalHandlerOptions.NO)
        bare_node = _start_discovery(self.context)
        from rclpy.executors import SingleThreadedExecutor  # imported here because the discovery runs in the meantime

        # Omitting unneeded endpoints shortens the start and the discovery.
        self.node: Any = rclpy.create_node("ur_cli", namespace=namespace or None, context=self.context, enable_rosout=False,
                                           start_parameter_services=False)
        if bare_node is not None:
            bare_node.destroy_when_not_in_use()
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

    def result(self, future: Any, limit: Optional[float] = None) -> Any:
        """Returns the result of a future, or None after `limit` s. Raises Interrupted."""
        return future.result() if self.wait(future.done, limit) else None


@contextlib.contextmanager
def session(namespace: str) -> Iterator[Session]:
    created = Session(namespace)
    try:
        yield created
    finally:
        created.close()
