"""Shows the state of robot and driver, the speed slider, the active goal, the arm, inputs and outputs in numbers, and rejections."""

import html
import math
import time
from typing import Any, Callable, List, Sequence, Tuple

from ..state.robot_state import RobotState
from .speed_slider import SpeedSlider

ARM_PERIOD = 0.2  # s; each browser receives every change
TOOL_PIN = 16  # the first one of the tool
JOINTS = ("Shoulder pan", "Shoulder lift", "Elbow", "Wrist 1", "Wrist 2", "Wrist 3")


def state_rows(state: RobotState) -> List[Tuple[str, str]]:
    """Returns titles and texts."""
    rows = [("Robot mode", state.robot_mode or "unknown"), ("Safety mode", state.safety_mode or "unknown")]
    if state.program_running is not None:
        rows.append(("Program", "running" if state.program_running else "stopped"))
    if state.speed_scaling is not None:
        rows.append(("Speed scaling", f"{100 * state.speed_scaling:.0f} %"))
    if state.driver is not None:
        rows.append(("Driver", state.driver.name))
        if state.driver.message:
            rows.append(("Cause and remedy", state.driver.message))
    if state.active_modes:
        rows.append(("Active modes", ", ".join(state.active_modes)))
    if state.goal is not None:
        rows.append(("Goal", f"{state.goal.action}, {state.goal.elapsed:.1f} s"))
    return rows


def roll_pitch_yaw(wxyz: Sequence[float]) -> Tuple[float, float, float]:
    """Returns the angles about the fixed axes x, y, z (REP 103) in rad."""
    w, x, y, z = wxyz
    return (math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
            math.asin(max(-1.0, min(1.0, 2.0 * (w * y - z * x)))),
            math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)))


def arm_rows(state: RobotState) -> List[Tuple[str, str]]:
    """Returns titles and texts of joints, TCP and force."""
    rows = []
    if state.joints is not None:
        rows += [(joint, f"{position:8.4f} rad  {math.degrees(position):7.1f}°") for joint, position in zip(JOINTS, state.joints.positions)]
    if state.tcp_pose is not None:
        x, y, z = state.tcp_pose.position
        rows.append(("TCP in base", f"{x:8.4f} {y:8.4f} {z:8.4f} m"))
        rows.append(("Roll, pitch, yaw", " ".join(f"{math.degrees(angle):7.1f}" for angle in roll_pitch_yaw(state.tcp_pose.wxyz)) + " °"))
    if state.wrench is not None:
        rows.append(("Force, TCP frame", " ".join(f"{value:7.1f}" for value in state.wrench[:3]) + " N"))
        rows.append(("Torque, TCP frame", " ".join(f"{value:7.2f}" for value in state.wrench[3:]) + " N m"))
    return rows


def _pins(on: Sequence[bool]) -> str:
    """Returns the digital signals that are on."""
    return ", ".join(f"tool {pin - TOOL_PIN}" if pin >= TOOL_PIN else str(pin) for pin, is_on in enumerate(on) if is_on) or "all off"


def signal_rows(state: RobotState) -> List[Tuple[str, str]]:
    """Returns titles and texts of inputs and outputs."""
    signals = state.signals
    if signals is None:
        return []
    return [("Digital inputs on", _pins(signals.digital_inputs)), ("Digital outputs on", _pins(signals.digital_outputs)),
            ("Analog inputs, A or V", " ".join(f"{value:8.4f}" for value in signals.analog_inputs)),
            ("Analog outputs, A or V", " ".join(f"{value:8.4f}" for value in signals.analog_outputs))]


TITLE = "padding:2px 12px 2px 0;opacity:.7;vertical-align:top;white-space:nowrap"
TEXT = "white-space:pre-wrap;font-variant-numeric:tabular-nums"


def _as_html(rows: List[Tuple[str, str]]) -> str:
    cells = "".join(f"<tr><td style='{TITLE}'>{html.escape(title)}</td><td style='{TEXT}'>{html.escape(text)}</td></tr>"
                    for title, text in rows)
    return f"<table style='font-size:13px;margin:8px 14px'>{cells}</table>"


class StatePanel:
    """`post` calls a function in the thread of the viewer's loop."""

    def __init__(self, tab: Any, gui: Any, post: Callable[..., None]):
        with tab:
            self._table = gui.add_html("")
            self.speed_slider = SpeedSlider(gui, post)
            self._progress = gui.add_progress_bar(0.0, visible=False)
            self._arm = gui.add_html("")
            self._rejections = gui.add_html("")
        self._shown: Tuple[Any, ...] = ()
        self._arm_shown = -math.inf  # time.monotonic()

    def update(self, state: RobotState) -> None:
        shown = (_as_html(state_rows(state)), _as_html([
            (time.strftime("%H:%M:%S", time.localtime(rejection.stamp)), f"{rejection.action} rejected: {rejection.message}")
            for rejection in reversed(state.rejections)]))
        if shown != self._shown:
            self._table.content, self._rejections.content = shown
            self._shown = shown
        if time.monotonic() - self._arm_shown > ARM_PERIOD:
            self._arm_shown = time.monotonic()
            self._arm.content = _as_html(arm_rows(state) + signal_rows(state))
        self.speed_slider.update(state)
        self._progress.visible = state.goal is not None and state.goal.progress > 0.0
        if state.goal is not None:
            self._progress.value = round(100.0 * state.goal.progress)

    def close(self) -> None:
        pass
