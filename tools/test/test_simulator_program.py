"""The program ur_simulator: several robots in one process, rejected options, client log and status."""

import contextlib
import fcntl
import json
import os
import pty
import re
import select
import socket
import struct
import subprocess
import termios
import time

import pytest
from ur_tools import simulation
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
def running(*options, **arguments):
    with subprocess.Popen([PROGRAM, "--address", ADDRESSES[0], *options], env=run_environment(LAYOUT), stdout=subprocess.PIPE,
                          text=True, **arguments) as process:
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


REJECTED = [
    (["--count", "2", "--address", "255.255.255.255"], "there are not 2 addresses"),
    (["--count", "2", "--address", "::1"], "needs an IPv4 address"),
    (["--count", "0"], "--count"),
    (["--ports", "rtde=99999"], "0..65535"),
    (["--client-log", "/nonexistent/log.mmd"], "client log '/nonexistent/log.mmd' cannot be written (--client-log): No such file"),
    (["--status", "--log"], "give --status alone or with --client-log FILE"),
    (["--status", "--client-log"], "give --status alone or with --client-log FILE"),
]


def test_rejected_options_are_named():
    for arguments, message in REJECTED:
        result = subprocess.run([PROGRAM, *arguments], env=run_environment(LAYOUT), capture_output=True, text=True, timeout=30)
        assert result.returncode == 1 and message in result.stdout + result.stderr, arguments


