"""pytest fixtures for tests of commands: a simulated robot, its driver, and the arm in Python. In a test module:

    pytest_plugins = ["ur_ros_rtde.testing"]


    def test_wag(arm, simulator):
        arm.wag(angle=0.2)
        assert simulator.is_at_rest()

Simulator and driver are those of the test module, in a ROS domain and on an address of their own. A fixture of the module with the name
robot_model, simulator_options or driver_parameters takes the place of the one here:

    @pytest.fixture(scope="module")
    def driver_parameters():
        return ["plugins:=[move_j,wag]"]
"""

import contextlib
import os
import pathlib
import signal
import socket
import subprocess
import threading
import time
from collections.abc import Iterator, Sequence
from types import TracebackType

import pytest
from ament_index_python import get_package_prefix
from ur_simulator import SimulatedRobot, SimulatorError

from .errors import CommandFailed, Rejected
from .robot import Robot

HOME = (0.0, -1.57, 1.57, -1.57, -1.57, 0.0)  # rad
_FIRST_PORT, _LAST_DOMAIN = 32768, 100  # of ROS's domain_coordinator: the owner of a domain has bound its TCP port
_RTPS_PORT, _RTPS_PORTS = 7400, 250  # the first UDP port of domain 0, and the number of ports of each domain
# With these variables of the user, nodes find others on other hosts.
_PEERS = ("ROS_STATIC_PEERS", "ROS_DISCOVERY_SERVER", "ROS_SUPER_CLIENT", "ROS2_EASY_MODE", "CYCLONEDDS_URI")
_READY_TIMEOUT = 60.0  # s; the driver takes 0.3 s on an idle machine
_EXIT_TIMEOUT = 15.0  # s
# A controller unlocks a protective stop after 5 s.
_OPTIONS = ("--recovery-time-factor", "0.02")
# A test is not about the punctuality of its host.
_PARAMETERS = ("silence_limit:=2.0", "watchdog_frequency:=2.0")


class Driver:
    """A running driver. `parameters`: "name:=value". It is a context manager; stop() ends the program, start() starts it again.

    `lines` is what it has printed."""

    def __init__(self, address: str, *parameters: str, namespace: str = ""):
        program = pathlib.Path(get_package_prefix("ur_ros_rtde"), "lib", "ur_ros_rtde", "driver")
        self._command = [str(program), "--ros-args"]
        for parameter in (f"robot_ip:={address}", *parameters):
            self._command += ["-p", parameter]
        if namespace:
            self._command += ["-r", f"__ns:=/{namespace.strip('/')}"]
        self.lines: list[str] = []
        self.start()

    def start(self) -> None:
        """Starts the program, as at the beginning, after stop() or kill()."""
        self._process = subprocess.Popen(self._command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as output:
            for line in output:
                self.lines.append(line.rstrip("\n"))

    @property
    def is_running(self) -> bool:
        return self._process.poll() is None

    def output(self) -> str:
        return "\n".join(self.lines)

    def kill(self) -> None:
        """Ends the program at once, as a crash does: the watchdog of the control program stops the arm."""
        self._process.kill()
        self._process.wait()
        self._reader.join()

    def stop(self) -> None:
        """Ends the program as Ctrl-C does. Safe to call again."""
        if self.is_running:
            self._process.send_signal(signal.SIGINT)
            try:
                self._process.wait(_EXIT_TIMEOUT)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        self._reader.join()

    def __enter__(self) -> "Driver":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.stop()


def _has_nodes(domain: int) -> bool:
    """Returns whether a node of the domain runs on this host."""
    first = _RTPS_PORT + _RTPS_PORTS * domain
    sockets = [line.split()[1] for file in pathlib.Path("/proc/net").glob("udp*") for line in file.read_text().splitlines()[1:]]
    return any(first <= int(local.rpartition(":")[2], 16) < first + _RTPS_PORTS for local in sockets)


def _reserve_domain(reserved: contextlib.ExitStack) -> int:
    """Returns a ROS domain that no other test and no running node on this host uses until `reserved` is closed."""
    for number in range(_LAST_DOMAIN, 0, -1):
        reservation = reserved.enter_context(socket.socket())
        with contextlib.suppress(OSError):
            reservation.bind(("", _FIRST_PORT + number))
            if not _has_nodes(number):
                return number
    raise RuntimeError(f"all ROS domains from 1 to {_LAST_DOMAIN} are in use")


@contextlib.contextmanager
def own_domain() -> Iterator[int]:
    """A ROS domain of its own for this process and its children, in which no other node runs yet, and which other hosts do not see: a
    goal of a test reaches no other robot, unless a driver is started in the domain in the meantime."""
    with contextlib.ExitStack() as reserved, pytest.MonkeyPatch.context() as environment:
        number = _reserve_domain(reserved)
        environment.setenv("ROS_DOMAIN_ID", str(number))
        environment.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
        if os.environ.get("ROS_DISTRO") == "humble":  # does not know it
            environment.setenv("ROS_LOCALHOST_ONLY", "1")
        for name in _PEERS:
            environment.delenv(name, raising=False)
        yield number


@pytest.fixture(scope="module")
def robot_model() -> str:
    return "ur10e"


@pytest.fixture(scope="module")
def simulator_options() -> Sequence[str]:
    """Options of the simulator program, such as "--powered-off"."""
    return ()


@pytest.fixture(scope="module")
def driver_parameters() -> Sequence[str]:
    """Parameters of the driver, such as "on_busy:=preempt"."""
    return ()


@pytest.fixture(scope="module")
def simulator(robot_model: str, simulator_options: Sequence[str]) -> Iterator[SimulatedRobot]:
    """A simulated robot on an address of its own, powered on with released brakes."""
    with SimulatedRobot(robot_model, *_OPTIONS, *simulator_options) as robot:
        yield robot


@pytest.fixture(scope="module")
def driver(simulator: SimulatedRobot, driver_parameters: Sequence[str]) -> Iterator[Driver]:
    """A driver of the simulated robot."""
    parameters = (*_PARAMETERS, f"ur_type:={simulator.model}", *driver_parameters)
    with own_domain(), Driver(simulator.address, *parameters) as running:
        yield running
        print(running.output())


@pytest.fixture(scope="module")
def _connected(driver: Driver) -> Iterator[Robot]:
    with Robot(timeout=_READY_TIMEOUT) as robot:
        yield robot


@pytest.fixture
def arm(_connected: Robot, driver: Driver, simulator: SimulatedRobot) -> Robot:
    """The arm, at HOME and ready, without obstacles. A protective stop of the test before is unlocked."""
    assert driver.is_running, driver.output()
    for command in ("clear_surfaces", "clear_boxes", "clear_pushes"):
        simulator.control(command)
    end = time.monotonic() + _READY_TIMEOUT
    while True:
        try:
            if simulator.state()["safety_mode"] == "PROTECTIVE_STOP":
                simulator.control("unlock_protective_stop")
            _connected.move_j(HOME, speed=3.0, acceleration=15.0)
            return _connected
        except (Rejected, CommandFailed, SimulatorError) as error:  # the control program may be starting
            assert time.monotonic() < end, f"the arm does not get ready: {error}\n{driver.output()}"
            time.sleep(0.05)
