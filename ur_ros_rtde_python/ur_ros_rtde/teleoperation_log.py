"""What the driver reports about teleoperation. Its log is the only interface that does."""

import re
from typing import Any

from .connection import Connection

TIMEOUT, SHUTDOWN = 6, 16  # of ur_ros_rtde_msgs/msg/ErrorCode

_STARTED = "teleoperation started"
_ENDED = re.compile(r"teleoperation ended: (?P<why>.*); (?:no message led to a command|\d+ messages, .*)", re.S)
_IGNORED = re.compile(r"messages are ignored: (?P<why>.*) \(\w+ (?P<code>\d+)\); teleoperation can start", re.S)

Stamp = tuple[int, int]
End = tuple[int, str]  # code and reason


def stamp_of(header: Any) -> Stamp:
    return header.stamp.sec, header.stamp.nanosec


class TeleoperationLog:
    """The messages of the driver on /rosout about one of its topics. `since` is a time of the driver, as in its stamps.

    Late subscribers receive old messages: those up to `since` only tell whether another program uses the topic.
    """

    def __init__(self, connection: Connection, topic: str, since: Stamp | None = None):
        self.since = since  # None: all messages are old
        self.is_in_use = False  # since before `since`
        self.has_started = False  # after `since`
        self.end: End | None = None  # after `since`: when the arm is at rest, or when the start was rejected
        self._connection = connection
        self._prefix = f"{connection.full_name(topic)}: "
        self._subscription = connection.subscribe("rcl_interfaces/msg/Log", "/rosout", self._read, latched=True)

    def close(self) -> None:
        self._connection.unsubscribe(self._subscription)

    def _read(self, message: Any) -> None:
        if not message.msg.startswith(self._prefix):
            return
        text = message.msg[len(self._prefix):]
        is_new = self.since is not None and stamp_of(message) > self.since
        if text == _STARTED:
            self.is_in_use = not is_new
            self.has_started = self.has_started or is_new
        elif ended := _ENDED.match(text):
            self.is_in_use = False
            if is_new and self.has_started:
                self.end = self.end or (SHUTDOWN if "shut down" in ended["why"] else TIMEOUT, ended["why"])
        elif ignored := _IGNORED.match(text):
            self.is_in_use = False
            if is_new:
                self.end = self.end or (int(ignored["code"]), ignored["why"])
