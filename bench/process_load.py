"""Processor time and memory of processes."""

import threading
import time
from pathlib import Path

PERIOD = 0.5  # s between two points of a trace


def cpu_seconds(pid):
    """Returns the time of a process's clock, to nanoseconds: that of clock_getcpuclockid(3)."""
    return time.clock_gettime((~pid << 3) | 2)


def _parent(pid):
    return int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])


def tree(pid):
    """Returns a process and all its descendants."""
    children: dict[int, list[int]] = {}
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            children.setdefault(_parent(entry.name), []).append(int(entry.name))
        except (FileNotFoundError, ProcessLookupError):  # it has ended
            continue
    found = [pid]
    for parent in found:
        found += children.get(parent, [])
    return found


def _megabytes(pid, file, field):
    text = Path(f"/proc/{pid}/{file}").read_text()
    return next(int(line.split()[1]) for line in text.splitlines() if line.startswith(field)) / 1024.0


def resident_megabytes(pid):
    return _megabytes(pid, "status", "VmRSS:")


def proportional_megabytes(pid):
    """Returns the memory with shared pages divided among the processes that use them."""
    return _megabytes(pid, "smaps_rollup", "Pss:")


def cpu_percent(pids, seconds):
    """Returns the load of each process in % of one core."""
    before, begin = {name: cpu_seconds(pid) for name, pid in pids.items()}, time.monotonic()
    time.sleep(seconds)
    elapsed = time.monotonic() - begin
    return {name: 100.0 * (cpu_seconds(pid) - before[name]) / elapsed for name, pid in pids.items()}


class LoadTrace:
    """Records the load in % of one core and the resident memory in MB of processes: {name: [(s, %, MB), ...]}."""

    def __init__(self, pids):
        self._pids = pids
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._record)
        self.points: dict[str, list[tuple[float, float, float]]] = {name: [] for name in pids}

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._stop.set()
        self._thread.join()

    def _record(self):
        begin = last = time.monotonic()
        before = {name: cpu_seconds(pid) for name, pid in self._pids.items()}
        while not self._stop.wait(PERIOD):
            now = time.monotonic()
            for name, pid in self._pids.items():
                used = cpu_seconds(pid)
                load = 100.0 * (used - before[name]) / (now - last)
                self.points[name].append((round(now - begin, 2), round(load, 1), round(resident_megabytes(pid), 1)))
                before[name] = used
            last = now
