"""Isolates tests that run in parallel, and removes the processes and shared memory that they leave behind."""

import contextlib
import os
import pathlib
import re
import shutil
import signal
import time
from typing import Callable, Iterator, List, Set, Tuple

from .layout import load
from .lock import MARK

_MARK = re.compile(rb"(?:^|\0)" + MARK.encode() + rb"=(\d+:\d+)\0")
KILL_LIMIT = 5.0  # s, after which killed processes are no longer waited for
POLL_INTERVAL, LONGEST_POLL_INTERVAL = 0.02, 0.3  # s; looking takes some milliseconds
ros_domain = load("rcl_cxx/test/support/ros_domain.py")
Domain = ros_domain.Domain
_SHARED_MEMORY = pathlib.Path("/dev/shm")


def fresh_folder(folder: pathlib.Path) -> pathlib.Path:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder


def _shared_memory_of_user() -> Set[pathlib.Path]:
    found = set()
    for pattern in ("fastrtps_*", "sem.fastrtps_*", "fastdds_*", "sem.fastdds_*"):
        for path in _SHARED_MEMORY.glob(pattern):
            try:
                if path.stat().st_uid == os.getuid():
                    found.add(path)
            except OSError:
                pass
    return found


def _shared_memory_in_use() -> Set[str]:
    used: Set[str] = set()
    for maps in pathlib.Path("/proc").glob("[0-9]*/maps"):
        try:
            text = maps.read_text(errors="replace")
        except OSError:
            continue
        for line in text.splitlines():
            at = line.find("/dev/shm/")
            if at >= 0:
                used.add(line[at:].split(" (deleted)")[0])
    return used | _files_open()


def _files_open() -> Set[str]:
    """Returns the open files of /dev/shm: lock files are not mapped."""
    used: Set[str] = set()
    for link in pathlib.Path("/proc").glob("[0-9]*/fd/*"):
        try:
            target = os.readlink(link)
        except OSError:
            continue
        if target.startswith("/dev/shm/"):
            used.add(target.split(" (deleted)")[0])
    return used


def _marked() -> Iterator[Tuple[int, str]]:
    """Yields the process ids and marks of the processes of test runs: not those in another container, whose marks have other ids."""
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            found = _MARK.search((process / "environ").read_bytes())
            if found and os.readlink(process / "ns" / "pid") == os.readlink("/proc/self/ns/pid"):
                yield int(process.name), found[1].decode()
        except OSError:
            continue


def _command(pid: int) -> str:
    try:
        return pathlib.Path(f"/proc/{pid}/cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace").strip()
    except OSError:
        return ""


def left_behind(mark: str, limit: float) -> List[str]:
    """Returns the commands of the processes with this mark that do not end within `limit` s."""
    deadline, interval = time.monotonic() + limit, POLL_INTERVAL
    while True:
        left = [pid for pid, found in _marked() if found == mark]
        if not left or time.monotonic() > deadline:
            return [_command(pid) for pid in left]
        time.sleep(interval)
        interval = min(2.0 * interval, LONGEST_POLL_INTERVAL)


def kill(is_stray: Callable[[str], bool]) -> None:
    """Kills the processes with such marks, also those that have left their session. Returns when they have ended."""
    deadline = time.monotonic() + KILL_LIMIT
    while time.monotonic() < deadline:
        strays = [pid for pid, mark in _marked() if is_stray(mark)]
        if not strays:
            return
        for pid in strays:
            with contextlib.suppress(OSError):
                os.kill(pid, signal.SIGKILL)
        time.sleep(POLL_INTERVAL)


def _run_of(mark: str) -> str:
    """Returns the process id of the test run."""
    return mark.partition(":")[0]


class CleanUp:
    """Kills the processes that an earlier run has left when it was killed. At its end, kills those of this run, and removes shared memory
    that is no longer used."""

    def __enter__(self) -> "CleanUp":
        kill(lambda mark: not pathlib.Path("/proc", _run_of(mark)).exists())
        self._before = _shared_memory_of_user()
        return self

    def __exit__(self, *_unused: object) -> None:
        kill(lambda mark: _run_of(mark) == str(os.getpid()))
        new = _shared_memory_of_user() - self._before
        used = _shared_memory_in_use()
        for path in new:
            if str(path) not in used:
                try:
                    path.unlink()
                except OSError:
                    pass
