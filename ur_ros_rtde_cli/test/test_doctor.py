"""`ur doctor --robot` names each fault of a simulated robot."""

import pathlib
import re
import socketserver
import subprocess
import sys
import threading

import pytest
from programs import Process, Simulator, find_program
from support import own_address, wait_for
from ur_ros_rtde_cli.main import main
from ur_ros_rtde_cli.robot_check import host, identity, inputs, link, stream
from ur_ros_rtde_cli.robot_check.checks import Options, RobotCheck
from ur_ros_rtde_cli.robot_check.finding import State
from ur_ros_rtde_cli.robot_check.rtde import Rtde

ADDRESS = own_address()
FOLDER = pathlib.Path(__file__).resolve().parent
PORTS = {"dashboard": (29999, "Dashboard Server"), "primary": (30001, "Primary Client"), "secondary": (30002, "Secondary Client"),
         "realtime": (30003, "Real-Time Client"), "rtde": (30004, "RTDE")}


@pytest.fixture(scope="module")
def started():
    simulator = Simulator(ADDRESS)
    try:
        yield simulator
    finally:
        simulator.stop()


@pytest.fixture
def simulator(started, monkeypatch):
    """The simulator in its state after the start. Pauses of a busy host count as none."""
    for module in (link, stream):
        monkeypatch.setattr(module, "SILENCE_LIMIT", 10.0)
    yield started
    for command, fields in (("accept_connections", {}), ("fieldbus", {"on": False}), ("remote_control", {"on": True}), ("stop_program", {}),
                            ("reduced_mode", {"on": False}), ("speed_slider", {"fraction": 1.0})):
        started.control(command, **fields)
    end_safety_stop(started)
    wait_for(lambda: started.state()["safety_mode"] == "NORMAL", 20.0, "a normal safety mode")
    started.control("power", to="running")


def end_safety_stop(simulator):
    mode = simulator.state()["safety_mode"]
    if mode.endswith("EMERGENCY_STOP"):
        simulator.control("emergency_stop", pressed=False, system=mode.startswith("SYSTEM"))
    elif mode == "SAFEGUARD_STOP":
        simulator.control("safeguard", open=False)
    elif mode in ("VIOLATION", "FAULT"):
        simulator.control("restart_safety")
    elif mode == "PROTECTIVE_STOP":
        wait_for(simulator.unlock_protective_stop, 20.0, "the protective stop to be unlocked")


def check(address=ADDRESS, **options):
    """Returns all findings by subject."""
    found = {}
    for finding in RobotCheck(Options(address, **{"duration": 0.2, "limit": 5.0, **options})).findings():
        found.setdefault(finding.subject, []).append(finding)
    return found


def find(subject, address=ADDRESS, **options):
    """Returns the first finding about the subject, None if there is none. Later checks are not made."""
    checks = RobotCheck(Options(address, **{"duration": 0.2, "limit": 5.0, **options}))
    return next((finding for finding in checks.findings() if finding.subject == subject), None)


def the(findings, subject):
    assert len(findings.get(subject, [])) == 1, findings
    return findings[subject][0]


def test_a_robot_without_faults(simulator):
    findings = check()
    assert all(finding.state is not State.FAULT for found in findings.values() for finding in found), findings
    for subject in ("ports", "version", "model", "calibration", "serial number", "robot mode", "safety", "remote control", "program",
                    "installation", "input registers"):
        assert the(findings, subject).state is State.OK, findings
    assert the(findings, "packet loss").text.startswith("none in ")
    assert simulator.state()["at_rest"] and simulator.state()["robot_mode"] == "RUNNING"


