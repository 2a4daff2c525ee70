"""Keeps tests that run at the same time apart, and removes what they leave behind."""

import fcntl
import os
import pathlib
import shutil
import signal
import tempfile
import threading
from typing import Dict, IO, Optional, Set

from .say import Failure

MARK = "UR_TEST_RUN"  # in the environment of every process a test run starts
LAST_DOMAIN = 101  # above it, ports may lie in the range the system gives out itself
_SHARED_MEMORY = pathlib.Path("/dev/shm")
_lock = threading.Lock()


class Domain:
    """A ROS domain, and a loopback address, that no other test on this machine has meanwhile."""

    def __init__(self) -> None:
        self.number = 0
        self._file: Optional[IO[str]] = None

    def __enter__(self) -> "Domain":
        folder = pathlib.Path(tempfile.gettempdir()) / f"ur-domains-{os.getuid()}"
        folder.mkdir(exist_ok=True)
        with _lock:
            for number in range(1, LAST_DOMAIN + 1):
                file = (folder / str(number)).open("w")
                try:
                    fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                except OSError:
                    file.close()
                    continue
                self.number, self._file = number, file
                return self
        raise Failure(f"all {LAST_DOMAIN} ROS domains are in use by other tests")

    def __exit__(self, *_unused: object) -> None:
        if self._file:
            self._file.close()

    def environment(self) -> Dict[str, str]:
        return {"ROS_DOMAIN_ID": str(self.number), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
                "UR_TEST_ADDRESS": f"127.0.1.{self.number}"}


def fresh_folder(folder: pathlib.Path) -> pathlib.Path:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder


def _own_segments() -> Set[pathlib.Path]:
    found = set()
    for pattern in ("fastrtps_*", "sem.fastrtps_*", "fastdds_*", "sem.fastdds_*"):
        for path in _SHARED_MEMORY.glob(pattern):
            try:
                if path.stat().st_uid == os.getuid():
                    found.add(path)
            except OSError:
                pass
    return found


def _segments_in_use() -> Set[str]:
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
    """Lock files are open without being mapped."""
    used: Set[str] = set()
    for link in pathlib.Path("/proc").glob("[0-9]*/fd/*"):
        try:
            target = os.readlink(link)
        except OSError:
            continue
        if target.startswith("/dev/shm/"):
            used.add(target.split(" (deleted)")[0])
    return used


def _end_strays() -> None:
    """Processes of this run that left their session."""
    mark = f"{MARK}={os.getpid()}".encode()
    for environ in pathlib.Path("/proc").glob("[0-9]*/environ"):
        try:
            ours = mark in environ.read_bytes().split(b"\0")
        except OSError:
            continue
        if ours:
            try:
                os.kill(int(environ.parent.name), signal.SIGKILL)
            except ProcessLookupError:
                pass


class CleanUp:
    """Ends the processes of a run that are left at its end, and removes the shared memory no process uses any more."""

    def __enter__(self) -> "CleanUp":
        self._before = _own_segments()
        return self

    def __exit__(self, *_unused: object) -> None:
        _end_strays()
        new = _own_segments() - self._before
        used = _segments_in_use()
        for path in new:
            if str(path) not in used:
                try:
                    path.unlink()
                except OSError:
                    pass
