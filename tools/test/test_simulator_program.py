"""The program ur_simulator: several robots in one process, and refused options."""

import json
import os
import socket
import subprocess

import pytest
from ur_tools.environment import program, run_environment
from ur_tools.layout import Layout

BACKGROUND = True
LAYOUT = Layout.of_environment()
PROGRAM = program(LAYOUT, "ur_simulator", "ur_simulator")
LAST_OCTET = os.environ.get("UR_TEST_ADDRESS", "127.0.1.205").rsplit(".", 1)[1]
ADDRESSES = [f"127.0.{100 + int(LAST_OCTET) % 100}.{host}" for host in range(1, 11)]


def state_of(address):
    return control(address, command="state")["state"]


def control(address, **request):
    with socket.create_connection((address, 30099), timeout=10.0) as connection, connection.makefile("rw") as lines:
        lines.write(json.dumps(request) + "\n")
        lines.flush()
        return json.loads(lines.readline())


@pytest.fixture
def ten_robots():
    with subprocess.Popen([PROGRAM, "--address", ADDRESSES[0], "--count", "10"], env=run_environment(LAYOUT),
                          stdout=subprocess.PIPE, text=True) as process:
        try:
            lines = [process.stdout.readline() for _ in ADDRESSES]
            yield process, lines
        finally:
            process.terminate()


def test_ten_robots_run_on_consecutive_addresses(ten_robots):
    process, lines = ten_robots
    for address, line in zip(ADDRESSES, lines):
        assert line.startswith(f"ready: ur10e on {address}, ")
    # Each is a robot of its own, and its time passes.
    control(ADDRESSES[3], command="protective_stop")
    for address in ADDRESSES:
        state = state_of(address)
        later = state_of(address)
        while later["timestamp"] < state["timestamp"] + 0.1:
            later = state_of(address)
        assert later["safety_mode"] == ("PROTECTIVE_STOP" if address == ADDRESSES[3] else "NORMAL")
    process.terminate()
    assert process.wait(10.0) == 0


@pytest.mark.parametrize("arguments, message", [
    (["--count", "2", "--address", "255.255.255.255"], "there are not 2 addresses"),
    (["--count", "2", "--address", "::1"], "needs an IPv4 address"),
    (["--count", "0"], "--count"),
    (["--ports", "rtde=99999"], "0..65535"),
])
def test_refused_options_are_named(arguments, message):
    result = subprocess.run([PROGRAM, *arguments], env=run_environment(LAYOUT), capture_output=True, text=True, timeout=30)
    assert result.returncode != 0
    assert message in result.stdout + result.stderr
