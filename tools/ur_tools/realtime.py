"""Scheduling of the programs of a measurement: real-time priorities, and cores that do not sleep."""

import os
import pathlib
import sys

from .processes import Programs

# SCHED_IDLE yields to every other program at once. A kernel with autogroups (sched(7)) nevertheless gives the session its
# share, hence the nice value of the group.
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
    """Runs a busy loop on each core until `programs` are stopped, so that no core sleeps.

    Waking an idle core takes longer than the measured times, on a virtual machine up to tens of milliseconds; hosts of real
    robots are configured not to sleep. Use it with programs that have real-time priority: with lazy preemption, others wait
    for the loop until the next tick.
    """
    for core in sorted(os.sched_getaffinity(0)):
        programs.start(f"awake_{core}", [sys.executable, "-c", _SPIN])


def realtime_allowed(priority: int) -> bool:
    """Returns whether child processes may use SCHED_FIFO with this priority."""
    child = os.fork()
    if child == 0:
        try:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
            os._exit(0)
        except OSError:
            os._exit(1)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


def make_realtime(pid: int, priority: int) -> None:
    """Sets SCHED_FIFO for all threads of the process."""
    for thread in (pathlib.Path("/proc") / str(pid) / "task").iterdir():
        os.sched_setscheduler(int(thread.name), os.SCHED_FIFO, os.sched_param(priority))
