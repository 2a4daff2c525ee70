"""Locks: one ./ur at a time builds or tests in a checkout; others wait."""

import errno
import fcntl
import os
import pathlib
import sys
from typing import IO, Dict, Optional, Set

from . import console
from .layout import STATE

MARK = "UR_TEST_RUN"  # environment variable of every process of a test: process id of the run, colon, number of the test
_NOT_WRITABLE = (errno.EACCES, errno.EPERM, errno.EROFS)
_held: Dict[pathlib.Path, IO[str]] = {}


def _command() -> str:
    return " ".join(["./ur", *sys.argv[1:]])


def _fail_inside(holder: str) -> None:
    """Raises Failure if this process belongs to a test of the holder: each would wait for the other."""
    run = os.environ.get(MARK, "").partition(":")[0]
    if run and f"(process {run})" in holder:
        raise console.Failure(f"A test of {holder} runs `{_command()}`, which would change the build that is being tested. Was a source "
                              "edited after the tests started?")


def descriptors() -> Set[int]:
    """Returns the descriptors of the locks of this process. A program that inherits them keeps the locks until it ends too."""
    return {file.fileno() for file in _held.values()}


class Lock:
    """An exclusive lock on a file that names its holder. The kernel releases it when the process ends. A process that holds it can enter
    further blocks with it."""

    def __init__(self, name: str, folder: pathlib.Path = STATE):
        self._path = folder / f"{name}.lock"
        self._file: Optional[IO[str]] = None  # of the outermost block

    def __enter__(self) -> "Lock":
        if self._path not in _held:
            self._acquire()
        return self

    def __exit__(self, *_unused: object) -> None:
        if self._file:
            del _held[self._path]
            self._file.close()
            self._file = None

    def _acquire(self) -> None:
        while self._file is None:
            file = self._open()
            try:
                self._lock(file)
                if self._is_current(file):
                    file.truncate(0)
                    file.write(f"`{_command()}` (process {os.getpid()})")
                    file.flush()
                    self._file = _held[self._path] = file
            finally:
                if self._file is None:
                    file.close()

    def _open(self) -> IO[str]:
        try:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            return self._path.open("a+")
        except OSError as error:
            if error.errno in _NOT_WRITABLE:
                raise console.Failure(f"{self._path.parent} cannot be written: {error.strerror}.\n"
                                      "./ur writes all its files there. Use a writable checkout.") from None
            raise

    def _lock(self, file: IO[str]) -> None:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            file.seek(0)
            holder = file.read() or "another ./ur"
            _fail_inside(holder)
            console.step(f"Waiting for {holder}, which is running in this checkout")
            fcntl.flock(file, fcntl.LOCK_EX)

    def _is_current(self, file: IO[str]) -> bool:
        """Returns False if `./ur clean --all` has removed the file in the meantime."""
        try:
            return os.path.samestat(os.fstat(file.fileno()), os.stat(self._path))
        except FileNotFoundError:
            return False
