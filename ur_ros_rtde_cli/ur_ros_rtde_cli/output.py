"""Standard output and standard error that cannot be written."""

import contextlib
import errno
import os
import sys
from typing import Iterator

from .errors import OperationFailed

# A full disk, a quota, the largest file, and a terminal that is gone.
UNWRITABLE = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)


@contextlib.contextmanager
def written() -> Iterator[None]:
    """Raises OperationFailed if the output of the block cannot be written, and BrokenPipeError if nobody reads it."""
    try:
        try:
            yield
        except SystemExit:  # of argparse, after --help and --version
            print(end="", flush=True)
            raise
        print(end="", flush=True)
    except OSError as error:
        if error.errno not in UNWRITABLE or error.filename is not None:
            raise
        raise OperationFailed(f"the output cannot be written: {error.strerror}") from None


def print_error(error: Exception) -> None:
    with contextlib.suppress(OSError):
        print(error, file=sys.stderr)


def drop_unwritable() -> None:
    """Discards output that cannot be written. Python would write it again at exit and report the failure."""
    for stream in filter(None, (sys.stdout, sys.stderr)):
        try:
            stream.flush()
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
