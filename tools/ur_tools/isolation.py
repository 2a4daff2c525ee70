"""Isolates tests that run in parallel, and removes the processes and shared memory that they leave behind."""

import os
import pathlib
import shutil
import signal
from typing import Set

from .layout import load

MARK = "UR_TEST_RUN"  # environment variable of every process that a test run starts
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


def _kill_stray_processes() -> None:
    """Kills processes of this run that have left their session."""
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
    """At its end, kills the remaining processes of a run and removes shared memory that is no longer used."""

    def __enter__(self) -> "CleanUp":
        self._before = _shared_memory_of_user()
        return self

    def __exit__(self, *_unused: object) -> None:
        _kill_stray_processes()
        new = _shared_memory_of_user() - self._before
        used = _shared_memory_in_use()
        for path in new:
            if str(path) not in used:
                try:
                    path.unlink()
                except OSError:
                    pass
