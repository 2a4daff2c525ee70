"""Log of a run in chronological order, with the time since the start, and its first violation."""

import threading
import time


class Violation(Exception):
    """An invariant is violated."""


class Journal:
    def __init__(self, file):
        self._begin = time.monotonic()
        self._file = file.open("w")
        self._lock = threading.Lock()
        self.violation = None

    def write(self, who, text):
        with self._lock:
            if not self._file.closed:
                self._file.write(f"{time.monotonic() - self._begin:10.3f}  {who:10} {text}\n")
                self._file.flush()

    def violate(self, who, text):
        """Records a violation. The first one is the result of the run; the later ones are only logged."""
        self.write(who, f"VIOLATION: {text}")
        with self._lock:
            self.violation = self.violation or f"{who}: {text}"

    def check(self):
        if self.violation:
            raise Violation(self.violation)

    def close(self):
        with self._lock:
            self._file.close()
