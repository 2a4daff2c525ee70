"""Output for the user: steps, progress, failures."""

import shutil
import sys
import time


class Failure(Exception):
    """A step cannot continue. The text says what happened and what to do."""


def line(text: str) -> None:
    print(text, flush=True)


def step(text: str) -> None:
    line(f"==> {text}")


def tail(text: str, count: int = 40) -> str:
    return "\n".join(text.rstrip().splitlines()[-count:])


class Status:
    """A status line: rewritten in place on a terminal, printed every few seconds otherwise."""

    def __init__(self, quiet_interval: float = 20.0):
        self._terminal = sys.stdout.isatty()
        self._interval = quiet_interval
        self._last = time.monotonic()
        self._shown = False

    def show(self, text: str) -> None:
        if self._terminal:
            width = shutil.get_terminal_size().columns - 1
            print("\r\033[K" + text[:width], end="", flush=True)
            self._shown = True
        elif time.monotonic() - self._last >= self._interval:
            line("    " + text[:116])
            self._last = time.monotonic()

    def keep(self, text: str) -> None:
        """Prints a permanent line above the status line."""
        self.clear()
        line(text)
        self._last = time.monotonic()

    def clear(self) -> None:
        if self._shown:
            print("\r\033[K", end="", flush=True)
            self._shown = False
