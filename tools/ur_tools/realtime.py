"""What the kernel does with the programs of a measurement: cores that stay awake, priorities."""

import os
import pathlib
import sys

from .processes import Programs

# Gives way to everything at once, so that it costs the measured programs nothing. A kernel with autogroups (sched(7)) gives
# a session its share, whatever its policy.
_SPIN = """
import os, pathlib
os.sched_setscheduler(0, os.SCHED_IDLE, os.sched_param(0))
group = pathlib.Path("/proc/self/autogroup")
if group.exists():
    group.write_text("19")
while True:
    pass
"""


def keep_awake(programs: Programs) -> None:
    """One loop a core, until `programs` end: waking an idle core takes longer than what is measured, and on a virtual machine
    up to tens of milliseconds. Controllers' hosts are set up so that they do not sleep. For programs with real-time priority:
    a kernel with lazy preemption lets others wait for the loop until the next tick."""
    for core in sorted(os.sched_getaffinity(0)):
        programs.start(f"awake_{core}", [sys.executable, "-c", _SPIN])


def may_be_realtime(priority: int) -> bool:
    """Whether the programs that this one starts may ask for SCHED_FIFO with that priority."""
    child = os.fork()
    if child == 0:
        try:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
            os._exit(0)
        except OSError:
            os._exit(1)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


def make_realtime(pid: int, priority: int) -> None:
    """All threads of the process."""
    for thread in (pathlib.Path("/proc") / str(pid) / "task").iterdir():
        os.sched_setscheduler(int(thread.name), os.SCHED_FIFO, os.sched_param(priority))
