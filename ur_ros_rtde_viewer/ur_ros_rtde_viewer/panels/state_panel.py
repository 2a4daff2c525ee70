"""Shows the state of robot and driver, the active goal, and rejections."""

import html
import time
from typing import Any, List, Tuple

from ..state.robot_state import RobotState


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
    if state.goal is not None:
        rows.append(("Goal", f"{state.goal.action}, {state.goal.elapsed:.1f} s"))
    return rows


def _as_html(rows: List[Tuple[str, str]]) -> str:
    cells = "".join(f"<tr><td style='padding:2px 12px 2px 0;opacity:.7;vertical-align:top'>{html.escape(title)}</td>"
                    f"<td>{html.escape(text)}</td></tr>" for title, text in rows)
    return f"<table style='font-size:13px;margin:8px 14px'>{cells}</table>"


class StatePanel:
    def __init__(self, tab: Any, gui: Any):
        with tab:
            self._table = gui.add_html("")
            self._progress = gui.add_progress_bar(0.0, visible=False)
            self._rejections = gui.add_html("")
        self._shown: Tuple[Any, ...] = ()

    def update(self, state: RobotState) -> None:
        shown = (_as_html(state_rows(state)), _as_html([
            (time.strftime("%H:%M:%S", time.localtime(rejection.stamp)), f"{rejection.action} rejected: {rejection.message}")
            for rejection in reversed(state.rejections)]))
        if shown != self._shown:
            self._table.content, self._rejections.content = shown
            self._shown = shown
        self._progress.visible = state.goal is not None and state.goal.progress > 0.0
        if state.goal is not None:
            self._progress.value = round(100.0 * state.goal.progress)

    def close(self) -> None:
        pass
