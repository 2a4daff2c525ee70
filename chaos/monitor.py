"""Monitors the arm and the driver during a run."""

import math
import statistics
import threading
import time

from control_port import ControlPort, ControlPortError
from robot import get_resource_usage

PERIOD = 0.1  # s
REST_AFTER = 1.0  # s, after the end of the last goal
AT_REST = 0.02  # rad/s


class ArmMonitor:
    """Checks that the arm moves only while a goal is active, and that the driver runs."""

    def __init__(self, robot, gate, journal):
        self._robot, self._gate, self._journal = robot, gate, journal
        self._stop = threading.Event()
        self.paused = threading.Event()  # the arm may move without a goal, because it is pushed or has no power
        self._thread = threading.Thread(target=self._run, name="monitor")

    def start(self):
        self._thread.start()

    def stop(self):
        self._stop.set()
        self._thread.join(10.0)

    def _run(self):
        port = None
        while not self._stop.wait(PERIOD):
            if not self._robot.driver.running():
                self._journal.violate("driver", f"the process has exited: {''.join(self._robot.driver.lines[-1:])}")
                return
            try:
                port = port or ControlPort(self._robot.simulator.address, timeout=2.0)
                self._check_state(port.request("state")["state"])
            except (OSError, ValueError, ControlPortError):
                port = None  # the simulator has a fault

    def _check_state(self, state):
        speed = max(map(abs, state["actual"]["velocity"]))
        idle = self._gate.idle_for()
        if speed > AT_REST and idle > REST_AFTER and not self.paused.is_set():
            self._journal.violate("arm", f"moves at {speed:.3f} rad/s, {idle:.1f} s after the last goal ended")


class ResourceMonitor:
    """Compares descriptors, threads and memory of the driver after the warm-up with those at the end."""

    EXTRA_DESCRIPTORS = 6
    EXTRA_THREADS = 3
    EXTRA_MEMORY = 12.0  # MB; the memory that the allocator keeps varies
    LEAST_SAMPLES = 8  # that can be compared

    def __init__(self, pid, journal=None, keeps_freed_memory=False):
        """If `keeps_freed_memory` is set, as for a sanitizer, the memory is not compared."""
        self._pid, self._journal = pid, journal
        self._limits = (self.EXTRA_DESCRIPTORS, self.EXTRA_THREADS, math.inf if keeps_freed_memory else self.EXTRA_MEMORY)
        self.samples = []

    def sample(self):
        self.samples.append((time.monotonic(), *get_resource_usage(self._pid)))
        if self._journal:
            self._journal.write("driver", "{} descriptors, {} threads, {:.1f} MB".format(*self.samples[-1][1:]))

    def find_growth(self):
        """Returns what has grown from the second quarter, after the warm-up, to the last quarter."""
        if len(self.samples) < self.LEAST_SAMPLES:
            return []
        quarter = len(self.samples) // 4
        # A sample during a reconnection is low, and one during a goal is high: neither may count as growth.
        before = self._reduce(statistics.median_high, self.samples[quarter:2 * quarter])
        after = self._reduce(min, self.samples[-quarter:])
        return [f"{name} grew from {b:g} to {a:g}" for name, b, a, limit in
                zip(("descriptors", "threads", "memory (MB)"), before, after, self._limits) if a > b + limit]

    @staticmethod
    def _reduce(function, samples):
        return [function([sample[column] for sample in samples]) for column in (1, 2, 3)]

    def text(self):
        if not self.samples:
            return "not measured"
        first, last = self.samples[0], self.samples[-1]
        values = ", ".join(f"{name} {a:.0f} to {b:.0f}" for name, a, b in
                           zip(("descriptors", "threads", "memory (MB)"), first[1:], last[1:]))
        if len(self.samples) < self.LEAST_SAMPLES:
            return f"{values}; the run was too short to compare them"
        return f"{values}; {'they grew' if self.find_growth() else 'they did not grow'}"