def test_the_program_prints_one_line_for_each_finding(simulator, capsys):
    assert main(["doctor", "--robot", ADDRESS, "--duration", "0.2"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[-1].endswith("; the driver can be started.") and len(lines) > 15
    assert all(re.match(r"(OK|warning|fault) {2,}\w", line) for line in lines[:-1]), lines


def test_the_exit_status_is_1_with_a_fault(simulator):
    simulator.control("remote_control", on=False)
    process = Process([find_program("ur_ros_rtde_cli", "ur"), "doctor", "--robot", ADDRESS, "--duration", "0.2"])
    assert process.wait(60.0) == 1 and process.lines[-1].startswith("1 fault, "), process.output()


def test_without_an_address_it_says_what_can_be_given(monkeypatch, capsys):
    monkeypatch.delenv("UR_CHECKOUT", raising=False)
    assert main(["doctor"]) == 2
    assert "--robot ADDRESS" in capsys.readouterr().err


@pytest.mark.parametrize("arguments, mentions", [(["--robot", "x", "--duration", "nan"], "0.1 to 3600"),
                                                 (["--robot", "x", "--limit", "0"], "0.1 to 3600")])
def test_wrong_arguments_are_refused(arguments, mentions, monkeypatch, capsys):
    monkeypatch.delenv("UR_CHECKOUT", raising=False)
    assert main(["doctor", *arguments]) == 2 and mentions in capsys.readouterr().err


@pytest.mark.parametrize("which", PORTS)
def test_a_disabled_service_is_named(simulator, which):
    simulator.control("refuse_connections", which=which)
    port, service = PORTS[which]
    finding = find("ports")
    assert finding.state is (State.WARNING if which == "secondary" else State.FAULT)
    assert f"port {port} is refused while others are open, so the service {service} is disabled" in finding.text
    assert finding.remedy == "enable it in PolyScope under Settings > Security > Services"


def test_a_controller_that_refuses_all_ports(simulator):
    simulator.control("refuse_connections", which="all")
    findings = check()
    assert list(findings) == ["address"] and "refuses all ports" in the(findings, "address").text


def test_an_address_that_cannot_be_reached():
    finding = the(check("255.255.255.255"), "address")
    assert finding.state is State.FAULT and "cannot be reached" in finding.text


@pytest.mark.parametrize("name", ["nohost.invalid", "999.1.1.1", "a..b"])
def test_a_name_that_cannot_be_resolved(name):
    finding = the(check(name), "address")
    assert finding.state is State.FAULT and f"{name} is neither an IPv4 address nor a host name" in finding.text


@pytest.mark.parametrize("version, model, state, mentions", [
    ("5.99.0", "ur10e", State.WARNING, "is newer than 5.25"), ("3.15.8", "ur5", State.OK, "PolyScope 3.15.8"),
    ("3.3.0", "ur5", State.FAULT, "is older than 3.5"), ("5.5.0", "ur3e", State.OK, "PolyScope 5.5.0")])
def test_versions_of_polyscope(version, model, state, mentions):
    other = Simulator(another_address(), "--polyscope", version, model=model, urcaps=())
    try:
        findings = check(other.address)
        assert the(findings, "version").state is state and mentions in the(findings, "version").text
        assert the(findings, "model").text.startswith(model) and the(findings, "calibration").state is State.OK
        assert the(findings, "remote control").state is (State.OK if model == "ur5" else State.WARNING if version < "5.6" else State.OK)
    finally:
        other.stop()


def another_address():
    first, second, third, last = ADDRESS.split(".")
    return ".".join([first, str(int(second) + 1), third, last])


def test_polyscope_x_is_not_supported():
    finding = identity.judge_version((10, 7, 0, 0))
    assert finding.state is State.FAULT and "PolyScope X has no dashboard server" in finding.text


def test_the_arm_is_another_model(simulator):
    finding = find("model", model="ur5e")
    assert finding.state is State.FAULT and finding.text == "the arm is a ur10e, not a ur5e" and "ur_type:=ur10e" in finding.remedy
    assert find("model", model="ur12e").state is State.OK  # the same arm as a UR10e
    assert identity.judge_model(99, False, "").state is State.WARNING


@pytest.mark.parametrize("command, fields, subject, state, mentions", [
    ("power", {"to": "off"}, "robot mode", State.WARNING, "the arm is powered off"),
    ("emergency_stop", {}, "safety", State.FAULT, "ROBOT_EMERGENCY_STOP"),
    ("emergency_stop", {"system": True}, "safety", State.FAULT, "SYSTEM_EMERGENCY_STOP"),
    ("protective_stop", {"reason": "test"}, "safety", State.FAULT, "PROTECTIVE_STOP"),
    ("safeguard", {}, "safety", State.FAULT, "SAFEGUARD_STOP"),
    ("violation", {"reason": "test"}, "safety", State.FAULT, "VIOLATION"),
    ("fault", {"reason": "test"}, "safety", State.FAULT, "FAULT"),
    ("reduced_mode", {}, "safety", State.WARNING, "REDUCED"),
    ("remote_control", {"on": False}, "remote control", State.FAULT, "local control"),
    ("run_script", {"script": "def busy():\n  while True:\n    sync()\n  end\nend\n"}, "program", State.WARNING, "runs"),
    ("speed_slider", {"fraction": 0.5}, "speed slider", State.WARNING, "at 50 %"),
    ("fieldbus", {}, "input registers", State.FAULT, "fieldbus adapter"),
])
def test_a_state_in_which_the_driver_cannot_work(simulator, command, fields, subject, state, mentions):
    simulator.control(command, **fields)
    finding = wait_for(lambda: (found := find(subject)) and mentions in found.text and found, 10.0, f"a finding about {subject}")
    assert finding.state is state and finding.remedy


def test_another_client_that_controls_the_robot(simulator, capsys):
    with Rtde(ADDRESS, 5.0) as client:
        client.input_types(["input_int_register_0", "speed_slider_mask"])
        assert main(["doctor", "--robot", ADDRESS, "--duration", "0.2"]) == 0
        assert capsys.readouterr().out.splitlines()[-1].endswith("; the robot is in use.")
        findings = check()
        assert "input registers" not in findings
        assert "holds 2 inputs, among them speed_slider_mask" in the(findings, "clients").text
    wait_for(lambda: "clients" not in check(), 10.0, "the inputs to be released")


def test_a_fieldbus_and_a_client_are_both_reported():
    types = {name: "IN_USE" for name in [*inputs.registers(0), "input_int_register_24"]}
    assert [finding.subject for finding in inputs.judge(types)] == ["input registers", "clients"]


def test_a_tool_without_a_payload(simulator):
    simulator.control("run_script", script="def tool():\n  set_tcp(p[0, 0, 0.1, 0, 0, 0])\nend\n")
    wait_for(lambda: find("installation").state is State.WARNING, 10.0, "the TCP")
    simulator.control("run_script", script="def tool():\n  set_tcp(p[0, 0, 0, 0, 0, 0])\nend\n")
    wait_for(lambda: find("installation").state is State.OK, 10.0, "the TCP")


def test_another_robot_than_expected(simulator):
    finding = find("serial number", serial_number="20190000000")
    assert finding.state is State.FAULT and finding.text.endswith(", not 20190000000")
    assert find("serial number", serial_number=find("serial number").text).state is State.OK


class Impostor(socketserver.StreamRequestHandler):
    """Another device with the same address: each second connection reaches it."""

    connections = 0

    def handle(self):
        Impostor.connections += 1
        serial = f"2019000000{Impostor.connections % 2}"
        self.wfile.write(b"Connected: Universal Robots Dashboard Server\n")
        while command := self.rfile.readline():
            self.wfile.write({b"get serial number\n": serial.encode(), b"robotmode\n": b"Robotmode: RUNNING"}.get(command, b"none") + b"\n")


class StrangeServer(socketserver.StreamRequestHandler):
    """A device that is no robot."""

    def handle(self):
        self.wfile.write(b"HTTP/1.1 400 Bad Request\r\n\r\n")


def serve(handler, port):
    socketserver.ThreadingTCPServer.allow_reuse_address = True
    server = socketserver.ThreadingTCPServer((another_address(), port), handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server


def test_two_devices_with_one_address():
    with serve(Impostor, 29999) as server:
        finding = find("address", server.server_address[0])
        server.shutdown()
    assert finding.state is State.FAULT and "two robots answer at this address: `get serial number` gave" in finding.text


class MuteServer(socketserver.StreamRequestHandler):
    """A service that hangs."""

    def handle(self):
        self.rfile.read()


@pytest.mark.parametrize("handler, mentions", [(StrangeServer, ""), (MuteServer, "no answer within 0.3 s")])
@pytest.mark.parametrize("port, subject", [(29999, "dashboard"), (30001, "arm"), (30004, "version")])
def test_a_service_that_does_not_answer_as_a_robot(port, subject, handler, mentions):
    with serve(handler, port) as server:
        finding = find(subject, server.server_address[0], limit=0.3)
        server.shutdown()
    assert finding.state is State.FAULT and finding.text.startswith(f"port {port}: ") and mentions in finding.text


def make_stream(sent, arrived, read=None, answer_time=0.0):
    return stream.Stream(0.002, sent, arrived, read or arrived, answer_time)


def times(count, period=0.002):
    return [1.0 + period * i for i in range(count)]


def judged(*arguments, **options):
    return {finding.subject: finding for finding in stream.judge(make_stream(*arguments, **options))}


def test_lost_packages_are_counted_by_their_time_stamps():
    sent = times(500)[:100] + times(500)[103:]
    assert judged(sent, sent)["packages"].text.startswith("3 of 500 were not sent")
    assert judged(times(500), times(500))["packages"].state is State.OK


def test_a_pause_longer_than_the_silence_limit_is_a_fault():
    arrived = [time + (0.15 if i >= 250 else 0.0) for i, time in enumerate(times(500))]
    assert judged(times(500), arrived)["jitter"].state is State.FAULT


def test_jitter_of_network_and_host_are_distinguished():
    late = [time + (0.004 if i % 10 == 0 else 0.0) for i, time in enumerate(times(500))]
    assert {name: found.state for name, found in judged(times(500), late).items()}["jitter"] is State.WARNING
    found = judged(times(500), times(500), late)
    assert (found["jitter"].state, found["host"].state) == (State.OK, State.WARNING)


def test_a_clock_that_runs_differently():
    assert judged(times(500), times(500, 0.0021))["clock"].state is State.WARNING
    assert judged(times(500), times(500, 0.0020001))["clock"].state is State.OK


@pytest.mark.parametrize("speed, duplex, wireless, state", [("1000", "full", False, State.OK), ("10", "full", False, State.WARNING),
                                                            ("100", "half", False, State.WARNING), ("-1", "unknown", False, State.OK),
                                                            ("", "", True, State.WARNING)])
def test_the_network_card(tmp_path, speed, duplex, wireless, state):
    card = tmp_path / "eth0"
    card.mkdir()
    (card / "speed").write_text(speed)
    (card / "duplex").write_text(duplex)
    if wireless:
        (card / "wireless").mkdir()
    assert link.judge_interface("eth0", tmp_path).state is state
    assert link.interface_of("127.0.0.1") == "lo"


def test_the_settings_of_the_host(tmp_path):
    assert host.judge_kernel("#1 SMP PREEMPT_RT Debian", tmp_path).state is State.OK
    assert host.judge_kernel("#1 SMP PREEMPT_DYNAMIC", tmp_path).state is State.WARNING
    assert host.judge_priority(0, False).state is State.WARNING
    assert host.judge_priority(98, False).state is host.judge_priority(0, True).state is State.OK
    assert host.judge_governor(tmp_path).state is State.OK
    cpu = tmp_path / "sys" / "devices" / "system" / "cpu"
    for number, governor in enumerate(("performance", "powersave")):
        (cpu / f"cpu{number}" / "cpufreq").mkdir(parents=True)
        (cpu / f"cpu{number}" / "cpufreq" / "scaling_governor").write_text(governor + "\n")
    assert host.judge_governor(tmp_path).text.startswith("performance, powersave: ")
    (cpu / "cpu1" / "cpufreq" / "scaling_governor").write_text("performance\n")
    assert host.judge_governor(tmp_path).state is State.OK
    (cpu / "isolated").write_text("2-3\n")
    assert host.judge_cores(tmp_path).text == "2-3 are isolated"
    assert [finding.subject for finding in host.judge()] == ["host kernel", "host priority", "host governor", "host cores"]


def can_emulate_a_link():
    probe = f"import sys; sys.path.insert(0, {str(FOLDER)!r}); import slow_link; slow_link.make_host('10.0.0.1', '10.0.0.2')"
    return subprocess.run([sys.executable, "-c", probe], capture_output=True, timeout=60).returncode == 0


@pytest.mark.skipif(not can_emulate_a_link(), reason="this user may not create network namespaces and TUN devices")
@pytest.mark.parametrize("link_options, expected", [
    (["--drop-every", "50"], "packets came out of order"),  # 2 %
    (["--rate", "2e6"], "the packages of 500 Hz pile up"),
    (["--delay", "0.02"], "warning  latency"),
])
def test_a_bad_link(link_options, expected):
    process = Process([sys.executable, FOLDER / "slow_link.py", *link_options, "--", find_program("ur_simulator", "ur_simulator"),
                       "--address", "10.0.0.1", "--", find_program("ur_ros_rtde_cli", "ur"), "doctor", "--robot", "10.0.0.1",
                       "--limit", "10", "--duration", "1"])
    process.wait(60.0)
    assert expected in process.output(), process.output()


def test_the_page_explains_every_finding():
    page = (FOLDER.parents[1] / "docs" / "use" / "doctor.md").read_text()
    sources = "".join(file.read_text() for file in (FOLDER.parent / "ur_ros_rtde_cli" / "robot_check").glob("*.py"))
    subjects = set(re.findall(r"\b(?:ok|warning|fault|report)\(\"([^\"]+)\"", sources))
    assert len(subjects) >= 20 and all(f"| `{subject}` |" in page for subject in subjects), sorted(subjects)
