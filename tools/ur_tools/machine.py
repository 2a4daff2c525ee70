"""The cores and the memory that this process can use, also in a container with limits."""

import os
import pathlib
from typing import List

CGROUP = pathlib.Path("/sys/fs/cgroup")  # of version 2, as a container sees its own


def _limit(name: str) -> List[float]:
    """Returns the numbers in a file of the cgroup; an empty list if there is no limit."""
    try:
        words = (CGROUP / name).read_text().split()
    except OSError:
        return []
    return [] if "max" in words else [float(word) for word in words]


def cores() -> int:
    count = len(os.sched_getaffinity(0))
    quota = _limit("cpu.max")  # processor time and the period in which it may be used
    return max(1, min(count, int(quota[0] / quota[1]))) if quota else count


def memory() -> float:
    """Returns bytes."""
    return min([float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")), *_limit("memory.max")])
