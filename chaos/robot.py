"""A simulated robot with its driver, and its recovery after a fault."""

import json
import os
import pathlib

from programs import Simulator, start_node
from support import wait_for

CLEARING_LIMIT = 20.0  # s


class Robot:
    def __init__(self, address):
        self.simulator = Simulator(address)
        self.driver = start_node("driver", address, "ur_type:=ur10e", "silence_limit:=0.1", "watchdog_frequency:=10.0")
        self._after_fault = []

    def close(self):
        self.driver.resume()
        self.simulator.process.resume()
        self.driver.stop()
        self.simulator.stop()

    def after_fault(self, action):
        self._after_fault.append(action)

    def clear(self):
        """Clears all faults. Returns when the controller is in normal operation."""
        self.driver.resume()
        self.simulator.process.resume()
        if not self.simulator.process.running():
            self.simulator.start()
        while self._after_fault:
            self._try(self._after_fault.pop())
        wait_for(self._in_normal_operation, CLEARING_LIMIT, "the simulator to be in normal operation")

    def _try(self, action):
        """Returns the answer to a step; None if the controller rejects it or a reboot has closed the connection."""
        try:
            return action()
        except AssertionError:
            return None
        except (OSError, json.JSONDecodeError):
            wait_for(self.simulator._connect, CLEARING_LIMIT, "the simulator's control port")
            return None

    def _in_normal_operation(self):
        control = self.simulator.control
        for command, fields in (("accept_connections", {}), ("stall_links", {"stalled": False}), ("clear_pushes", {}),
                                ("speed_slider", {"fraction": 1.0}), ("remote_control", {"on": True}), ("close_popup", {})):
            self._try(lambda c=command, f=fields: control(c, **f))
        state = self._try(self.simulator.state)
        if state is None:
            return False
        recovery = {"PROTECTIVE_STOP": ("unlock_protective_stop", {}), "SAFEGUARD_STOP": ("safeguard", {"open": False}),
                   "ROBOT_EMERGENCY_STOP": ("emergency_stop", {"pressed": False}),
                   "VIOLATION": ("restart_safety", {}), "FAULT": ("restart_safety", {})}.get(state["safety_mode"])
        if recovery:
            self._try(lambda: control(recovery[0], **recovery[1]))
            return False
        if state["robot_mode"] != "RUNNING":
            self.power_up()
            return False
        return True

    def power_up(self):
        """Powers the arm on if it is off."""
        state = self._try(self.simulator.state)
        if state and state["robot_mode"] != "RUNNING":
            self._try(lambda: self.simulator.control("power", to="running"))

    def highest_target_speed(self, after):
        """Returns the highest speed that a joint was to have after this cycle, rad/s."""
        return max((speed for _cycle, _published, speed, _tcp in self.simulator.control("trace", after=after)["cycles"]), default=0.0)

    def joint_speed(self):
        return max(map(abs, self.simulator.state()["actual"]["velocity"]))


def get_resource_usage(pid):
    """Returns the number of descriptors and threads, and the resident memory (MB) of a process."""
    process = pathlib.Path(f"/proc/{pid}")
    pages = int((process / "statm").read_text().split()[1])
    return (len(os.listdir(process / "fd")), len(os.listdir(process / "task")),
            pages * os.sysconf("SC_PAGE_SIZE") / 2**20)
