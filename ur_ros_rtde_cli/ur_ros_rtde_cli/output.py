"""The end of a program, even one whose output cannot be written."""

import contextlib
import errno
import os
import signal
import sys
from typing import Callable

from .errors import CliError, OperationFailed
from .interruptions import Interrupted

# A full disk, a quota, the largest file, a terminal that is gone, and a descriptor that is only read.
UNWRITABLE = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EBADF)


def run(program: Callable[[], int]) -> int:
    """Returns the exit status of a program. Each failure that the user can cause ends with one line."""
    _open_missing_streams()
    try:
        return _flushed(_status(program))
    finally:
        _drop_unwritable()


def _open_missing_streams() -> None:
    """Standard streams that the parent has closed: otherwise a socket of the middleware takes their place."""
    for number, (name, mode) in enumerate((("stdin", "r"), ("stdout", "w"), ("stderr", "w"))):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # the lowest free descriptor: this one
        if getattr(sys, name) is None:
            setattr(sys, name, open(number, mode, closefd=False))


def _status(program: Callable[[], int]) -> int:
    try:
        return program()
    except SystemExit as end:  # of argparse
        if isinstance(end.code, str):
            raise
        return end.code or 0
    except CliError as error:
        print_error(error)
        return error.exit_status
    except Interrupted as interrupted:
        return interrupted.exit_code
    except KeyboardInterrupt:
        return Interrupted(signal.SIGINT).exit_code
    except OSError as error:
        return _status_without_output(error)


def _flushed(status: int) -> int:
    """Returns the status of the program; if that is a success, that of its output."""
    try:
        print(end="", flush=True)
        return status
    except OSError as error:
        return status or _status_without_output(error)


def _status_without_output(error: OSError) -> int:
    if isinstance(error, BrokenPipeError):
        return Interrupted(signal.SIGPIPE).exit_code
    if error.errno not in UNWRITABLE or error.filename is not None:
        raise error
    print_error(OperationFailed(f"the output cannot be written: {error.strerror}"))
    return OperationFailed.exit_status


def print_error(error: Exception) -> None:
    with contextlib.suppress(OSError):
        print(error, file=sys.stderr)


def _drop_unwritable() -> None:
    """Discards output that cannot be written. Python would write it again at exit and report the failure."""
    for stream in filter(None, (sys.stdout, sys.stderr)):
        try:
            stream.flush()
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
