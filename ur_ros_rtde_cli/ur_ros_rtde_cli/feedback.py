"""Prints the feedback of a goal to stderr: in place on a terminal, otherwise one line per second."""

import contextlib
import shutil
import sys
import time
from typing import Any, List, Optional

from . import fields

LINE_PERIOD = 1.0  # s, without a terminal
REFRESH_PERIOD = 0.1  # s, on a terminal
BAR_WIDTH = 30


def write(text: str) -> None:
    """Writes to stderr, and ignores a closed stderr."""
    with contextlib.suppress(OSError):
        sys.stderr.write(text)
        sys.stderr.flush()


class FeedbackDisplay:
    def __init__(self, quiet: bool):
        self._quiet = quiet
        self._terminal = sys.stderr.isatty()
        self._start = time.monotonic()
        self._shown_at: Optional[float] = None
        self._shown_lines = 0

    def __call__(self, message: Any) -> None:
        """Feedback callback of an action client."""
        now = time.monotonic()
        period = REFRESH_PERIOD if self._terminal else LINE_PERIOD
        if self._quiet or (self._shown_at is not None and now - self._shown_at < period):
            return
        self._shown_at = now
        if self._terminal:
            self._rewrite(self._screen(message.feedback, now - self._start))
        else:
            write(f"{now - self._start:.1f} s  {fields.to_yaml_line(message.feedback)}\n")

    def clear(self) -> None:
        self._rewrite([])

    def _rewrite(self, lines: List[str]) -> None:
        start_of_block = f"\x1b[{self._shown_lines}A\r\x1b[J" if self._shown_lines else ""
        if lines or start_of_block:
            write(start_of_block + "".join(f"{line}\n" for line in lines))
        self._shown_lines = len(lines)

    @staticmethod
    def _screen(feedback: Any, elapsed: float) -> List[str]:
        """Returns the lines of the feedback, cut to the size of the terminal."""
        size = shutil.get_terminal_size()
        header = f"{elapsed:6.1f} s"
        progress = getattr(getattr(feedback, "motion", None), "progress", None)
        if progress is not None:
            filled = round(BAR_WIDTH * min(max(progress, 0.0), 1.0))
            header = f"[{'#' * filled}{'.' * (BAR_WIDTH - filled)}] {100 * progress:3.0f} % {header}"
        lines = [header]
        if feedback.get_fields_and_field_types():
            lines += fields.to_yaml(feedback, width=size.columns).splitlines()
        return [line[:size.columns - 1] for line in lines[:max(size.lines - 1, 1)]]
