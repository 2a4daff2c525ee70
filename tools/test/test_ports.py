"""Ports of a simulated controller: whether they are free, and which process uses them."""

import errno
import os
import socket
import subprocess
import sys

import pytest
from ur_tools import console, ports, simulation
from ur_tools.layout import ROOT, Layout
from ur_tools.processes import Programs

ADDRESS = os.environ.get("UR_TEST_ADDRESS", "127.0.1.201")

LISTENER = """
import socket, sys
listener = socket.socket()
listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
listener.bind((sys.argv[1], int(sys.argv[2])))
listener.listen()
print("listening", flush=True)
sys.stdin.readline()
"""


@pytest.fixture
def listening():
    """Returns a function that starts a process that listens on a port and returns its process id."""
    started = []

    def start(address, port):
        process = subprocess.Popen([sys.executable, "-c", LISTENER, address, str(port)], stdin=subprocess.PIPE,
                                   stdout=subprocess.PIPE, text=True)
        started.append(process)
        assert process.stdout.readline() == "listening\n"
        return process.pid

    yield start
    for process in started:
        process.communicate("\n", timeout=20.0)


def test_free_ports_are_reported_as_free_repeatedly():
    for _unused in range(2):
        assert ports.in_use(ADDRESS, list(ports.PORTS.values())) == []
    ports.check(ADDRESS)


def test_a_port_in_use_is_reported_with_its_process_and_another_address(listening):
    pid = listening(ADDRESS, 30001)
    assert ports.in_use(ADDRESS, [29999, 30001]) == [30001]
    assert ports.holder(ADDRESS, 30001)[0] == pid
    with pytest.raises(console.Failure) as failure:
        ports.check(ADDRESS)
    text = str(failure.value)
    assert text.startswith(f"port 30001 (primary) of {ADDRESS}: in use by process {pid}: {sys.executable} -c")
    other = text.rsplit("--address ", 1)[1]
    assert other != ADDRESS and ports.in_use(other, list(ports.PORTS.values())) == []


def test_a_program_on_any_port_of_a_controller_is_reported_except_where_privileges_are_needed(listening, monkeypatch):
    listening(ADDRESS, 30020)
    with pytest.raises(console.Failure, match="port 30020 .interpreter."):
        ports.check(ADDRESS)

    class WithoutPrivileges(socket.socket):
        def bind(self, address):
            raise PermissionError(errno.EACCES, "Permission denied")

    monkeypatch.setattr(ports.socket, "socket", WithoutPrivileges)
    assert ports.in_use(ADDRESS, [ports.PORTS["MODBUS"]]) == []  # the simulator starts without it
    with pytest.raises(console.Failure, match="port 30001 .* cannot be opened"):
        ports.in_use(ADDRESS, [30001])


def test_a_listener_on_all_addresses_occupies_the_port(listening):
    port = 30098  # not used by a controller: simulators of other tests are running
    pid = listening("0.0.0.0", port)
    assert ports.in_use(ADDRESS, [port]) == [port]
    assert ports.holder(ADDRESS, port)[0] == pid


def test_a_listener_on_another_address_is_ignored(listening):
    listening("127.0.2.1", 30001)
    assert ports.in_use(ADDRESS, [30001]) == []


def test_a_connection_in_time_wait_is_ignored():
    """The simulator can reuse a port in TIME_WAIT."""
    listener = socket.create_server((ADDRESS, 30001), reuse_port=False)
    client = socket.create_connection((ADDRESS, 30001))
    server, _ = listener.accept()
    server.close()
    listener.close()
    assert client.recv(1) == b""
    client.close()
    assert ports.in_use(ADDRESS, [30001]) == []


def test_an_address_of_another_machine_is_rejected():
    for address, text in (("robot", "not an IPv4 address"), ("192.0.2.1", "no network interface")):
        with pytest.raises(console.Failure, match=text):
            ports.check(address)


def test_a_process_of_another_user_is_reported_without_its_name(monkeypatch):
    monkeypatch.setattr(ports, "holder", lambda *_: None)
    assert ports.explain(ADDRESS, [30001, 30002]) == (
        f"ports 30001 (primary), 30002 (secondary) of {ADDRESS}: in use by a process of another user")


def test_a_simulator_that_fails_to_start_is_reported_despite_another_on_the_address(listening, tmp_path, monkeypatch):
    listening(ADDRESS, ports.PORTS["dashboard"])
    failing = tmp_path / "simulator"
    failing.write_text("#!/bin/sh\necho port 29999 is in use by another process\nexit 1\n")
    failing.chmod(0o755)
    monkeypatch.setattr(simulation, "program", lambda *_: failing)
    with Programs(tmp_path) as programs, pytest.raises(console.Failure, match="port 29999 is in use"):
        simulation.start_simulator(programs, Layout.of_environment(), dict(os.environ), ADDRESS, "ur10e")


# --- Checks before the build -----------------------------------------------------------------------------------------------


def test_ports_in_use_are_reported_before_the_build(listening, run_without_build):
    pid = listening(ADDRESS, 29999)
    for command in (["demo", "--output", ROOT], ["bench"], ["chaos"]):
        code, text = run_without_build(*command, "--address", ADDRESS)
        assert code == 1 and f"in use by process {pid}" in text and "--address" in text, text


def test_invalid_arguments_of_the_demo_are_rejected_before_the_build(run_without_build):
    for arguments, expected, text in ((["--output", "/proc/new"], 1, "--output /proc/new: the folder cannot be written"),
                                      (["--output", "/proc"], 1, "cannot be written"),
                                      (["--speed", "1"], 2, "--speed 1: must be from 0.01 to 0.25"),
                                      (["--threshold", "1000"], 2, "--threshold 1000: must be from 5 to 100"),
                                      (["--model", "ur99"], 2, "invalid choice: 'ur99'"),
                                      (["--address", "192.0.2.1"], 1, "no network interface")):
        code, printed = run_without_build("demo", "--address", ADDRESS, *arguments)
        assert code == expected and text in printed, (arguments, printed)
