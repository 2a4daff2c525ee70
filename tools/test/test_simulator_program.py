"""The program ur_simulator: several robots in one process, and refused options."""

import contextlib
import json
import os
import re
import socket
import subprocess

import pytest
from ur_tools.environment import program, run_environment
from ur_tools.layout import ROOT, Layout

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


@contextlib.contextmanager
def running(*options):
    with subprocess.Popen([PROGRAM, "--address", ADDRESSES[0], *options], env=run_environment(LAYOUT), stdout=subprocess.PIPE,
                          text=True) as process:
        try:
            yield process
        finally:
            process.terminate()


@pytest.fixture
def ten_robots():
    with running("--count", "10") as process:
        yield process, [process.stdout.readline() for _ in ADDRESSES]


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


@pytest.mark.parametrize("address, reachable", [("0.0.0.0", True), (ADDRESSES[0], False)])
def test_an_address_that_other_hosts_reach_is_announced(address, reachable):
    free_ports = ",".join(f"{name}=0" for name in (
        "primary", "secondary", "realtime", "primary_read_only", "secondary_read_only", "realtime_read_only", "interpreter", "rtde", "dashboard", "control"))
    with subprocess.Popen([PROGRAM, "--address", address, "--ports", free_ports], env=run_environment(LAYOUT), stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline().startswith(f"ready: ur10e on {address}, ")
        process.terminate()
        warning = process.stderr.read()
    assert ("every client can run programs" in warning) == reachable


def documented_world_file():
    section = (ROOT / "docs" / "simulator.md").read_text().split("## World files")[1]
    return re.search(r"```yaml\n(.*?)```", section, re.S).group(1)


def test_the_documented_world_file_runs(tmp_path):
    file = tmp_path / "cell.yaml"
    file.write_text(documented_world_file())
    with running("--world", str(file)) as process:
        assert process.stdout.readline().startswith("ready: ")
        state = state_of(ADDRESSES[0])
        assert len(state["surfaces"]) == len(state["boxes"]) == len(state["springs"]) == 1
        while state["timestamp"] < 2.1:
            state = state_of(ADDRESSES[0])
        log = control(ADDRESSES[0], command="log")["entries"]
    assert state["io"]["digital_inputs"] == 8 and state["safety_mode"] == "PROTECTIVE_STOP"
    assert 0.05 < state["actual"]["position"][0] <= 0.2 + 1e-3
    times = {entry["text"].rsplit(": ", 1)[1]: entry["timestamp"] for entry in log if entry["source"] == "world"}
    assert times == pytest.approx({"push": 0.2, "set_digital_input": 0.5, "run_script": 1.0, "drop_links": 1.5, "protective_stop": 2.0})


def test_an_invalid_world_file_is_refused(tmp_path):
    file = tmp_path / "cell.yaml"
    file.write_text("boxes:\n  - center: [0, 0, 0]\n    size: [0.4, 0.3, -0.3]\n")
    result = subprocess.run([PROGRAM, "--world", str(file)], env=run_environment(LAYOUT), capture_output=True, text=True, timeout=30)
    assert result.returncode == 1
    assert result.stderr == f"ur_simulator: {file}:3: field 'size[2]' is -0.3: it must be between 0.001 and 20\n"
