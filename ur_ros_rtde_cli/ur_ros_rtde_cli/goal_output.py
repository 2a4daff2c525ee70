"""Prints what happens to a goal: for people, or as JSON for programs."""

import contextlib
import sys
from typing import Any

from action_msgs.msg import GoalStatus

from . import fields
from .feedback import FeedbackDisplay

STATUS = {GoalStatus.STATUS_SUCCEEDED: "succeeded", GoalStatus.STATUS_CANCELED: "canceled", GoalStatus.STATUS_ABORTED: "aborted"}


class TextOutput:
    """The result as YAML on stdout, the feedback on stderr."""

    def __init__(self, quiet: bool):
        self._display = None if quiet else FeedbackDisplay()

    def feedback(self, message: Any) -> None:
        if self._display is not None:
            self._display(message)

    def clear(self) -> None:
        if self._display is not None:
            self._display.clear()

    def rejected(self, reason: str) -> None:
        """The message of the error is all."""

    def result(self, response: Any) -> None:
        sys.stdout.write(f"{fields.to_yaml(response.result)}\n")  # one write: the reader may close the pipe


class JsonOutput:
    """One JSON object per line on stdout: {"feedback": …} for each message, then {"status": …, "result": …} or {"rejected": …}."""

    def __init__(self, quiet: bool):
        self._quiet = quiet

    @staticmethod
    def _write(values: Any) -> None:
        sys.stdout.write(f"{fields.to_json(values)}\n")
        sys.stdout.flush()

    def feedback(self, message: Any) -> None:
        if not self._quiet:
            # PendingInterruption notices a closed output and cancels the goal. The result reports a full disk, with the arm at rest.
            with contextlib.suppress(OSError):
                self._write({"feedback": message.feedback})

    def clear(self) -> None:
        """Nothing is shown in place."""

    def rejected(self, reason: str) -> None:
        self._write({"rejected": reason})

    def result(self, response: Any) -> None:
        self._write({"status": STATUS[response.status], "result": response.result})
