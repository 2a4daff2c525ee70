"""Measures for how long the host stalled: did not run a process that is ready to run every PERIOD. What follows for a failed test."""

import json
import os
import select
import signal
import subprocess
import sys
import threading
import time
from typing import List, Tuple

PERIOD = 0.005  # s
SANITIZER_STATUS = 66  # of a program after the report of a sanitizer
# Statuses of a program that has crashed, as Popen.returncode: no stall is the reason.
CRASHED = (SANITIZER_STATUS, -signal.SIGABRT, -signal.SIGBUS, -signal.SIGFPE, -signal.SIGILL, -signal.SIGSEGV, -signal.SIGTRAP)
REPEATS = 3  # of a test that failed while the host stalled, at most
LEAST_STALL = 0.03  # s; with shorter ones, the driver and the tests must work


def failure(stall: float, name: str) -> str:
    """Returns the line about a test that failed during a stall of this duration, s."""
    return f"failed while the host stalled for {1e3 * stall:.0f} ms: {name}"


class StallWatch:
    """Measures from its construction to close(), in a process of its own: a busy interpreter is not a stalled host."""

    def __init__(self) -> None:
        self._process = subprocess.Popen([sys.executable, "-ES", __file__], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self._lock = threading.Lock()
        self._ask()  # it has begun

    def _ask(self) -> List[Tuple[float, float]]:
        assert self._process.stdin and self._process.stdout
        with self._lock:
            self._process.stdin.write(b"?")
            self._process.stdin.flush()
            return json.loads(self._process.stdout.readline())

    def longest_since(self, begin: float) -> float:
        """Returns the longest stall since a time of time.monotonic(), s; 0 if there was none of LEAST_STALL."""
        return max((end - start for start, end in self._ask() if end > begin), default=0.0)

    def close(self) -> None:
        self._process.communicate()


def _watch() -> None:
    """Answers each byte of the standard input with the stalls until then, and exits at its end."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # of Ctrl-C in a terminal
    stalls: List[Tuple[float, float]] = []
    last = time.monotonic()
    while True:
        asked = select.select([sys.stdin], [], [], PERIOD)[0]
        now = time.monotonic()
        if now - last > LEAST_STALL:
            stalls.append((last, now))
        last = now
        if asked:
            if not os.read(sys.stdin.fileno(), 1):
                return
            print(json.dumps(stalls), flush=True)


if __name__ == "__main__":
    _watch()
