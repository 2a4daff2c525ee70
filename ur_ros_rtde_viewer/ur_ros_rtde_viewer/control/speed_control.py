"""Sets the speed slider of the robot from the page."""

import math
import time
from typing import Callable, Optional

from ur_ros_rtde_msgs.action import SetSpeedSlider

from ..panels.speed_slider import SpeedSlider
from ..state.robot_state import RobotState
from .goal_view import escaped
from .goals import Goals, Phase, SentGoal

SEND_PERIOD = 0.25  # s, the shortest time between two goals while the slider is dragged
HOLD_TIME = 1.0  # s after a change, in which the value of the page stays
ANSWER_TIMEOUT = 5.0  # s; a driver that has ended answers no goal


class SpeedControl:
    """Sends one goal at a time, because a goal fails if the robot reports the value of the next one. The last value is always sent."""

    def __init__(self, slider: SpeedSlider, goals: Goals, clock: Callable[[], float] = time.monotonic):
        self._slider, self._goals, self._clock = slider, goals, clock
        self._wanted: Optional[int] = None  # percent, not yet sent
        self._goal: Optional[SentGoal] = None
        self._changed = self._sent = -math.inf
        slider.enable(self._change)

    def _change(self, percent: int) -> None:
        self._slider.hold()
        self._wanted, self._changed = percent, self._clock()

    def update(self, _state: RobotState) -> None:
        now = self._clock()
        if self._goal is not None and (self._goal.has_ended or now - self._sent > ANSWER_TIMEOUT):
            self._finish(self._goal)
        if self._goal is not None:
            return
        if self._wanted is None:
            if self._slider.is_held and now - self._changed >= HOLD_TIME:
                self._slider.release()
        elif now - self._sent >= SEND_PERIOD:
            self._send(self._wanted, now)

    def _send(self, percent: int, now: float) -> None:
        self._wanted, self._sent = None, now
        self._goal = self._goals.send("set_speed_slider", SetSpeedSlider, SetSpeedSlider.Goal(fraction=percent / 100), lambda _goal: None)

    def _finish(self, goal: SentGoal) -> None:
        self._goal = None
        is_set = goal.phase == Phase.SUCCEEDED
        reason = escaped(goal.message) if goal.has_ended else f"the driver did not answer within {ANSWER_TIMEOUT:g} s"
        self._slider.message.content = "" if is_set else f"Not set: {reason}"
        if not is_set and self._wanted is None:
            self._slider.show_reported()

    def close(self) -> None:
        pass
