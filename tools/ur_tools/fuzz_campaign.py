"""Runs fuzz targets, several at a time, with their progress and a table of the results."""

import pathlib
import re
import subprocess
import time
from dataclasses import dataclass
from typing import Dict, List, Optional, Sequence

from . import console

POLL_SECONDS = 0.5
# libFuzzer reports "#1024  pulse  cov: 100 ft: 200 corp: 3/40b lim: 4 exec/s: 512 rss: 40Mb".
_STATUS = re.compile(rb"^#(\d+)\s.*?cov: (\d+) ", re.MULTILINE)
_EXECUTED = re.compile(rb"^stat::number_of_executed_units:\s*(\d+)", re.MULTILINE)
_TAIL_BYTES = 64 * 1024  # of a log that may grow for hours


@dataclass(frozen=True)
class Target:
    name: str
    command: Sequence[str]
    log: pathlib.Path


@dataclass(frozen=True)
class Progress:
    executions: int = 0
    edges: int = 0


@dataclass(frozen=True)
class Result:
    name: str
    progress: Progress
    seconds: float
    failed: bool

    @property
    def rate(self) -> float:
        """Executions per second."""
        return self.progress.executions / max(self.seconds, 1e-3)


def read_progress(log: bytes) -> Progress:
    """Returns the last state that libFuzzer reported."""
    status = _STATUS.findall(log)
    executed = _EXECUTED.findall(log)
    executions = executed or [number for number, _ in status]
    return Progress(int(executions[-1]) if executions else 0, int(status[-1][1]) if status else 0)


class Run:
    """A target that runs, with its output in a file."""

    def __init__(self, target: Target, env: Dict[str, str]):
        self._target = target
        self._begin = time.monotonic()
        with target.log.open("wb") as log:
            self._process = subprocess.Popen(target.command, env=env, stdout=log, stderr=subprocess.STDOUT)

    def progress(self) -> Progress:
        with self._target.log.open("rb") as log:
            log.seek(max(0, self._target.log.stat().st_size - _TAIL_BYTES))
            return read_progress(log.read())

    def status(self, executions: int) -> str:
        """Returns one line; `executions` is their limit, or -1."""
        done = self.progress().executions
        rate = done / max(time.monotonic() - self._begin, 1e-3)
        limit = f" of {executions:,}" if executions > 0 else ""
        left = f", {(executions - done) / rate / 60:.0f} min left" if executions > 0 and rate > 0 else ""
        return f"{self._target.name} {done:,}{limit} ({rate:,.0f}/s{left})"

    def result(self) -> Optional[Result]:
        """Returns the result, or None while the target runs."""
        status = self._process.poll()
        if status is None:
            return None
        return Result(self._target.name, self.progress(), time.monotonic() - self._begin, status != 0)

    def stop(self) -> None:
        self._process.terminate()
        self._process.wait()


def run(targets: Sequence[Target], env: Dict[str, str], executions: int, jobs: int) -> List[Result]:
    """Runs all targets, `jobs` at a time. An interrupt stops them."""
    waiting = list(targets)
    running: List[Run] = []
    results: List[Result] = []
    line = console.Status()
    try:
        while waiting or running:
            while waiting and len(running) < jobs:
                running.append(Run(waiting.pop(0), env))
            time.sleep(POLL_SECONDS)
            for job in list(running):
                result = job.result()
                if result is not None:
                    running.remove(job)
                    results.append(result)
                    line.keep(row(result))
            line.show("; ".join(job.status(executions) for job in running) + f"; {len(waiting)} waiting")
    finally:
        for job in running:
            job.stop()
        line.clear()
    return sorted(results, key=lambda result: result.name)


def row(result: Result) -> str:
    found = "FAILED" if result.failed else "no finding"
    return (f"{result.name:22} {result.progress.executions:>12,} {result.progress.edges:>7,} "
            f"{result.rate:>9,.0f}/s {result.seconds:>7,.0f} s  {found}")


def table(results: Sequence[Result]) -> str:
    header = f"{'target':22} {'executions':>12} {'edges':>7} {'rate':>11} {'time':>9}"
    return "\n".join([header, *map(row, results)])
