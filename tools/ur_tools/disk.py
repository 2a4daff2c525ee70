"""Free space on the disk."""

import pathlib
import shutil

from . import console

# Bytes.
ENVIRONMENT = 0.9e9  # the virtual environment and pip's cache
BUILD = 1.3e9  # all packages with their tests, and their installation
LATER = 0.3e9  # a later build


def free(path: pathlib.Path) -> int:
    """Returns the free bytes of the file system that holds the path. The path need not exist."""
    while not path.exists():
        path = path.parent
    return shutil.disk_usage(path).free


def full_message(path: pathlib.Path) -> str:
    return (f"The disk that holds {path} is full ({free(path) / 1e9:.1f} GB free). Free some space and run ./ur again: "
            "it continues where it stopped.")


def check(path: pathlib.Path, needed: float) -> None:
    available = free(path)
    if available < needed:
        raise console.Failure(f"Not enough space on the disk that holds {path}: {available / 1e9:.1f} GB free, "
                              f"{needed / 1e9:.1f} GB needed.")
