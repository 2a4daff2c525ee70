"""The position of the speed slider in percent, as the robot reports it. control.SpeedControl lets the page change it."""

import math
import time
from typing import Any, Callable, Optional

from ..state.robot_state import RobotState

SETTLING_TIME = 0.5  # s
LEAST = 1  # percent, that set_speed_slider takes; the pendant can be at 0


class SpeedSlider:
    """A reported value is shown when it has settled: the speed scaling is lower while a program starts and while the controller limits
    a motion. Callbacks of the page are called in other threads; `post` calls a function in that of the viewer's loop.
    """

    def __init__(self, gui: Any, post: Callable[..., None], clock: Callable[[], float] = time.monotonic):
        self._clock = clock
        self._element = gui.add_slider("Speed slider [%]", 0, 100, 1, 100, disabled=True, visible=False)
        self.message = gui.add_markdown("")
        self._element.on_update(lambda event: post(self._changed) if event.client_id is not None else None)
        self._on_change: Optional[Callable[[int], None]] = None
        self._seen: Optional[int] = None  # percent
        self._seen_since = -math.inf
        self._reported: Optional[int] = None  # percent
        self.is_held = False  # the value of the page is shown, not the reported one
        self._has_changed = False  # the reported value, during the hold

    def enable(self, on_change: Callable[[int], None]) -> None:
        """Lets the page change the value. `on_change` is called with each new value in percent."""
        self._element.disabled, self._on_change = False, on_change

    def _changed(self) -> None:
        """The number beside a slider can be edited while the slider is disabled, and be outside its range."""
        if self._on_change is None:
            self.show_reported()
            return
        percent = round(min(max(self._element.value, LEAST), 100))
        if percent != self._element.value:
            self._element.value = percent
        self._on_change(percent)

    def update(self, state: RobotState) -> None:
        scaling = state.speed_scaling if state.program_running else None  # it is 0 while no program runs
        seen = None if scaling is None else round(100.0 * scaling)
        now = self._clock()
        if seen != self._seen:
            self._seen, self._seen_since = seen, now
        if seen is not None and seen != self._reported and now - self._seen_since >= SETTLING_TIME:
            self._reported, self._has_changed = seen, True
            if not self.is_held:
                self.show_reported()

    def hold(self) -> None:
        self.is_held, self._has_changed = True, False

    def release(self) -> None:
        """Shows what the robot has reported during the hold. Some controllers report no change."""
        self.is_held = False
        if self._has_changed:
            self.show_reported()

    def show_reported(self) -> None:
        if self._reported is not None:
            self._element.value, self._element.visible = self._reported, True
