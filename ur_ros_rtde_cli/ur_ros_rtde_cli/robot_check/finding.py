"""What a check has found."""

import enum
from dataclasses import dataclass


class State(enum.Enum):
    OK = "OK"
    WARNING = "warning"  # the driver works, but not in every situation
    FAULT = "fault"  # the driver cannot work


@dataclass(frozen=True)
class Finding:
    subject: str
    state: State
    text: str  # what was found, with the cause if it is known
    remedy: str = ""

    def line(self) -> str:
        return f"{self.state.value:8} {self.subject:16} {self.text}" + (f": {self.remedy}" if self.remedy else "")


def ok(subject: str, text: str) -> Finding:
    return Finding(subject, State.OK, text)


def warning(subject: str, text: str, remedy: str) -> Finding:
    return Finding(subject, State.WARNING, text, remedy)


def fault(subject: str, text: str, remedy: str) -> Finding:
    return Finding(subject, State.FAULT, text, remedy)
