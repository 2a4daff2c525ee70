"""For how long the host did not let the threads of programs run, although they were ready to: the scheduler's own measurement."""

import os
import threading
import time
from typing import Dict, List, Sequence, Tuple

PERIOD = 0.02  # s, between two samples
HAND_OVERS = 2  # threads of a program, one after the other, between a request and what it does


class _Program:
    """The delays of the threads of a process."""

    def __init__(self, process: int):
        self._folder = f"/proc/{process}/task"
        self._files: Dict[str, int] = {}  # descriptors, by thread
        self._begin: Dict[str, int] = {}  # ns, by thread
        self._delays: Dict[str, int] = {}  # ns since then, by thread
        self.sample()
        self._begin, self._delays = dict(self._delays), {}

    def sample(self) -> int:
        """Returns the sum of the delays of the most delayed threads, as if one had waited for the other, in ns."""
        try:
            threads = os.listdir(self._folder)
        except OSError:
            threads = []  # the process has ended
        for thread in threads:
            try:
                if thread not in self._files:
                    self._files[thread] = os.open(f"{self._folder}/{thread}/schedstat", os.O_RDONLY)
                delay = int(os.pread(self._files[thread], 64, 0).split()[1])
            except OSError:
                continue  # the thread has ended
            self._delays[thread] = delay - self._begin.get(thread, 0)
        return sum(sorted(self._delays.values())[-HAND_OVERS:])

    def close(self) -> None:
        for file in self._files.values():
            os.close(file)


class Stalls:
    """Measures from its construction to close()."""

    def __init__(self, processes: Sequence[int]):
        self._programs = [_Program(process) for process in processes]
        self._samples: List[Tuple[int, int]] = []  # time, ns since the epoch; delay until then, ns
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._measure, daemon=True)
        self._thread.start()

    def _measure(self) -> None:
        while not self._ended.wait(PERIOD):
            self._sample()

    def _sample(self) -> None:
        delay = sum(program.sample() for program in self._programs)
        self._samples.append((time.time_ns(), delay))

    def between(self, begin: int, end: int) -> float:
        """Returns the delay in this time, ns since the epoch, or from up to PERIOD before until PERIOD after it, in s."""
        before = next((delay for at, delay in reversed(self._samples) if at <= begin), 0)
        return 1e-9 * (next((delay for at, delay in self._samples if at >= end), self._samples[-1][1] if self._samples else 0) - before)

    def close(self) -> None:
        """May be called again."""
        if self._ended.is_set():
            return
        self._ended.set()
        self._thread.join()
        self._sample()
        for program in self._programs:
            program.close()
