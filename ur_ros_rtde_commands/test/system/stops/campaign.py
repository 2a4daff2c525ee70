"""Executes the cases of consecutive seeds in several lanes, and sums their reports up."""

import contextlib
import json
import os
import pathlib
import queue
import signal
import statistics
import subprocess
import sys
import threading
import time
from collections import defaultdict
from typing import Any, Callable, Dict, List, Optional, Sequence

from .cases import BLOCK
from .goal_kinds import KINDS

SYSTEM = pathlib.Path(__file__).resolve().parents[1]
CASE_LIMIT = 300.0  # s, for the attempts of a case, after which everything starts anew
CLOSE_LIMIT = 30.0  # s
Report = Dict[str, Any]


class LaneProcess:
    """A lane in a process of its own."""

    def __init__(self, address: str, log: pathlib.Path):
        log.mkdir(parents=True, exist_ok=True)
        self.log = log
        self._errors = (log / "lane.log").open("w")
        self._process = subprocess.Popen([sys.executable, "-m", "stops.lane", "--address", address, "--log", str(log)], cwd=SYSTEM,
                                         stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._errors, text=True,
                                         start_new_session=True)  # Ctrl-C lets it end its case
        self._lines: "queue.Queue[Optional[str]]" = queue.Queue()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        assert self._process.stdout
        for line in self._process.stdout:
            self._lines.put(line)
        self._lines.put(None)

    def _answer(self, limit: float) -> Report:
        try:
            line = self._lines.get(timeout=limit)
        except queue.Empty:
            raise AssertionError(f"a lane has not answered for {limit:g} s: {self.log}/lane.log") from None
        assert line is not None, f"a lane has ended: {self.log}/lane.log"
        return json.loads(line)

    def description(self) -> Report:
        return self._answer(60.0)

    def execute(self, seed: int) -> Report:
        assert self._process.stdin
        self._process.stdin.write(f"{seed}\n")
        self._process.stdin.flush()
        return self._answer(CASE_LIMIT)

    def close(self) -> None:
        """Raises AssertionError if it fails or does not end."""
        assert self._process.stdin
        try:
            self._process.stdin.close()
            status = self._process.wait(CLOSE_LIMIT)
        except (OSError, subprocess.TimeoutExpired):
            self._process.kill()
            status = self._process.wait()
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGKILL)  # the driver and the simulator of a lane that has failed
        self._errors.close()
        assert status == 0, f"a lane has ended with the status {status}: {self.log}/lane.log"


class Campaign:
    def __init__(self, seeds: Sequence[int], addresses: Sequence[str], log: pathlib.Path, on_report: Callable[[Report], None],
                 seconds: float = 0.0):
        """`on_report` is called after each case, one at a time. After `seconds`, no case begins; 0: no limit."""
        self._blocks: "queue.Queue[List[int]]" = queue.Queue()
        for block in _blocks(seeds):
            self._blocks.put(block)
        self._addresses, self._log, self._on_report = addresses, log, on_report
        self._lock = threading.Lock()
        self._end = time.monotonic() + seconds if seconds else None
        self.reports: List[Report] = []
        self.descriptions: List[Report] = []
        self.failures: List[str] = []  # of lanes
        self._stopping = threading.Event()

    def run(self) -> None:
        threads = [threading.Thread(target=self._serve, args=(number, address)) for number, address in enumerate(self._addresses)]
        for thread in threads:
            thread.start()
        try:
            for thread in threads:
                thread.join()
        except KeyboardInterrupt:
            self._stopping.set()
            for thread in threads:
                thread.join()
            raise

    def _serve(self, number: int, address: str) -> None:
        try:
            with contextlib.closing(LaneProcess(address, self._log / f"lane_{number}")) as lane:
                self.descriptions.append(lane.description())
                self._execute_blocks(lane)
        except Exception as error:  # the others go on, and the campaign fails
            self.failures.append(f"{type(error).__name__}: {error}")

    def _execute_blocks(self, lane: LaneProcess) -> None:
        while not self._is_over():
            try:
                block = self._blocks.get_nowait()
            except queue.Empty:
                return
            for seed in block:
                if not self._is_over():
                    self._add(lane.execute(seed))

    def _is_over(self) -> bool:
        return self._stopping.is_set() or self._end is not None and time.monotonic() > self._end

    def _add(self, report: Report) -> None:
        with self._lock:
            self.reports.append(report)
            self._on_report(report)

    def failed(self) -> List[Report]:
        return [report for report in self.reports if report["violations"]]


def _blocks(seeds: Sequence[int]) -> List[List[int]]:
    """Seeds with the same profile are executed by one lane."""
    blocks: Dict[int, List[int]] = defaultdict(list)
    for seed in seeds:
        blocks[seed // BLOCK].append(seed)
    return list(blocks.values())


# --- Tables ---


def _values(reports: Sequence[Report], name: str) -> List[float]:
    return [report[name] for report in reports if report[name] is not None]


def _row(name: str, reports: Sequence[Report]) -> str:
    exact = [report for report in reports if not report["held"]]
    latencies, results = _values(exact, "latency"), _values(reports, "result")
    failed = sum(bool(report["violations"]) for report in reports)
    excused = sum(report["attempts"] > 1 for report in reports)
    begin = f"{1e3 * statistics.median(latencies):7.0f} {1e3 * max(latencies):7.0f}" if latencies else f"{'-':>7} {'-':>7}"
    result = f"{1e3 * max(results):8.0f}" if results else f"{'-':>8}"
    standstill = _values(exact, "standstill")
    rest = f"{max(standstill):8.2f}" if standstill else f"{'-':>8}"
    return f"  {name:48} {len(reports):6} {failed:7} {excused:8} {begin} {rest} {result}"


def table(reports: Sequence[Report]) -> List[str]:
    """By event, by goal, and by both. The times to the deceleration and the standstill are those of cases without a hold. An excused
    case was executed again."""
    header = (f"  {'':48} {'cases':>6} {'failed':>7} {'excused':>8} {'begin':>7} {'worst':>7} {'rest':>8} {'result':>8}\n"
              f"  {'':48} {'':>6} {'':>7} {'':>8} {'ms':>7} {'ms':>7} {'s':>8} {'ms':>8}")
    lines = [header]
    for keys in (("event",), ("kind",), ("kind", "event")):
        groups: Dict[str, List[Report]] = defaultdict(list)
        for report in reports:
            groups[", ".join(report[key] for key in keys)].append(report)
        lines.append(f"by {' and '.join(keys)}")
        lines += [_row(name, groups[name]) for name in sorted(groups)]
    lines.append(_row("all", reports))
    return lines


def notes(descriptions: Sequence[Report]) -> List[str]:
    """Returns what the lanes could not do."""
    found = set()
    for description in descriptions:
        if description["holds"] != "possible":
            found.add(f"no thread was held: {description['holds']}")
        missing = {kind.package for kind in KINDS} - {"ur_ros_rtde_commands", *description["packages"]}
        if missing:
            found.add(f"without the goals of {', '.join(sorted(missing))}, which are built with the tests")
    return sorted(found)
