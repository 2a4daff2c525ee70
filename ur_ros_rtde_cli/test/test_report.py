"""`ur doctor --report`: what it contains, what it leaves out, and that it is shown before it is written."""

import os
import pathlib
import pty
import subprocess

import pytest
from programs import Process, find_program
from robot_fixtures import simulated_robot
from support import TIMEOUT_FACTOR, wait_for
from ur_program import EMPTY_DOMAIN
from ur_ros_rtde_cli import report

LIMIT = 60.0  # s


@pytest.fixture(scope="module")
def logs(tmp_path_factory):
    return tmp_path_factory.mktemp("logs")


@pytest.fixture(scope="module")
def running(logs):
    with simulated_robot("ur_type:=ur10e", env={"ROS_LOG_DIR": str(logs)}) as simulator:
        yield simulator


def sections(text):
    """Returns the content of each section by its title."""
    title, *parts = text.split("\n## ")
    assert title.startswith("# Report of ur_ros_rtde")
    return {part.partition("\n")[0]: part.partition("```\n")[2].rpartition("\n```")[0] for part in parts}


def test_the_report_has_versions_parameters_state_checks_and_logs(running, logs, tmp_path):
    file = tmp_path / "report.md"
    wait_for(lambda: any("the robot is ready" in log.read_text() for log in logs.glob("driver_*.log")), LIMIT, "the log to be written")
    # The driver has a log folder of its own, as that of the demo.
    process = Process([find_program("ur_ros_rtde_cli", "ur"), "doctor", "--report", str(file), "--yes"])
    assert process.wait(LIMIT) == 0, process.output()
    found = sections(file.read_text())
    assert list(found) == ["Versions", "Environment", "Nodes and parameters", "State", "Diagnostics", "Robot and network", "Log"]
    assert "ur_ros_rtde 0." in found["Versions"] and "rmw_" in found["Versions"] and "kernel" in found["Versions"]
    assert "ROS_DOMAIN_ID=" in found["Environment"]
    assert {"/command_server", "/dashboard_server", "/robot_state_receiver"} <= set(found["Nodes and parameters"].splitlines())
    assert f"    robot_ip: {running.address}" in found["Nodes and parameters"] and "no answer" not in found["Nodes and parameters"]
    assert "elbow_joint" in found["State"] and "RUNNING" in found["State"]
    assert "command_server" in found["Diagnostics"]
    assert "OK       model " in found["Robot and network"] and "latency" in found["Robot and network"]
    assert "the robot is ready" in found["Log"]


def test_without_a_driver_the_report_says_so(tmp_path):
    file = tmp_path / "report.md"
    env = {"ROS_LOG_DIR": str(tmp_path), "ROS_DOMAIN_ID": EMPTY_DOMAIN}
    process = Process([find_program("ur_ros_rtde_cli", "ur"), "doctor", "--report", str(file), "--yes"], env)
    assert process.wait(LIMIT) == 0, process.output()
    found = sections(file.read_text())
    assert "no node of the driver was found" in found["Nodes and parameters"] and found["State"] == "no joint_states"
    assert "no address" in found["Robot and network"] and "no log of the driver" in found["Log"]


@pytest.mark.parametrize("answer, status", [("n", 1), ("y", 0)])
def test_on_a_terminal_the_user_decides_after_reading(running, tmp_path, answer, status):
    file, shown = tmp_path / "report.md", tmp_path / "shown"
    terminal, end = pty.openpty()
    with shown.open("w") as output:
        process = subprocess.Popen([find_program("ur_ros_rtde_cli", "ur"), "doctor", "--report", str(file)], stdin=end, stdout=output,
                                   stderr=output)
    os.close(end)
    wait_for(lambda: "[y/N]" in shown.read_text(), LIMIT, "the question")
    assert "## Log" in shown.read_text() and not file.exists()
    os.write(terminal, f"{answer}\n".encode())
    assert process.wait(TIMEOUT_FACTOR * LIMIT) == status
    os.close(terminal)
    assert file.exists() == (status == 0)


def test_without_a_terminal_nothing_is_written_without_yes(tmp_path):
    file = tmp_path / "report.md"
    result = subprocess.run([find_program("ur_ros_rtde_cli", "ur"), "doctor", "--report", str(file)], stdin=subprocess.DEVNULL,
                            capture_output=True, text=True, timeout=TIMEOUT_FACTOR * LIMIT,
                            env={**os.environ, "ROS_DOMAIN_ID": EMPTY_DOMAIN})
    assert result.returncode == 2 and "--yes" in result.stderr and not file.exists()
    assert "## Versions" in result.stdout


def test_a_missing_folder_is_named_before_anything_is_collected(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(report, "collect", lambda *_: pytest.fail("collected"))
    file = tmp_path / "none" / "report.md"
    with pytest.raises(report.CliError, match="none is no folder"):
        report.run(file, "", "", True)


def test_private_data_are_replaced_equal_ones_by_equal_words(monkeypatch):
    monkeypatch.setattr(report.socket, "gethostname", lambda: "workcell7")
    monkeypatch.setattr(report, "_user", lambda: "jane")
    home = pathlib.Path.home()
    text = (f"{home}/run.csv on workcell7 by jane: 192.168.56.101 and 10.0.0.7, again 192.168.56.101:30004, "
            "ur_stop_192.168.56.101_FAULT, 127.0.0.1, 00:1b:21:aa:bb:cc, serial number 20235501234; 0.0.0.0; janet, version 5.25.1")
    assert report.without_private_data(text) == (
        "~/run.csv on <host> by <user>: <address 1> and <address 2>, again <address 1>:30004, "
        "ur_stop_<address 1>_FAULT, 127.0.0.1, <MAC address 1>, serial number <serial number 1>; 0.0.0.0; janet, version 5.25.1")


def test_names_of_robots_and_addresses_of_ipv6_are_replaced():
    text = ("robot_ip: ur5e-left.lab, ur_stop_ur5e-left.lab_FAULT, "
            "tcp://ur5e-left.lab:30004, fe80::1ff:fe23:4567:890a at 12:30:04, ::1, std::vector, "
            "[2001:db8::7]:29999 and fe80::1ff:fe23:4567:890a")
    assert report.without_private_data(text, ["ur5e-left.lab", "192.168.1.2", ""]) == (
        "robot_ip: <robot>, ur_stop_<robot>_FAULT, tcp://<robot>:30004, <IPv6 address 1> at 12:30:04, ::1, std::vector, "
        "[<IPv6 address 2>]:29999 and <IPv6 address 1>")
