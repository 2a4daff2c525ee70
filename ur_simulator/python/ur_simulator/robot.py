"""A simulated robot in a process of its own, for tests in Python."""

import ipaddress
import json
import os
import pathlib
import queue
import random
import shutil
import socket
import subprocess
import threading
import time
from typing import Any, Callable, Dict, List, Optional, Tuple

CONTROL_PORT = 30099
_START_TIMEOUT = 30.0  # s; the program takes 0.1 s on an idle machine
_AT_REST = 0.01  # rad/s, more than the noise of the sensors
_PROGRAM_VARIABLE = "UR_SIMULATOR_PROGRAM"


class SimulatorError(RuntimeError):
    """The simulator cannot be started, or rejects a request."""


def program() -> pathlib.Path:
    """Returns the simulator program that the environment variable UR_SIMULATOR_PROGRAM names, else that of this package, else the one
    in PATH."""
    chosen = os.environ.get(_PROGRAM_VARIABLE)
    path = pathlib.Path(chosen) if chosen else pathlib.Path(__file__).parent / "bin" / "ur_simulator"
    if path.is_file():
        return path
    installed = None if chosen else shutil.which("ur_simulator")
    if installed is None:
        raise SimulatorError(f"the simulator program {path} does not exist: install the package ur-simulator, or set "
                             f"{_PROGRAM_VARIABLE}")
    return pathlib.Path(installed)


def _random_loopback_address() -> str:
    """An address of 127.0.0.0/8, so that tests that run in parallel do not need the same ports."""
    first = int(ipaddress.IPv4Address("127.1.0.1"))
    last = int(ipaddress.IPv4Address("127.254.255.254"))
    return str(ipaddress.IPv4Address(random.randint(first, last)))


class SimulatedRobot:
    """A running simulator. It is a context manager; close() ends the program.

    `address` is the IP address to connect to. Without one, an unused loopback address is chosen. `options` are further
    options of the program, such as "--powered-off".
    """

    def __init__(self, model: str = "ur10e", *options: str, address: Optional[str] = None,
                 polyscope: Optional[str] = None) -> None:
        self.model = model
        arguments = ["--model", model, *options]
        if polyscope is not None:
            arguments += ["--polyscope", polyscope]
        self.address, self._process, self._output = _start(arguments, address)

    def __enter__(self) -> "SimulatedRobot":
        return self

    def __exit__(self, *_exception: object) -> None:
        self.close()

    def close(self) -> None:
        """Ends the program. Safe to call again."""
        if self._process.poll() is None:
            self._process.terminate()
            try:
                self._process.wait(10.0)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        self._output.join()

    def control(self, command: str, **fields: Any) -> Dict[str, Any]:
        """Executes a command of the control port, such as control("push", force=[0, 30, 0]), and returns its reply."""
        request = json.dumps({"command": command, **fields}) + "\n"
        with socket.create_connection((self.address, CONTROL_PORT), timeout=10.0) as connection:
            connection.sendall(request.encode())
            with connection.makefile() as lines:
                reply = json.loads(lines.readline())
        if not reply["ok"]:
            raise SimulatorError(reply["error"])
        return reply

    def state(self) -> Dict[str, Any]:
        """Returns the state of the robot: modes, joints, TCP, IO, program (docs/use/simulator.md)."""
        return self.control("state")["state"]

    def is_at_rest(self) -> bool:
        """Returns whether no joint moves."""
        return all(abs(velocity) < _AT_REST for velocity in self.state()["actual"]["velocity"])

    def wait_for(self, condition: Callable[[Dict[str, Any]], bool], timeout: float = 10.0) -> Dict[str, Any]:
        """Returns the first state that meets the condition. `timeout` is in seconds of simulated time, so that a busy
        machine does not matter. Raises TimeoutError with the last state."""
        state = self.state()
        end = state["timestamp"] + timeout
        while not condition(state):
            if state["timestamp"] > end:
                raise TimeoutError(f"the condition was not met within {timeout} s; the last state is {state}")
            time.sleep(0.002)
            state = self.state()
        return state


def _start(arguments: List[str], address: Optional[str]) -> "Tuple[str, subprocess.Popen[str], threading.Thread]":
    """Returns address, process and the thread that reads its output."""
    attempts = 1 if address is not None else 10
    for attempt in range(1, attempts + 1):
        chosen = address if address is not None else _random_loopback_address()
        process = subprocess.Popen([str(program()), "--address", chosen, *arguments], stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True)
        lines: "queue.Queue[str]" = queue.Queue()
        thread = threading.Thread(target=_read, args=(process, lines), daemon=True)
        thread.start()
        failure = _wait_until_ready(process, lines)
        if failure is None:
            return chosen, process, thread
        process.kill()
        process.wait()
        thread.join()
        if attempt == attempts or "is in use" not in failure:
            raise SimulatorError(failure)
    raise AssertionError("unreachable")


def _read(process: "subprocess.Popen[str]", lines: "queue.Queue[str]") -> None:
    assert process.stdout is not None
    with process.stdout:
        for line in process.stdout:
            lines.put(line.strip())
    lines.put("")  # the program has ended


def _wait_until_ready(process: "subprocess.Popen[str]", lines: "queue.Queue[str]") -> Optional[str]:
    """Returns why the program is not ready, or None."""
    end = time.monotonic() + _START_TIMEOUT
    output: List[str] = []
    while True:
        try:
            line = lines.get(timeout=max(0.0, end - time.monotonic()))
        except queue.Empty:
            return f"the simulator was not ready within {_START_TIMEOUT} s"
        if line.startswith("ready: "):
            return None
        if not line:
            return "\n".join(output) or f"the simulator ended with status {process.wait()}"
        output.append(line)
