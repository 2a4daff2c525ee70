"""A session in which messages on a topic of the driver move the arm."""

import contextlib
import threading
import time
from collections.abc import Callable
from typing import Any

from ur_ros_rtde_cli.driver_watch import CANCEL_TIMEOUT, CHECK_PERIOD, LOOK_PERIOD, LOSS_TIME, loss

from .connection import Connection, until
from .conversions import interface
from .errors import BUSY, TIMEOUT, NoDriver, Rejected, RobotError, StreamEnded, Timeout
from .teleoperation_state import End, TeleoperationState, stamp_of

PAUSE = 1.5  # times stream_timeout, before the first message: the driver ignores those that follow a session without a pause
HOLD_PERIOD = 0.25  # times stream_timeout, between the messages until the session has started
BRAKE_TIME = 0.5  # times stream_timeout, after the last message: a message after the end would start another session


class Teleoperation:
    """One session, from start() to stop(), called `name` in errors. publish() and stop() may be called by different threads."""

    def __init__(self, connection: Connection, name: str, topic: str, kind: str):
        from rclpy.qos import QoSProfile, ReliabilityPolicy

        self._connection, self._name, self._topic = connection, name, topic
        self._lock = threading.RLock()
        self._is_open = False
        self._timeout = self._stream_timeout()
        self._state = TeleoperationState(connection, topic)
        newest_only = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)  # does not wait for subscribers
        self._publisher = connection.node.create_publisher(interface(kind), topic, newest_only)
        self._driver: frozenset[bytes] = frozenset()  # its endpoints: one that has been started again has others
        self._published_at = self._looked_at = 0.0  # s
        self.last: Any = None  # message

    def start(self, hold: Callable[[], Any]) -> None:
        """Publishes a message that commands no motion until the session has started. `hold` returns it, with the stamp of the state."""
        connection, state = self._connection, self._state
        if not connection.until(self._publisher.get_subscription_count, connection.timeout):
            raise NoDriver(f"no driver subscribes to {connection.full_name(self._topic)} within {connection.timeout:g} s")
        self._driver = connection.publishers("driver_state")
        time.sleep(PAUSE * self._timeout)
        message = hold()
        state.since = stamp_of(message.header)
        end = time.monotonic() + connection.timeout
        while not state.has_started:
            if state.end is not None:
                raise Rejected(self._name, *state.end)
            if state.is_in_use:
                raise Rejected(self._name, BUSY, f"another program moves the arm with {connection.full_name(self._topic)}")
            if time.monotonic() > end:
                raise Timeout(f"{self._name}: the driver did not report the start of teleoperation within {connection.timeout:g} s: "
                              "see its log")
            self._publish(message)
            until(lambda: state.has_started or state.end, HOLD_PERIOD * self._timeout, 0.001)
        self._is_open = True
        self.publish(message)

    def publish(self, message: Any) -> None:
        """Does not wait. Raises StreamEnded, NoDriver, and RobotError after stop()."""
        with self._lock:
            if not self._is_open:
                self._connection.check_open()
                raise RobotError(f"{self._name}: the stream is closed")
            end = self.end()
            if end is not None:
                raise StreamEnded(self._name, *end)
            if time.monotonic() - self._looked_at > LOOK_PERIOD:
                self._looked_at = time.monotonic()
                if not self._is_served(self._connection):
                    raise NoDriver(loss(self._name))
            self._publish(message)

    def end(self) -> End | None:
        """Returns why the session has ended before stop(), or ends because the next message is late."""
        gap = time.monotonic() - self._published_at
        if self._state.end is None and self._is_open and gap > self._timeout:
            return TIMEOUT, f"no setpoint was sent for {gap:.3g} s, at most {self._timeout:g} s are allowed (stream_timeout)"
        return self._state.end

    def stop(self, brake: Any) -> None:
        """Returns when the driver has reported the end, which it does at standstill. May be called again.

        `brake` is a message that decelerates the arm, or None: it decelerates after `stream_timeout` without messages."""
        with self._lock:
            is_in_time = time.monotonic() - self._published_at < BRAKE_TIME * self._timeout
            if brake is not None and is_in_time and self._is_open and self._state.end is None:
                with contextlib.suppress(RobotError):
                    self._publish(brake)
            self._is_open = False
        if self._state.has_started:
            self._connection.over_open_connection(self._wait_for_end)

    def remove(self) -> None:
        """Removes publisher and subscription."""
        self._state.close()
        with contextlib.suppress(RobotError):
            self._connection.in_executor(lambda: self._connection.node.destroy_publisher(self._publisher))

    def _publish(self, message: Any) -> None:
        self._connection.ask(lambda: self._publisher.publish(message))
        self.last, self._published_at = message, time.monotonic()

    def _stream_timeout(self) -> float:
        kind = interface("rcl_interfaces/srv/GetParameters")
        request = kind.Request(names=["stream_timeout"])
        response = self._connection.request(kind, "command_server/get_parameters", request, self._connection.timeout)
        return float(response.values[0].double_value)

    def _is_served(self, connection: Connection) -> bool:
        return not self._driver.isdisjoint(connection.ask(lambda: connection.publishers("driver_state")))

    def _wait_for_end(self, connection: Connection) -> None:
        is_own = connection is self._connection
        state = self._state if is_own else TeleoperationState(connection, self._topic, self._state.since)
        seen = time.monotonic()
        timeout = seen + CANCEL_TIMEOUT
        while not until(lambda: state.is_at_rest, CHECK_PERIOD):
            now = time.monotonic()
            seen = now if self._is_served(connection) else seen
            if now - seen > LOSS_TIME:
                raise NoDriver(loss(self._name))
            if now > timeout:
                raise Timeout(f"{self._name}: the driver did not report standstill within {CANCEL_TIMEOUT:g} s")
        if state.end is not None and "standstill is not confirmed" in state.end[1]:
            raise StreamEnded(self._name, *state.end)
