"""Settings of this host that delay programs: kernel, priorities, frequency and isolation of the cores."""

import os
import pathlib
import resource
from typing import List

from .finding import Finding, ok, warning

ROOT = pathlib.Path("/")
PAGE = "see docs/use/real_time.md"


def _text(file: pathlib.Path) -> str:
    try:
        return file.read_text().strip()
    except OSError:
        return ""


def judge_kernel(version: str, root: pathlib.Path = ROOT) -> Finding:
    """`version`: as uname -v prints it."""
    if "PREEMPT_RT" in version or _text(root / "sys/kernel/realtime") == "1":
        return ok("host kernel", "has real-time preemption")
    return warning("host kernel", "has no real-time preemption, so servo setpoints can be late under load",
                   f"use a PREEMPT_RT kernel, {PAGE}")


def judge_priority(limit: int, is_root: bool) -> Finding:
    """`limit`: the highest real-time priority that this user may use."""
    if is_root or limit > 0:
        return ok("host priority", "this user may use real-time priorities")
    return warning("host priority", "this user may use no real-time priority, so realtime_priority has no effect",
                   f"set rtprio in /etc/security/limits.conf, {PAGE}")


def judge_governor(root: pathlib.Path = ROOT) -> Finding:
    governors = {_text(file) for file in root.glob("sys/devices/system/cpu/cpu*/cpufreq/scaling_governor")} - {""}
    if not governors:
        return ok("host governor", "the kernel does not change the frequency of the cores")
    if governors == {"performance"}:
        return ok("host governor", "performance")
    return warning("host governor", f"{', '.join(sorted(governors))}: cores slow down between packages",
                   f"cpupower frequency-set -g performance, {PAGE}")


def judge_cores(root: pathlib.Path = ROOT) -> Finding:
    isolated = _text(root / "sys/devices/system/cpu/isolated")
    return ok("host cores", f"{isolated} are isolated" if isolated else "none is isolated, which only a busy host needs")


def judge() -> List[Finding]:
    limit = resource.getrlimit(resource.RLIMIT_RTPRIO)[0]
    return [judge_kernel(os.uname().version), judge_priority(limit, os.geteuid() == 0), judge_governor(), judge_cores()]
