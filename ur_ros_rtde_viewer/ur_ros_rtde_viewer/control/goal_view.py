"""Shows one goal in the page of one browser tab: phase, progress, feedback and result, and a button that cancels it."""

import time
from typing import Any, Callable, Optional

from ur_ros_rtde_cli import fields

from .goals import Goals, Phase, SentGoal

REFRESH_PERIOD = 0.1  # s
OUTCOME = ("success", "error_code", "message")  # fields of a result that the phase and the message state already
DIGITS = 4  # of shown numbers
WIDTH = 40  # characters


class GoalView:
    """Sends a goal and shows it in `container`. `stop_count`: that of `goals` when the user asked for the goal. `on_end` is called in the
    thread of the control node."""

    def __init__(self, gui: Any, container: Any, goals: Goals, name: str, action: Any, goal: Any, stop_count: int,
                 on_end: Optional[Callable[[SentGoal], None]] = None):
        self._goals, self._on_end = goals, on_end
        self._shown_at = 0.0
        self._closed = False
        with container:
            self._text = gui.add_markdown(f"**{escaped(name)}**")
            self._progress = gui.add_progress_bar(0.0, visible=False)
            self._cancel = gui.add_button("Cancel", color="orange")
        self._cancel.on_click(lambda _event: self.cancel())
        self._goal = goals.send(name, action, goal, self._on_change, stop_count)

    @property
    def has_ended(self) -> bool:
        return self._goal.has_ended

    def cancel(self) -> None:
        self._goals.cancel(self._goal)

    def remove(self) -> None:
        for handle in (self._text, self._progress, self._cancel):
            handle.remove()

    def close(self) -> None:
        """Cancels the goal: the tab that sent it is gone."""
        self._closed = True
        self.cancel()

    def _on_change(self, goal: SentGoal) -> None:
        """Changes the elements last: this fails if the tab was just closed."""
        if goal.has_ended and self._on_end is not None:
            self._on_end(goal)
        now = time.monotonic()
        if not self._closed and (goal.phase != Phase.RUNNING or now - self._shown_at >= REFRESH_PERIOD):
            self._shown_at = now
            self._cancel.visible = not goal.has_ended
            self._progress.visible = goal.progress is not None and not goal.has_ended
            self._progress.value = 100.0 * (goal.progress or 0.0)
            self._text.content = _text(goal)


def escaped(text: str) -> str:
    """Returns text in which Markdown has no meaning."""
    return "".join(f"\\{character}" if character in "\\`*_{}[]<>#|" else character for character in text)


def _text(goal: SentGoal) -> str:
    parts = [f"**{escaped(goal.action)}: {goal.phase.value}**"]
    if goal.message:
        parts.append(escaped(goal.message))
    details = goal.result if goal.phase == Phase.SUCCEEDED else None if goal.has_ended else goal.feedback
    shown = {} if details is None else {name: value for name, value in fields.to_plain(details).items() if name not in OUTCOME}
    if shown:
        parts.append(f"```yaml\n{fields.plain_to_yaml(shown, WIDTH, DIGITS)}\n```")
    return "\n\n".join(parts)
