"""Decides which tests run at the same time: as many as their measured load allows, the longest first."""

import json
import pathlib
import time
from dataclasses import dataclass
from typing import Any, Callable, Dict, Iterable, List, Optional

from .reference_times import REFERENCE

JOBS_PER_CORE, MOST_JOBS = 4, 16  # tests at a time at most, however little processor time they need
BUSY = 0.7  # share of the cores that the tests may use together: a late thread looks like a lost link
LEAST_LOAD = 0.05  # cores


@dataclass(frozen=True)
class Cost:
    """What a test takes: its duration in s, and its load: processor time per duration, in cores."""

    seconds: float
    load: float


# Without a measurement. A pytest file starts programs, a GoogleTest case is short.
UNKNOWN_PYTEST = Cost(10.0, 0.5)
UNKNOWN_PROGRAM = Cost(0.1, 0.5)


class Times:
    """The costs of tests as measured in this checkout, or else as listed in reference_times.py."""

    def __init__(self, file: pathlib.Path):
        self._file = file
        self._costs = {name: Cost(*values) for name, values in {**REFERENCE, **self._read()}.items()}

    def _read(self) -> Dict[str, List[float]]:
        try:
            found = json.loads(self._file.read_text())
        except (OSError, ValueError):
            return {}
        return {name: values for name, values in found.items() if isinstance(values, list)}

    def cost(self, name: str, is_pytest: bool) -> Cost:
        return self._costs.get(name, UNKNOWN_PYTEST if is_pytest else UNKNOWN_PROGRAM)

    def record(self, name: str, seconds: float, processor_seconds: float) -> None:
        self._costs[name] = Cost(round(seconds, 2), round(processor_seconds / max(seconds, 0.01), 2))

    def write(self) -> None:
        self._file.write_text(json.dumps({name: [cost.seconds, cost.load] for name, cost in self._costs.items()}, indent=0,
                                         sort_keys=True))


@dataclass
class Job:
    """A test that waits or runs. `what` is the caller's."""

    what: Any
    cost: Cost
    exclusive: bool = False  # runs alone
    background: bool = False  # has low priority: uses the processor time that the other jobs leave
    last: bool = False  # a background job that does nothing but compute: it starts when no other job waits
    expected_end: float = 0.0


class Schedule:
    """Starts the longest waiting test as soon as its load fits beside the running tests.

    While that test does not fit, shorter ones are started as long as they do not delay it (EASY backfilling). Background tests run in
    addition, as many as there are cores. The last tests are background tests that start when no other waits.
    """

    def __init__(self, jobs: Iterable[Job], cores: int, most: int = 0, clock: Callable[[], float] = time.monotonic):
        """`most`: how many tests may run at a time; 0: as many as the machine can take."""
        self._limit = BUSY * cores
        self.most = most or min(MOST_JOBS, JOBS_PER_CORE * cores)
        self._background_most = min(self.most, cores)
        self._clock = clock
        jobs = list(jobs)
        self._waiting = sorted((job for job in jobs if not job.background), key=lambda job: -job.cost.seconds)
        self._background = sorted((job for job in jobs if job.background), key=lambda job: (job.last, -job.cost.seconds))
        self._running: List[Job] = []
        self._running_background: List[Job] = []

    def __bool__(self) -> bool:
        return bool(self._waiting or self._background or self._running or self._running_background)

    def take(self) -> Optional[Job]:
        """Returns a test to start now, or None: wait until a running test has ended."""
        if len(self._running) + len(self._running_background) >= self.most:
            return None
        now = self._clock()
        chosen = self._choose(now)
        if chosen is not None:
            self._waiting.remove(chosen)
            chosen.expected_end = now + chosen.cost.seconds
            self._running.append(chosen)
        elif self._takes_background():
            chosen = self._background.pop(0)
            self._running_background.append(chosen)
        return chosen

    def end(self, job: Job) -> None:
        (self._running_background if job.background else self._running).remove(job)

    def _takes_background(self) -> bool:
        """Background tests start when no exclusive test runs or is the next one, the last tests when no other waits."""
        if not self._background or len(self._running_background) >= self._background_most:
            return False
        if self._background[0].last and self._waiting:
            return False
        return not any(job.exclusive for job in [*self._running, *self._waiting[:1]])

    def _choose(self, now: float) -> Optional[Job]:
        if not self._waiting:
            return None
        first = self._waiting[0]
        if first.exclusive and self._running_background:
            return None
        if self._fits(first, self._running):
            return first
        start = self._earliest_start(first)
        still_running = [job for job in self._running if job.expected_end > start]
        for job in self._waiting[1:]:
            in_time = now + job.cost.seconds <= start or self._fits(first, [*still_running, job])
            if in_time and self._fits(job, self._running):
                return job
        return None

    def _load(self, job: Job) -> float:
        return self._limit if job.exclusive else max(LEAST_LOAD, job.cost.load)

    def _fits(self, job: Job, others: List[Job]) -> bool:
        return not others or sum(map(self._load, others)) + self._load(job) <= self._limit + 1e-9

    def _earliest_start(self, job: Job) -> float:
        """Returns when the running tests are expected to leave room for the job. One that is late remains for as long as it is late."""
        now = self._clock()
        ends = {id(other): max(other.expected_end, 2.0 * now - other.expected_end) for other in self._running}
        running = sorted(self._running, key=lambda other: ends[id(other)])
        while not self._fits(job, running):
            start = ends[id(running.pop(0))]
        return start
