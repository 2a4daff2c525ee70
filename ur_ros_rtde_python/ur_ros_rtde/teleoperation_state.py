"""What the driver tells about teleoperation by one of its topics."""

from typing import Any

from .connection import Connection

IDLE, ACTIVE = 0, 1  # of ur_ros_rtde_msgs/msg/TeleoperationState

Stamp = tuple[int, int]
End = tuple[int, str]  # code and reason


def stamp_of(header: Any) -> Stamp:
    return header.stamp.sec, header.stamp.nanosec


class TeleoperationState:
    """The state of a topic since a time of the driver, as in its stamps.

    Late subscribers receive old states: those up to `since` only tell whether another program uses the topic.
    """

    def __init__(self, connection: Connection, topic: str, since: Stamp | None = None):
        self.since = since  # None: all states are old
        self.is_in_use = False  # since before `since`
        self.has_started = False
        self.end: End | None = None  # why the arm decelerates, or why teleoperation has not started
        self.is_at_rest = False  # after `end`
        self._connection, self._topic = connection, connection.full_name(topic)
        self._subscription = connection.subscribe("ur_ros_rtde_msgs/msg/TeleoperationState", "teleoperation", self._read, latched=True)

    def close(self) -> None:
        self._connection.unsubscribe(self._subscription)

    def _read(self, message: Any) -> None:
        if message.topic != self._topic:
            return
        is_new = self.since is not None and stamp_of(message) > self.since
        self.is_in_use = not is_new and message.state != IDLE
        if not is_new:
            return
        if message.state == ACTIVE:
            self.has_started = True
        else:
            self.end, self.is_at_rest = (message.error_code, message.message), message.state == IDLE
