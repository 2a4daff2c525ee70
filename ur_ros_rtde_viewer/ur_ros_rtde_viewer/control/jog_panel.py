"""The buttons that move the TCP while they are held, in the page of one browser tab."""

from typing import Any, Hashable

from ..page import style
from ..page.scripts import script
from ..page.sliders import within_limits
from .jog import AXES, HOLD_RATE, MAX_ANGULAR, MAX_LINEAR, Frame, JogSpeed
from .robot_control import RobotControl

COLORS = ("pink", "green", "blue")  # of x, y and z, as in the scene; STOP is red
FRAMES = {"base": Frame.BASE, "tool": Frame.TOOL}
# The release of a button is its click. A touch that is long, or that the browser cancels, ends without one.
CLICK_AFTER_TOUCH = script("clickAfterTouch", f"""
document.addEventListener('lostpointercapture', event => event.target.closest?.('{style.JOG_BUTTONS}')?.click());
""")


class JogPanel:
    def __init__(self, gui: Any, container: Any, robot: RobotControl, tab: Hashable):
        self._gui, self._jog, self._tab = gui, robot.jog, tab
        default = JogSpeed()
        with container:
            gui.add_markdown("Hold a button to move the TCP. Releasing it stops the arm.")
            self._frame = gui.add_dropdown("Axes of", tuple(FRAMES))
            self._linear = gui.add_slider("Speed [m/s]", 0.01, MAX_LINEAR, 0.01, default.linear)
            self._angular = gui.add_slider("Rotation [rad/s]", 0.05, MAX_ANGULAR, 0.05, default.angular)
            gui.add_html(style.TWO_COLUMNS + CLICK_AFTER_TOUCH)
            for axis in range(len(AXES)):
                for sign in (1.0, -1.0):
                    self._add_button(axis, sign)
            self._text = gui.add_markdown("")  # below the buttons: above them, it would move another one under the pointer

    def _add_button(self, axis: int, sign: float) -> None:
        button = self._gui.add_button(f"{AXES[axis]} {'+' if sign > 0 else '−'}", color=COLORS[axis % 3])

        async def hold(_event: Any) -> None:  # coroutines are called in the order of the messages
            reason = self._jog.hold(self._tab, axis, sign, FRAMES[self._frame.value],
                                    JogSpeed(within_limits(self._linear), within_limits(self._angular)))
            text = reason or ""
            if self._text.content != text:
                self._text.content = text

        async def release(_event: Any) -> None:
            self._jog.release(self._tab, axis, sign)
            self._text.content = ""

        button.on_hold(hold, callback_hz=HOLD_RATE)
        button.on_click(release)

    def close(self) -> None:
        self._jog.close(self._tab)