def test_an_address_that_other_hosts_reach_is_announced():
    free_ports = ",".join(f"{name}=0" for name in (
        "primary", "secondary", "realtime", "primary_read_only", "secondary_read_only", "realtime_read_only", "interpreter", "rtde",
        "dashboard", "modbus", "control"))
    for address, reachable in (("0.0.0.0", True), (ADDRESSES[0], False)):
        with subprocess.Popen([PROGRAM, "--address", address, "--ports", free_ports], env=run_environment(LAYOUT),
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            assert process.stdout.readline().startswith(f"ready: ur10e on {address}, ")
            process.terminate()
            warning = process.stderr.read()
        assert ("every client can run programs" in warning) == reachable, address


def documented_world_file():
    section = (ROOT / "docs" / "use" / "simulator.md").read_text().split("## World files")[1]
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


def test_an_invalid_world_file_is_rejected(tmp_path):
    file = tmp_path / "cell.yaml"
    file.write_text("boxes:\n  - center: [0, 0, 0]\n    size: [0.4, 0.3, -0.3]\n")
    result = subprocess.run([PROGRAM, "--world", str(file)], env=run_environment(LAYOUT), capture_output=True, text=True, timeout=30)
    assert result.returncode == 1
    assert result.stderr == f"ur_simulator: {file}:3: field 'size[2]' is -0.3: it must be between 0.001 and 20\n"


# ---- client log


def wait_for(condition, what, limit=10.0):
    """Polls the condition and returns its first true value."""
    end = time.monotonic() + limit
    while not (value := condition()):
        assert time.monotonic() < end, f"waited {limit} s for {what}"
        time.sleep(0.01)
    return value


def rtde_package(kind, payload=b""):
    return struct.pack(">HB", len(payload) + 3, ord(kind)) + payload


def documented(heading, language):
    section = (ROOT / "docs" / "use" / "simulator.md").read_text().split(f"\n## {heading}\n")[1]
    return re.search(rf"```{language}\n(.*?)```", section, re.S).group(1)


def without_numbers(text):
    """Replaces times, ports and counts of packages, which differ from run to run."""
    text = re.sub(r"\[\d+\.\d{3}\]", "[T]", text)
    text = re.sub(r"connects from [\d.]+:\d+", "connects from ADDRESS", text)
    return re.sub(r"data packages: \d+ sent", "data packages: N sent", text)


def test_the_documented_client_log_is_that_of_its_session(tmp_path):
    file = tmp_path / "log.mmd"
    with running("--client-log", str(file)) as process:
        assert process.stdout.readline().startswith("ready: ")
        wait_for(lambda: "RUNNING" in file.read_text(), "the robot")
        with socket.create_connection((ADDRESSES[0], 29999)) as dashboard, dashboard.makefile("rw") as lines:
            lines.write("robotmode\nquit\n")
            lines.flush()
            assert lines.readlines()[-1] == "Disconnected\n"
        with socket.create_connection((ADDRESSES[0], 30002)) as script:
            script.sendall(b"def greet():\n  textmessage(\"hello\")\nend\n")
            wait_for(lambda: "rejected" in file.read_text(), "the first script")
            script.sendall(b"def greet():\n  textmsg(\"hello\")\nend\n")
            wait_for(lambda: "ended" in file.read_text(), "the second script")
            script.shutdown(socket.SHUT_WR)  # closing would reset the connection, because of unread data
            wait_for(lambda: "secondary client 1-x" in file.read_text(), "the end of the script session")
        with socket.create_connection((ADDRESSES[0], 30004)) as rtde:
            outputs = struct.pack(">d", 500.0) + b"timestamp,actual_q"
            rtde.sendall(rtde_package("V", b"\0\2") + rtde_package("O", outputs) + rtde_package("S"))
            wait_for(lambda: "data packages of" in file.read_text(), "data packages")
            rtde.shutdown(socket.SHUT_WR)
            wait_for(lambda: "data packages: " in file.read_text(), "the end of the RTDE session")
    assert process.wait(10.0) == 0
    assert without_numbers(file.read_text()) == without_numbers(documented("Client log", "mermaid"))


def test_the_client_log_on_the_standard_output_is_a_diagram():
    with running("--quiet", "--client-log", "--count", "2") as process:
        lines = iter(process.stdout.readline, "")
        assert next(lines) == "sequenceDiagram\n"
        assert f"participant robot {ADDRESSES[1]}\n" in lines  # its ports are open
        state_of(ADDRESSES[1])
        line = next(line for line in lines if f"->>robot {ADDRESSES[1]}" in line)
    assert line.startswith(f"control port client 1 of {ADDRESSES[1]}->>robot {ADDRESSES[1]}: [")


def test_a_full_disk_ends_the_client_log_and_not_the_robot():
    with running("--client-log", "/dev/full", stderr=subprocess.PIPE) as process:
        assert process.stdout.readline().startswith("ready: ")
        assert process.stderr.readline() == \
            "ur_simulator: the client log ends: /dev/full cannot be written: No space left on device\n"
        assert state_of(ADDRESSES[0])["robot_mode"] == "RUNNING"
        process.terminate()
        assert process.stderr.read() == ""
    assert process.wait(10.0) == 0


# ---- status


def test_the_status_in_a_pipe_is_a_line_for_each_change():
    with running("--quiet", "--status") as process:
        assert re.fullmatch(rf"\[\d+\.\d{{3}}\] {ADDRESSES[0]}: RUNNING, NORMAL, program STOPPED; no clients; no error\n",
                            process.stdout.readline())
        control(ADDRESSES[0], command="protective_stop", reason="a \x1b test")
        line = process.stdout.readline()
    assert "RUNNING, PROTECTIVE_STOP, program STOPPED" in line
    assert "last error: [" in line and line.endswith("safety: protective stop: a \\x1b test\n")


class Terminal:
    """The simulator on a pseudo-terminal."""

    def __init__(self, *options, columns=200):
        self.file, terminal = pty.openpty()
        fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        self.attributes = termios.tcgetattr(terminal)
        self.process = subprocess.Popen([PROGRAM, "--address", ADDRESSES[0], "--quiet", "--status", *options], stdout=terminal,
                                        env={**run_environment(LAYOUT), "TERM": "xterm"})
        os.close(terminal)
        self.output = ""

    def __enter__(self):
        return self

    def __exit__(self, *_unused):
        self.process.terminate()
        self.process.wait(10.0)
        os.close(self.file)

    def frame(self, text, limit=10.0):
        """Waits for a complete frame with the text, and returns its lines."""
        end = time.monotonic() + limit
        while True:
            frames = [frame for frame in self.output.split("\x1b[J")[:-1] if text in frame]
            if frames:
                return [line.replace("\r", "") for line in frames[-1].split("\x1b[K")[:-1]]
            assert select.select([self.file], [], [], max(0.0, end - time.monotonic()))[0], f"waited for {text!r}"
            self.output += os.read(self.file, 65536).decode().replace("\r\n", "")


def test_the_status_on_a_terminal_is_redrawn_in_place():
    with Terminal() as terminal:
        terminal.frame("program STOPPED")
        with socket.create_connection((ADDRESSES[0], 29999)) as dashboard:
            dashboard.recv(100)
            control(ADDRESSES[0], command="run_script", script="def wait_forever():\n  while True:\n    sync()\n  end\nend\n")
            control(ADDRESSES[0], command="run_script", script="textmessage(\"hello\")\n")
            terminal.frame("dashboard 1")
            lines = terminal.frame("textmessage")
        assert "\x1b[4A" in terminal.output
        frame = [re.sub(r"\x1b\[\d+A", "", line) for line in lines]
        terminal.process.terminate()
        assert terminal.process.wait(10.0) == 0
        assert termios.tcgetattr(terminal.file) == terminal.attributes
    expected = documented("Status", "text").splitlines()

    def numbers_replaced(line):
        return re.sub(r" *-?\d+(\.\d+)*", " N", line)
    assert [numbers_replaced(line) for line in frame] == [numbers_replaced(line) for line in expected]


def test_ten_robots_have_a_status_of_one_line_each():
    with Terminal("--count", "10", columns=60) as terminal:
        lines = terminal.frame(ADDRESSES[9])
    assert len(lines) == 10
    for address, line in zip(ADDRESSES, lines):
        assert re.sub(r"^\x1b\[\d+A", "", line).startswith(f"{address}: RUNNING, NORMAL, program STOPPED; ")
        assert len(re.sub(r"^\x1b\[\d+A", "", line)) == 59


def test_ur_sim_shows_the_status_on_a_terminal():
    assert simulation.with_status(["--model", "ur5e"], True) == ["--model", "ur5e", "--status"]
    for arguments, terminal in ((["--model", "ur5e"], False), (["--log"], True), (["--client-log=log.mmd"], True)):
        assert simulation.with_status(arguments, terminal) == arguments
