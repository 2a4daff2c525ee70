"""Measures how long the packages take to build, and estimates the remaining time of a build."""

import json
import math
import pathlib
import time
from typing import Callable, Dict, Iterable, List, Optional, Tuple

REFERENCE_CORES = 2
# Seconds of a first build without and with tests, on REFERENCE_CORES and without a compiler cache. Source: "first" in
# .ur/<distribution>/build_times.json after a first `./ur build --tests` (753 s), and for builds without tests the share that the
# other steps have in the package's .ninja_log.
REFERENCE: Dict[str, Tuple[float, float]] = {
    "control_msgs": (12.0, 12.0),
    "tf2_msgs": (7.0, 7.0),
    "ur_rtde_vendor": (11.0, 11.0),
    "rcl_cxx": (11.0, 51.0),
    "ur_ros_rtde_msgs": (107.0, 107.0),
    "ur_simulator": (111.0, 236.0),
    "ur_ros_rtde_trajectory": (24.0, 37.0),
    "ur_ros_rtde_robot": (25.0, 89.0),
    "ur_ros_rtde": (32.0, 61.0),
    "ur_ros_rtde_commands": (42.0, 45.0),
    "ur_ros_rtde_cli": (2.0, 2.0),
    "ur_ros_rtde_description": (1.0, 10.0),
    "ur_ros_rtde_gripper_commands": (38.0, 39.0),
    "ur_ros_rtde_python": (1.0, 1.0),
    "ur_ros_rtde_tutorials": (28.0, 28.0),
    "ur_ros_rtde_viewer": (1.0, 1.0),
}
SERIAL = 12.0  # s of the build of a package that take as long on more cores: its configuration, and one step after the other
SLOW_HOST = 1.9  # of the times of REFERENCE, on the slowest of three hosts with two cores: 24 min with all tests
UNKNOWN_PACKAGE = (30.0, 30.0)
STEPS_PER_SECOND = 1.3  # until ninja reports the number of steps of a package
PRIOR = 60.0  # s of build time after which measured speed and estimate have equal weight


def rounded(seconds: float) -> str:
    """Returns a duration rounded to 5 s or 1 min, as text."""
    if seconds <= 55.0:
        return f"{max(5, 5 * math.ceil(seconds / 5))} s"
    return f"{round(seconds / 60.0)} min"


def span(least: float, most: float) -> str:
    """Returns two durations as text, or one if they are rounded to the same."""
    begin, end = rounded(least), rounded(most)
    return begin if begin == end else f"{begin} to {end}"


class BuildTimes:
    """Measured times of this checkout: of each package the last build, and the last build from scratch ("first")."""

    def __init__(self, file: pathlib.Path, jobs: int):
        self._file, self._jobs = file, jobs
        try:
            self._times = json.loads(file.read_text())
        except (OSError, ValueError):
            self._times = {}

    def _entry(self, kind: str, name: str, tests: bool) -> Optional[dict]:
        entry = self._times.get(f"{name} with tests" if tests else name, {}).get(kind)
        return entry if entry and entry["jobs"] == self._jobs else None

    def first(self, name: str, tests: bool) -> Tuple[float, int]:
        """Returns seconds and steps of a first build; 0 steps: unknown."""
        entry = self._entry("first", name, tests)
        if entry:
            return entry["seconds"], entry["steps"]
        reference, share = REFERENCE.get(name, UNKNOWN_PACKAGE)[tests], REFERENCE_CORES / self._jobs
        serial = min(reference, SERIAL)
        return serial * max(1.0, share) + (reference - serial) * share, 0

    def last(self, name: str, tests: bool) -> Optional[Tuple[float, int]]:
        entry = self._entry("last", name, tests)
        return (entry["seconds"], entry["steps"]) if entry else None

    def record(self, name: str, tests: bool, seconds: float, steps: int, is_first: bool) -> None:
        kinds = self._times.setdefault(f"{name} with tests" if tests else name, {})
        entry = {"seconds": round(seconds, 1), "steps": steps, "jobs": self._jobs}
        kinds["last"] = entry
        if is_first:
            kinds["first"] = entry

    def write(self) -> None:
        self._file.write_text(json.dumps(self._times, indent=1, sort_keys=True))


class _Work:
    """The work on one package. `seconds` is its share of the total build time."""

    def __init__(self, times: BuildTimes, name: str, tests: bool, is_first: bool):
        self.is_first = is_first
        self._first_seconds, self._first_steps = times.first(name, tests)
        last = None if is_first else times.last(name, tests)
        self._seconds, self._expected_steps = last or (self._first_seconds, self._first_steps)
        self.step = 0
        self.steps: Optional[int] = None  # as reported by ninja
        self.finished = False
        self.spent = 0.0

    @property
    def expected_steps(self) -> int:
        if self.steps is not None:
            return self.steps
        return self._expected_steps or max(1, round(self._seconds * STEPS_PER_SECOND))

    @property
    def seconds(self) -> float:
        if self.steps and self._first_steps:
            return self._first_seconds * min(1.0, self.steps / self._first_steps)
        return self._seconds

    @property
    def remaining(self) -> float:
        return 0.0 if self.finished else self.seconds * (1.0 - self.step / max(1, self.expected_steps))


class Forecast:
    """Estimates files and remaining time of a build over all its packages."""

    def __init__(self, times: BuildTimes, firsts: Dict[str, bool], tests: bool,
                 clock: Callable[[], float] = time.monotonic):
        self._times, self._tests, self._clock = times, tests, clock
        self._work = {name: _Work(times, name, tests, is_first) for name, is_first in firsts.items()}
        self._updated = clock()
        self._elapsed = 0.0

    def update(self, running: Iterable[str]) -> None:
        """Divides the time since the last update equally among the packages that are being built."""
        now = self._clock()
        names = [name for name in running if name in self._work]
        for name in names:
            self._work[name].spent += (now - self._updated) / len(names)
        self._elapsed += now - self._updated
        self._updated = now

    def step(self, name: str, step: int, steps: int) -> None:
        work = self._work[name]
        work.step, work.steps = step, steps

    def finish(self, name: str) -> None:
        work = self._work[name]
        work.finished, work.steps = True, work.steps or 0
        work.step = work.steps
        self._times.record(name, self._tests, work.spent, work.steps, work.is_first)

    def files(self) -> Tuple[int, int, bool]:
        """Returns the number of files done, the total, and whether the total is exact."""
        works = self._work.values()
        return (sum(work.step for work in works), sum(work.expected_steps for work in works),
                all(work.steps is not None for work in works))

    def remaining(self) -> float:
        works: List[_Work] = list(self._work.values())
        remaining = sum(work.remaining for work in works)
        done = sum(work.seconds for work in works) - remaining
        return remaining * (self._elapsed + PRIOR) / (done + PRIOR)

    def text(self) -> str:
        done, total, known = self.files()
        return f"{done} of {'' if known else 'about '}{total} files, about {rounded(self.remaining())} left"
