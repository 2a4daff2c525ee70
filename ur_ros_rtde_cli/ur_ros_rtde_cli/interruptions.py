"""Handles signals and closed outputs as requests to end the program."""

import select
import signal
import sys
import time
from typing import Any, Dict, Optional

# `timeout` signals both the process and its process group. Signals within this time count as one.
SECOND_SIGNAL_AFTER = 1.0  # s


class Interrupted(Exception):
    """Raised after a signal that ends the program. SIGPIPE stands for a closed output."""

    def __init__(self, number: int):
        super().__init__(signal.Signals(number).name)
        self.number = number

    @property
    def exit_code(self) -> int:
        return 128 + self.number


class PendingInterruption:
    """Stores a signal or a closed output until take() is called. An exception within a callback would break rclpy."""

    def __init__(self) -> None:
        self._pending: Optional[int] = None
        self._last: Optional[float] = None
        self._previous: Dict[int, Any] = {}
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            if number != signal.SIGHUP or signal.getsignal(number) != signal.SIG_IGN:  # nohup ignores SIGHUP
                self._previous[number] = signal.signal(number, lambda number, _: self._add(number))
        self._outputs = select.poll()
        for stream in filter(None, (sys.stdout, sys.stderr)):
            self._outputs.register(stream.fileno(), 0)  # POLLERR and POLLHUP are always reported

    def _add(self, number: int) -> None:
        now = time.monotonic()
        if self._last is None or now - self._last >= SECOND_SIGNAL_AFTER:
            self._last, self._pending = now, number

    def restore_handlers(self) -> None:
        for number, handler in self._previous.items():
            signal.signal(number, handler)

    @property
    def is_pending(self) -> bool:
        """Whether there was a signal since the last take()."""
        return self._pending is not None

    def take(self) -> Optional[Interrupted]:
        """Returns the stored interruption and clears it."""
        # A closed output stays closed, so it is reported only once, and only if there was no signal before.
        if self._last is None and any(event & (select.POLLERR | select.POLLHUP) for _, event in self._outputs.poll(0)):
            self._add(signal.SIGPIPE)
        number, self._pending = self._pending, None
        return None if number is None else Interrupted(number)
