"""Reads the surfaces of a simulated world from the simulator's control port."""

import ipaddress
import json
import socket
import threading
from typing import Any, List, Optional, Tuple

from .scene.surfaces import Surface

CONTROL_PORT = 30099
PERIOD = 1.0  # s
TIMEOUT = 1.0  # s, for connecting and for each answer


def may_be_simulator(address: str) -> bool:
    """Returns whether the address of a controller is that of a simulator on this machine. A robot's ports are left alone."""
    try:
        return ipaddress.ip_address(address).is_loopback
    except ValueError:
        return address == "localhost"


class SimulatorWatcher:
    """Asks a simulator once per second, in a thread. Without a simulator there are no surfaces, which is no error."""

    def __init__(self, address: str):
        self.address = address
        self._surfaces: Tuple[Surface, ...] = ()
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="simulator", daemon=True)
        self._thread.start()

    @property
    def surfaces(self) -> Tuple[Surface, ...]:
        return self._surfaces

    def _run(self) -> None:
        while not self._ended.is_set():
            try:
                self._follow()
            except (OSError, ValueError, KeyError, TypeError):
                self._surfaces = ()
            self._ended.wait(PERIOD)

    def _follow(self) -> None:
        with socket.create_connection((self.address, CONTROL_PORT), TIMEOUT) as connection, connection.makefile("r") as lines:
            while not self._ended.is_set():
                connection.sendall(b'{"command": "state"}\n')
                self._surfaces = read_surfaces(lines.readline())
                self._ended.wait(PERIOD)

    def close(self) -> None:
        self._ended.set()
        self._thread.join(2.0 * TIMEOUT + PERIOD)


def read_surfaces(answer: str) -> Tuple[Surface, ...]:
    """Returns point and unit normal of each surface. Raises ValueError or KeyError if the answer is not that of a simulator."""
    entries: List[Any] = json.loads(answer)["state"]["surfaces"]
    return tuple((tuple(map(float, entry["point"])), tuple(map(float, entry["normal"]))) for entry in entries)


def watcher_of(address: str, stated: str) -> Optional[SimulatorWatcher]:
    """Returns the watcher of the simulator at the stated address, or else at that of the controller if it can be a simulator."""
    if stated:
        return SimulatorWatcher(stated)
    return SimulatorWatcher(address) if may_be_simulator(address) else None
