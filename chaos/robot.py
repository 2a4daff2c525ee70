"""The simulated robot, the driver on it, and how people bring it back after a fault."""

import json
import os
import pathlib

from support import Simulator, node, wait_for

CLEARING_LIMIT = 20.0  # s; a protective stop takes 5 s, a reboot 1 s


class Robot:
    def __init__(self, address):
        self.simulator = Simulator(address)
        self.driver = node("driver", address, "ur_type:=ur10e", "silence_limit:=0.1", "watchdog_frequency:=10.0")
        self._afterwards = []

    def close(self):
        self.driver.go_on()
        self.simulator.process.go_on()
        self.driver.end()
        self.simulator.end()

    def after_fault(self, action):
        self._afterwards.append(action)

    def clear(self):
        """Takes every cause away; returns when the controller says that nothing is the matter."""
        self.driver.go_on()
        self.simulator.process.go_on()
        if not self.simulator.process.running():
            self.simulator.start()
        while self._afterwards:
            self._try(self._afterwards.pop())
        wait_for(self._nothing_the_matter, CLEARING_LIMIT, "the simulator to be as at the start")

    def _try(self, action):
        """A step that is not needed now is refused; a reboot ends the connection."""
        try:
            return action()
        except AssertionError:
            return None
        except (OSError, json.JSONDecodeError):
            wait_for(self.simulator._connect, CLEARING_LIMIT, "the simulator's control port")
            return None

    def _nothing_the_matter(self):
        control = self.simulator.control
        for command, fields in (("accept_connections", {}), ("stall_links", {"stalled": False}), ("clear_pushes", {}),
                                ("speed_slider", {"fraction": 1.0}), ("remote_control", {"on": True}), ("close_popup", {})):
            self._try(lambda c=command, f=fields: control(c, **f))
        state = self._try(self.simulator.state)
        if state is None:
            return False
        way_out = {"PROTECTIVE_STOP": ("unlock_protective_stop", {}), "SAFEGUARD_STOP": ("safeguard", {"open": False}),
                   "ROBOT_EMERGENCY_STOP": ("emergency_stop", {"pressed": False}),
                   "VIOLATION": ("restart_safety", {}), "FAULT": ("restart_safety", {})}.get(state["safety_mode"])
        if way_out:
            self._try(lambda: control(way_out[0], **way_out[1]))
            return False
        if state["robot_mode"] != "RUNNING":
            self.power_up()
            return False
        return True

    def power_up(self):
        """For an arm that somebody has switched off; one that runs is left alone."""
        state = self._try(self.simulator.state)
        if state and state["robot_mode"] != "RUNNING":
            self._try(lambda: self.simulator.control("power", to="running"))

    def joint_speed(self):
        return max(map(abs, self.simulator.state()["actual"]["velocity"]))


def load_of(pid):
    """Descriptors, threads and resident memory (MB) of a process."""
    process = pathlib.Path(f"/proc/{pid}")
    pages = int((process / "statm").read_text().split()[1])
    return (len(os.listdir(process / "fd")), len(os.listdir(process / "task")),
            pages * os.sysconf("SC_PAGE_SIZE") / 2**20)
