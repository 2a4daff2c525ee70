"""Runs the program `ur`, with a simulator and a driver."""

import contextlib
import fcntl
import os
import pty
import signal
import struct
import subprocess
import termios

import pytest
import yaml
from own_domain import Domain
from programs import Process, find_program
from robot_fixtures import simulated_robot
from support import HOME, TIMEOUT_FACTOR, wait_for

DISCOVERY = str(8.0 * TIMEOUT_FACTOR)  # s, time limit for the discovery of all actions
_EMPTY = Domain()  # without nodes
EMPTY_DOMAIN = str(_EMPTY.number)


@pytest.fixture(scope="module")
def running():
    with simulated_robot("ur_type:=ur10e") as simulator:
        yield simulator


@pytest.fixture
def at_home(running):
    code, output = ur("call", "move_j", goal(joint_positions=HOME, speed=3.0, acceleration=15.0))
    assert code == 0, output
    return running


def ur(*arguments, limit=60.0, domain=None):
    """Returns the exit code and the output."""
    process = Process([find_program("ur_ros_rtde_cli", "ur"), *arguments], {} if domain is None else {"ROS_DOMAIN_ID": domain})
    return process.wait(limit), process.output()


def goal(**fields):
    return yaml.safe_dump(fields, default_flow_style=True, width=1000).strip()


def slow_motion(speed=0.2):
    away = [HOME[0] - 2.0, *HOME[1:]]
    return [find_program("ur_ros_rtde_cli", "ur"), "call", "move_j", "--quiet", goal(joint_positions=away, speed=speed)]


def wait_until_moving(simulator):
    wait_for(lambda: not simulator.state()["at_rest"], 20.0, "the arm to move")


def output_on_terminal(arguments, lines=40, until=None):
    """Returns exit code and output of `ur` on a terminal of 100 columns. SIGINT ends it when it has printed `until`."""
    terminal, end = pty.openpty()
    fcntl.ioctl(end, termios.TIOCSWINSZ, struct.pack("HHHH", lines, 100, 0, 0))
    # Not the environment of the process: pytest imports readline, which sets LINES and COLUMNS there.
    process = subprocess.Popen([find_program("ur_ros_rtde_cli", "ur"), *arguments], stdout=end, stderr=end, env=dict(os.environ))
    os.close(end)
    shown = b""
    with contextlib.suppress(OSError):  # EIO: the other side of the terminal is closed
        while True:
            shown += os.read(terminal, 65536)
            if until is not None and until in shown:
                process.send_signal(signal.SIGINT)
                until = None
    os.close(terminal)
    return process.wait(TIMEOUT_FACTOR * 20.0), shown.decode()
