"""Describes what was measured and where: machine, build, commit; and what else used the machine during a run."""

import os
import pathlib
import platform
import re
import resource
import time
from typing import Dict, List

from . import git, machine
from .layout import Layout

# Files that affect neither the driver nor what is measured.
_NOT_DRIVER = (":!*.md", ":!tools/test", ":!chaos", ":!demo")
# Keys whose values must be equal for two results to be from the same machine and kind of build.
SAME_MACHINE = ("cpu", "cores", "kernel", "governor", "compiler", "ros", "build")


def _cpu() -> str:
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith(("model name", "Model")):
            return line.partition(":")[2].strip()
    return platform.machine()


def _governor() -> str:
    files = pathlib.Path("/sys/devices/system/cpu").glob("cpu[0-9]*/cpufreq/scaling_governor")
    return ", ".join(sorted({file.read_text().strip() for file in files})) or "not controlled by this kernel"


def _compiler(layout: Layout) -> str:
    """Returns the compiler of the driver according to CMake."""
    for file in (layout.build / "ur_ros_rtde" / "CMakeFiles").glob("*/CMakeCXXCompiler.cmake"):
        found = dict(re.findall(r'^set\((CMAKE_CXX_COMPILER_(?:ID|VERSION)) "([^"]*)"\)', file.read_text(), re.M))
        return " ".join(found.values())
    return "unknown"


def _git(*arguments: str) -> str:
    result = git.run(*arguments)
    return result.stdout.strip() if result.returncode == 0 else ""


def describe(layout: Layout) -> Dict[str, object]:
    return {"cpu": _cpu(), "cores": machine.cores(), "kernel": platform.release(), "governor": _governor(),
            "compiler": _compiler(layout), "ros": layout.ros, "build": layout.variant or "release"}


def commit() -> str:
    """Returns the commit of this checkout; with `-modified` if tracked files of the driver differ from it."""
    found = _git("rev-parse", "--short=12", "HEAD")
    changed = _git("status", "--porcelain", "--untracked-files=no", "--", ".", *_NOT_DRIVER)
    return (found or "unknown") + "-modified" * bool(found and changed)


def _ticks() -> List[int]:
    return [int(field) for field in pathlib.Path("/proc/stat").read_text().splitlines()[0].split()[1:9]]


def _own_seconds() -> float:
    """Returns the processor time of this process and of its children that have ended, s."""
    usage = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in usage)


class LoadMeter:
    """Measures from its construction to result() what other processes took away from the measurement."""

    def __init__(self) -> None:
        self._ticks, self._own, self._begin = _ticks(), _own_seconds(), time.monotonic()

    def result(self) -> Dict[str, float]:
        """Returns the load of other processes in cores, the share of stolen time in %, and the load average."""
        seconds = time.monotonic() - self._begin
        ticks = [after - before for before, after in zip(self._ticks, _ticks())]
        user, nice, system, _idle, _iowait, irq, softirq, steal = ticks
        busy = (user + nice + system + irq + softirq) / os.sysconf("SC_CLK_TCK")
        others = max(0.0, busy - (_own_seconds() - self._own)) / seconds
        return {"other processes": round(others, 2), "steal": round(100.0 * steal / max(1, sum(ticks)), 2),
                "load average": os.getloadavg()[0]}
