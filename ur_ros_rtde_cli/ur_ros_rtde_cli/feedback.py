"""Prints the feedback of a goal to stderr: one line in place on a terminal, otherwise one line per second."""

import contextlib
import shutil
import sys
import time
from typing import Any, Optional

from . import fields

LINE_PERIOD = 1.0  # s, without a terminal
REFRESH_PERIOD = 0.1  # s, on a terminal
BAR_WIDTH = 30
START_OF_LINE = "\r\x1b[K"


def write(text: str) -> None:
    """Writes to stderr, and ignores a closed stderr."""
    with contextlib.suppress(OSError):
        sys.stderr.write(text)
        sys.stderr.flush()


def bar(fraction: float) -> str:
    filled = round(BAR_WIDTH * min(max(fraction, 0.0), 1.0))
    return f"[{'#' * filled}{'.' * (BAR_WIDTH - filled)}]"


def _cut(text: str, width: int) -> str:
    """Cuts between two words."""
    return text if len(text) <= width else text[:width + 1].rpartition(" ")[0]


def describe(feedback: Any, elapsed: float) -> str:
    """Returns one line: time, progress, joints, and the fields that not every motion has."""
    motion = getattr(feedback, "motion", None)
    parts = [f"{elapsed:5.1f} s"]
    if motion is not None:
        joints = " ".join(f"{position:6.3f}" for position in motion.state.joint_positions)
        parts += [f"{100 * motion.progress:3.0f} %", f"joints {joints} rad"]
    others = [name for name in feedback.get_fields_and_field_types() if name != "motion"]
    parts += [f"{name}: {fields.to_yaml_line(getattr(feedback, name))}" for name in others]
    return "  ".join(parts)


class FeedbackDisplay:
    def __init__(self) -> None:
        self._terminal = sys.stderr.isatty()
        self._start = time.monotonic()
        self._shown_at: Optional[float] = None

    def __call__(self, message: Any) -> None:
        """Feedback callback of an action client."""
        now = time.monotonic()
        period = REFRESH_PERIOD if self._terminal else LINE_PERIOD
        if self._shown_at is not None and now - self._shown_at < period:
            return
        self._shown_at = now
        text = describe(message.feedback, now - self._start)
        if not self._terminal:
            write(f"{text}\n")
            return
        motion = getattr(message.feedback, "motion", None)
        text = f"{bar(motion.progress)} {text}" if motion is not None else text
        write(START_OF_LINE + _cut(text, shutil.get_terminal_size().columns - 1))

    def clear(self) -> None:
        if self._terminal and self._shown_at is not None:
            write(START_OF_LINE)
