"""./ur doctor: checks whether this machine can build and run everything."""

import os
import pathlib
import shutil
import statistics
import subprocess
import tempfile
import textwrap
import time
from dataclasses import dataclass
from typing import Callable, List, Tuple

from . import build, console, disk, machine, ports, system_packages, venv
from .layout import ROOT, STATE, Layout
from .packages import discover_with_interfaces

OK, NOTE, FAILED = "OK", "warning", "fault"  # as in `ur doctor --robot`
DEMO_ADDRESS = "127.0.0.1"
TEST_ADDRESSES = ("127.0.0.2", "127.0.1.1", "127.0.1.101")
CYCLE = 0.002  # s, of a controller
CYCLES = 500
LATENCY_LIMITS = (0.5, 5.0)  # ms, of p99 and maximum
STEAL_LIMIT = 0.01  # share of the processor time that goes to other virtual machines
LEAST_MEMORY = 2.0e9
_CPP = "#include <concepts>\n#include <span>\nint main() { static_assert(__cplusplus >= 202002L); }\n"


@dataclass
class Finding:
    what: str
    state: str
    text: str
    advice: str = ""


def _may_install() -> bool:
    try:
        system_packages._prefix()
        return True
    except PermissionError:
        return False


def compiler() -> Finding:
    name = os.environ.get("CXX") or shutil.which("c++") or shutil.which("g++") or ""
    if not name:
        advice = "./ur installs it." if _may_install() else "sudo apt-get install -y g++"
        return Finding("compiler", NOTE if _may_install() else FAILED, "no C++ compiler found", advice)
    try:
        version = subprocess.run([*name.split(), "--version"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                 universal_newlines=True).stdout.splitlines()[:1]
        result = subprocess.run([*name.split(), "-std=c++20", "-fsyntax-only", "-x", "c++", "-"], input=_CPP,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
    except OSError as error:
        return Finding("compiler", FAILED, f"{name}: {error.strerror}", "Set CXX to a compiler that exists, or unset it.")
    text = version[0] if version else name
    if result.returncode != 0:
        return Finding("compiler", FAILED, f"{text}: does not compile C++20",
                       "Install g++ 11 or clang 14, or a newer version, and select it: CXX=g++-12 ./ur ...")
    return Finding("compiler", OK, text)


def system() -> Finding:
    absent = system_packages.absent()
    if not shutil.which("dpkg-query"):
        return Finding("system packages", NOTE, "not checked: this machine has no dpkg",
                       "Install the equivalents of these Debian packages: " + " ".join(system_packages.needed()))
    if not absent:
        return Finding("system packages", OK, "all installed")
    text = "missing: " + " ".join(absent)
    if _may_install():
        return Finding("system packages", NOTE, text, "./ur installs them.")
    return Finding("system packages", FAILED, text, "sudo apt-get install -y --no-install-recommends " + " ".join(absent))


def python(layout: Layout) -> Finding:
    try:
        return Finding("Python", OK, venv.python_for(layout))
    except console.Failure as failure:
        first, _, rest = str(failure).partition("\n")
        return Finding("Python", FAILED, first, rest)


def checkout() -> Finding:
    try:
        build.check_path(ROOT)
    except console.Failure as failure:
        return Finding("checkout", FAILED, str(failure))
    folder = STATE if STATE.exists() else ROOT
    try:
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        return Finding("checkout", FAILED, f"{folder} cannot be written: {error.strerror}",
                       "./ur writes all its files to .ur in the checkout. Use a writable checkout.")
    return Finding("checkout", OK, str(ROOT))


def free_space(layout: Layout) -> Finding:
    needed, free = build.needed_space(layout, discover_with_interfaces()), disk.free(STATE)
    text = f"{free / 1e9:.1f} GB free, {needed / 1e9:.1f} GB needed"
    if free < needed:
        return Finding("disk", FAILED, text, f"Free some space on the disk that holds {STATE}.")
    return Finding("disk", OK, text)


def memory() -> Finding:
    total, cores, jobs = machine.memory(), machine.cores(), build.default_jobs()
    text = f"{total / 1e9:.1f} GB, {cores} core{'s' * (cores > 1)}: builds with {jobs} job{'s' * (jobs > 1)}"
    if total < LEAST_MEMORY:
        return Finding("memory", NOTE, text, "The largest files take about 1 GB each: close other programs, or add swap space.")
    return Finding("memory", OK, text)


def demo_ports() -> Finding:
    taken = ports.in_use(DEMO_ADDRESS, list(ports.PORTS.values()))
    if not taken:
        return Finding("ports", OK, f"the ports of the demo are free on {DEMO_ADDRESS}")
    return Finding("ports", NOTE, ports.explain(DEMO_ADDRESS, taken).replace("\n", "; "),
                   "Stop that process, or use another address and ROS domain: ROS_DOMAIN_ID=1 ./ur demo --address "
                   f"{ports.another_address(DEMO_ADDRESS)}")


def loopback() -> Finding:
    try:
        for address in TEST_ADDRESSES:
            ports.in_use(address, [0])
    except console.Failure as failure:
        return Finding("loopback", FAILED, str(failure).replace("--address ", ""),
                       "Parallel tests use one loopback address each. On Linux: ip addr add 127.0.0.1/8 dev lo; ip link set lo up")
    return Finding("loopback", OK, f"{', '.join(TEST_ADDRESSES)} can be used")


def _processor_time() -> Tuple[int, int]:
    """Returns the total time and the steal time since boot, in ticks."""
    fields = [int(value) for value in pathlib.Path("/proc/stat").read_text().splitlines()[0].split()[1:9]]
    return sum(fields), fields[7]


def wake_up_latencies() -> List[float]:
    """Returns the wake-up latency of each cycle, ms."""
    late = []
    due = time.monotonic()
    for _unused in range(CYCLES):
        due += CYCLE
        time.sleep(max(0.0, due - time.monotonic()))
        late.append(1e3 * (time.monotonic() - due))
        due = max(due, time.monotonic() - CYCLE)  # one delay counts once
    return late


def judge_jitter(late: List[float], stolen: float) -> Finding:
    p99, latest = statistics.quantiles(late, n=100)[98], max(late)
    text = (f"wake-up latency of a 2 ms cycle: {statistics.median(late):.2f} ms (median), {p99:.2f} ms (p99), "
            f"{latest:.2f} ms (max)")
    if stolen > STEAL_LIMIT:
        return Finding("time jitter", NOTE, f"{text}; {100 * stolen:.0f} % of the processor time goes to other virtual machines",
                       "Demo and tests work. Results of ./ur bench are not meaningful, and servo motions at 500 Hz may be uneven.")
    if p99 > LATENCY_LIMITS[0] or latest > LATENCY_LIMITS[1]:
        return Finding("time jitter", NOTE, text,
                       "Demo and tests work. Servo motions at 500 Hz may be uneven: close other programs. For a real robot, use a "
                       "PREEMPT_RT kernel, the CPU governor \"performance\" and the parameter realtime_priority.")
    return Finding("time jitter", OK, text)


def jitter() -> Finding:
    total, stolen = _processor_time()
    late = wake_up_latencies()
    total_after, stolen_after = _processor_time()
    return judge_jitter(late, (stolen_after - stolen) / max(1, total_after - total))


def show(finding: Finding) -> None:
    console.line(f"{finding.state:7} {finding.what:16} {finding.text}")
    for line in finding.advice.splitlines():
        for part in textwrap.wrap(line.strip(), 105, break_long_words=False, break_on_hyphens=False):
            console.line(f"{'':24} {part}")


def run(layout: Layout) -> int:
    checks: Tuple[Callable[[], Finding], ...] = (checkout, compiler, system, lambda: python(layout), lambda: free_space(layout), memory,
                                                 demo_ports, loopback, jitter)
    failed = 0
    for check in checks:
        finding = check()
        failed += finding.state == FAILED
        show(finding)
    console.line(f"{failed} problem{'s' * (failed > 1)} must be solved first." if failed else
                 "This machine can build and run everything.")
    return 1 if failed else 0
