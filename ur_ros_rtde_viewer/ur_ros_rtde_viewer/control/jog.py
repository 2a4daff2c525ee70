"""Moves the TCP while a button is held, over the driver's topic `twist`.

The browser sends a message HOLD_RATE times per second while a button is held, and each message becomes one message on `twist`. The
driver stops the arm if none arrives for its parameter `stream_timeout`: when the button is released, the tab is closed, the
connection is lost, or this process ends.
"""

import threading
import time
from dataclasses import dataclass
from enum import Enum
from typing import Callable, Dict, Hashable, NamedTuple, Optional

from geometry_msgs.msg import TwistStamped
from rclpy.qos import QoSProfile, ReliabilityPolicy

from .control_node import ControlNode
from .goals import Goals

HOLD_RATE = 20.0  # Hz; viser's browser sends no more messages of a panel
STREAM_TIMEOUT = 0.1  # s without a message, after which the driver ends the motion: the default of its parameter
FIRST_GAP = 0.25  # s, the longest one before the motion begins
# Messages that were delayed on their way arrive together. They are not signs of a held button.
SHORTEST_GAP = 0.25 / HOLD_RATE  # s
MAX_LINEAR, MAX_ANGULAR = 0.25, 1.0  # m/s, rad/s
AXES = ("X", "Y", "Z", "RX", "RY", "RZ")
STOPPED = "stopped: release the button, then hold it again"
TWO_BUTTONS = "stopped: hold one button at a time; release both"
RELEASE_TIME = 2.0  # s without messages, after which a button does not count as a second one: its release was lost


class Frame(Enum):
    BASE = "base"
    TOOL = "tool0_controller"


@dataclass(frozen=True)
class JogSpeed:
    linear: float = 0.05  # m/s
    angular: float = 0.2  # rad/s


class Meaning(Enum):
    """Of a message of a held button."""

    NOTHING = "nothing"
    START = "start"  # a zero twist: after a pause during a motion, the driver waits for one
    MOVE = "move"
    END = "end"  # the messages have paused: in the meantime, something else may have stopped the arm


class Hold:
    """Decides what the messages of a held button mean. The arm moves from the second one on, also in a slow browser."""

    def __init__(self, clock: Callable[[], float] = time.monotonic):
        self._clock = clock
        self._last = -float("inf")
        self._moves = False
        self.stream_timeout = STREAM_TIMEOUT  # of the driver

    @property
    def is_active(self) -> bool:
        return self._clock() - self._last < self._longest_gap

    @property
    def _longest_gap(self) -> float:
        return self.stream_timeout if self._moves else max(FIRST_GAP, self.stream_timeout)

    def begin(self) -> Meaning:
        self._last, self._moves = self._clock(), False
        return Meaning.START

    def end(self) -> None:
        self._last = -float("inf")

    def take(self) -> Meaning:
        """Returns the meaning of a message after the first one."""
        now = self._clock()
        gap, self._last = now - self._last, now
        if gap < SHORTEST_GAP:
            return Meaning.NOTHING
        if gap >= self._longest_gap:
            return Meaning.END
        self._moves = True
        return Meaning.MOVE


class _Button(NamedTuple):
    tab: Hashable
    axis: int
    sign: float


class Jog:
    """Only one tab moves the arm at a time, with one button. Methods can be called in any thread.

    A hold begins with the first message of a button since it was released. STOP, another button of the tab (a second finger) and a pause
    of the messages end it until the button is released or the tab is closed: during the pause, something else may have stopped the arm. A
    pause is not a release: a tab in the background and a bad network cause pauses, too. The lock is held while a twist is published, so
    that none follows a STOP.
    """

    def __init__(self, control: ControlNode, goals: Goals, clock: Callable[[], float] = time.monotonic):
        self._node = control.node
        qos = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._publisher = control.node.create_publisher(TwistStamped, goals.full_name("twist"), qos)
        self._lock = threading.Lock()
        self._clock = clock
        self._hold = Hold(clock)
        self._owner: Optional[_Button] = None  # of the hold
        self._held: Dict[_Button, float] = {}  # not released yet, with the time of the last message

    def set_stream_timeout(self, seconds: float) -> None:
        with self._lock:
            self._hold.stream_timeout = seconds

    def hold(self, tab: Hashable, axis: int, sign: float, frame: Frame, speed: JogSpeed) -> Optional[str]:
        """Handles a message of a held button of `tab`. Returns why the arm does not move, or None."""
        button = _Button(tab, axis, sign)
        with self._lock:
            is_first = button not in self._held
            self._held[button] = now = self._clock()
            if self._publisher.get_subscription_count() == 0:
                self._end_hold()
                return "no server of twist: does the driver run with this ROS_DOMAIN_ID?"
            if any(other.tab == tab and other != button and now - last < RELEASE_TIME for other, last in self._held.items()):
                self._end_hold_of(tab)
                return TWO_BUTTONS
            if self._owner != button and self._hold.is_active:
                return "the arm is being moved from another tab"
            if is_first:
                self._owner, meaning = button, self._hold.begin()
            else:
                meaning = self._hold.take() if self._owner == button else Meaning.END
            if meaning is Meaning.END:
                self._end_hold()
                return STOPPED
            if meaning is Meaning.START:
                self._publish(frame, axis, 0.0)
            elif meaning is Meaning.MOVE:
                self._publish(frame, axis, sign * (speed.linear if axis < 3 else speed.angular))
        return None

    def release(self, tab: Hashable, axis: int, sign: float) -> None:
        """Ends the hold of the button."""
        with self._lock:
            self._held.pop(_Button(tab, axis, sign), None)
            self._end_hold_of(tab)

    def close(self, tab: Hashable) -> None:
        """Ends the holds of a tab."""
        with self._lock:
            self._held = {button: last for button, last in self._held.items() if button.tab != tab}
            self._end_hold_of(tab)

    def stop(self) -> None:
        """Ignores each button that is held until it is released."""
        with self._lock:
            self._end_hold()

    def _end_hold_of(self, tab: Hashable) -> None:
        """Stops the arm at once: the driver would notice the end of a hold only after `stream_timeout`."""
        if self._owner is None or self._owner.tab != tab:
            return
        if self._hold.is_active:
            self._publish(Frame.BASE, 0, 0.0)
        self._end_hold()

    def _end_hold(self) -> None:
        self._hold.end()
        self._owner = None

    def _publish(self, frame: Frame, axis: int, value: float) -> None:
        message = TwistStamped()
        message.header.stamp = self._node.get_clock().now().to_msg()
        message.header.frame_id = frame.value
        vector = message.twist.linear if axis < 3 else message.twist.angular
        setattr(vector, "xyz"[axis % 3], value)
        self._publisher.publish(message)
