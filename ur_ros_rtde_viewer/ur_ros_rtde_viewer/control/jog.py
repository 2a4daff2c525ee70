"""Moves the TCP while a button is held, over the driver's topic `twist`.

The browser sends a message HOLD_RATE times per second while a button is held, and each message becomes one message on `twist`. The
driver stops the arm if none arrives for its parameter `stream_timeout` (0.1 s): when the button is released, the tab is closed, the
connection is lost, or this process ends.
"""

import threading
import time
from dataclasses import dataclass
from enum import Enum
from typing import Callable, Hashable, Optional

from geometry_msgs.msg import TwistStamped
from rclpy.qos import QoSProfile, ReliabilityPolicy

from .control_node import ControlNode
from .goals import Goals

HOLD_RATE = 30.0  # Hz
LONGEST_GAP = 0.25  # s without a message, after which a hold has ended
# Messages that were delayed on their way arrive together. They are not signs of a held button.
SHORTEST_GAP = 0.25 / HOLD_RATE  # s
MAX_LINEAR, MAX_ANGULAR = 0.25, 1.0  # m/s, rad/s
AXES = ("X", "Y", "Z", "RX", "RY", "RZ")


class Frame(Enum):
    BASE = "base"
    TOOL = "tool0_controller"


@dataclass(frozen=True)
class JogSpeed:
    linear: float = 0.05  # m/s
    angular: float = 0.2  # rad/s


class Hold:
    """Decides which messages of a held button move the arm: those that follow another one after about one period."""

    def __init__(self, clock: Callable[[], float] = time.monotonic):
        self._clock = clock
        self._last = -float("inf")

    @property
    def is_active(self) -> bool:
        return self._clock() - self._last < LONGEST_GAP

    def end(self) -> None:
        self._last = -float("inf")

    def take(self) -> bool:
        now = self._clock()
        gap, self._last = now - self._last, now
        return SHORTEST_GAP <= gap < LONGEST_GAP


class Jog:
    """Only one tab moves the arm at a time. Methods can be called in any thread."""

    def __init__(self, control: ControlNode, goals: Goals):
        self._node = control.node
        qos = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._publisher = control.node.create_publisher(TwistStamped, goals.full_name("twist"), qos)
        self._lock = threading.Lock()
        self._hold = Hold()
        self._owner: Optional[Hashable] = None
        self._stopped = False

    def hold(self, tab: Hashable, axis: int, sign: float, frame: Frame, speed: JogSpeed) -> Optional[str]:
        """Handles a message of a held button of `tab`. Returns why the arm does not move, or None."""
        with self._lock:
            if self._hold.is_active and self._owner != tab:
                return "the arm is being moved from another tab"
            if not self._hold.is_active:
                self._stopped = False
            self._owner = tab
            moves = self._hold.take() and not self._stopped
        if self._stopped:
            return "stopped: release the button, then hold it again"
        if self._publisher.get_subscription_count() == 0:
            return "no server of twist: does the driver run with this ROS_DOMAIN_ID?"
        if moves:
            self._publish(frame, axis, sign * (speed.linear if axis < 3 else speed.angular))
        return None

    def release(self, tab: Hashable) -> None:
        """Ends the hold of `tab` at once: the driver would notice it only after `stream_timeout`."""
        with self._lock:
            if self._owner != tab or not self._hold.is_active:
                return
            self._hold.end()
            self._owner = None
        self._publish(Frame.BASE, 0, 0.0)

    def stop(self) -> None:
        """Ignores the button that is held until it is released."""
        with self._lock:
            self._stopped = self._hold.is_active

    def _publish(self, frame: Frame, axis: int, value: float) -> None:
        message = TwistStamped()
        message.header.stamp = self._node.get_clock().now().to_msg()
        message.header.frame_id = frame.value
        vector = message.twist.linear if axis < 3 else message.twist.angular
        setattr(vector, "xyz"[axis % 3], value)
        self._publisher.publish(message)
