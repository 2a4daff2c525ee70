"""./ur doctor: its findings, advice and exit status."""

import os
import pathlib
import socket
import stat
import subprocess
import sys

import pytest
from ur_tools import build, console, disk, doctor, machine, system_packages, venv
from ur_tools.layout import INSTALLED, ROOT, Layout

ADDRESS = os.environ.get("UR_TEST_ADDRESS", "127.0.1.201")


def make_compiler(folder, lines):
    path = folder / "make_compiler"
    path.write_text("#!/bin/sh\n" + lines)
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return str(path)


def test_this_machine_can_build_and_run():
    result = subprocess.run([sys.executable, str(ROOT / "ur"), "doctor"], capture_output=True, text=True, timeout=60)
    assert result.returncode == 0, result.stdout + result.stderr
    for what in ("checkout", "compiler", "system packages", "Python", "disk", "memory", "ports", "loopback", "time jitter"):
        assert len([line for line in result.stdout.splitlines() if f" {what} " in line]) == 1, result.stdout
    assert result.stdout.splitlines()[-1] == "This machine can build and run everything."


def test_the_exit_status_is_1_if_a_check_fails(monkeypatch, capsys):
    monkeypatch.setattr(doctor, "compiler", lambda: doctor.Finding("compiler", doctor.FAILED, "old", "Install a new one."))
    monkeypatch.setattr(doctor, "CYCLES", 2)
    assert doctor.run(Layout.of_environment()) == 1
    printed = capsys.readouterr().out
    assert "fault   compiler         old\n" + 25 * " " + "Install a new one.\n" in printed
    assert printed.splitlines()[-1] == "1 problem must be solved first."


def test_a_compiler_with_c_plus_plus_20_is_reported_with_its_version():
    found = doctor.compiler()
    assert found.state == doctor.OK and any(character.isdigit() for character in found.text)


def test_a_compiler_without_c_plus_plus_20_fails(tmp_path, monkeypatch):
    monkeypatch.setenv("CXX", make_compiler(tmp_path, 'case "$1" in --version) echo old 7.5;; *) exit 1;; esac\n'))
    found = doctor.compiler()
    assert found.state == doctor.FAILED and found.text == "old 7.5: does not compile C++20" and "CXX=" in found.advice


def test_a_compiler_that_does_not_exist_fails(monkeypatch):
    monkeypatch.setenv("CXX", "/no/such/compiler")
    assert doctor.compiler().state == doctor.FAILED


def test_a_missing_compiler_fails_if_ur_cannot_install_it(monkeypatch):
    monkeypatch.delenv("CXX", raising=False)
    monkeypatch.setattr(doctor.shutil, "which", lambda _: None)
    for allowed, state in ((True, doctor.NOTE), (False, doctor.FAILED)):
        monkeypatch.setattr(doctor, "_may_install", lambda allowed=allowed: allowed)
        assert doctor.compiler().state == state


def test_missing_system_packages_are_reported(monkeypatch):
    monkeypatch.setattr(system_packages, "absent", lambda: ["libfmt-dev"])
    monkeypatch.setattr(doctor.shutil, "which", lambda _: "/usr/bin/dpkg-query")
    for allowed, state, advice in ((True, doctor.NOTE, "./ur installs them"), (False, doctor.FAILED, "sudo apt-get install")):
        monkeypatch.setattr(doctor, "_may_install", lambda allowed=allowed: allowed)
        found = doctor.system()
        assert (found.state, found.text) == (state, "missing: libfmt-dev") and advice in found.advice


def test_a_missing_python_fails_with_the_found_versions(monkeypatch):
    monkeypatch.setattr(venv, "_candidates", lambda: ["/no/such/python"])
    found = doctor.python(Layout("kilted"))
    assert found.state == doctor.FAILED and "need Python 3.10 to 3.12" in found.text and "/no/such/python" in found.advice


def test_the_python_of_an_installed_ros_may_be_newer_than_the_wheels_support(monkeypatch):
    monkeypatch.setattr(venv, "_candidates", list)
    monkeypatch.setattr(venv, "python_of_ros", lambda _: "/usr/bin/python3.14")
    assert doctor.python(Layout(INSTALLED)) == doctor.Finding("Python", doctor.OK, "/usr/bin/python3.14")


def test_a_full_disk_fails(monkeypatch):
    monkeypatch.setattr(disk, "free", lambda _: 1e8)
    found = doctor.free_space(Layout.of_environment())
    assert found.state == doctor.FAILED and found.text.startswith("0.1 GB free")


def test_little_memory_is_reported_with_the_number_of_jobs(monkeypatch):
    monkeypatch.setattr(machine, "memory", lambda: 1.5e9)
    found = doctor.memory()
    assert found.state == doctor.NOTE and "builds with 1 job" in found.text


def test_ports_in_use_are_reported_with_another_address(monkeypatch):
    monkeypatch.setattr(doctor, "DEMO_ADDRESS", ADDRESS)
    with socket.create_server((ADDRESS, 30004)):
        found = doctor.demo_ports()
    assert found.state == doctor.NOTE
    assert f"port 30004 (RTDE) of {ADDRESS}: in use by process {os.getpid()}" in found.text and "--address 127." in found.advice


def test_loopback_addresses_that_cannot_be_used_fail(monkeypatch):
    monkeypatch.setattr(doctor, "TEST_ADDRESSES", ("192.0.2.1",))
    found = doctor.loopback()
    assert found.state == doctor.FAILED and "192.0.2.1" in found.text


def test_a_path_that_is_invalid_in_a_search_path_fails(monkeypatch, tmp_path):
    for folder in ("a:b", "a;b", 'a"b', "a$b"):
        monkeypatch.setattr(doctor, "ROOT", tmp_path / folder)
        assert doctor.checkout().state == doctor.FAILED, folder
        with pytest.raises(console.Failure, match="Move the checkout"):
            build.check_path(pathlib.Path("/a") / folder)
    build.check_path(pathlib.Path("/home of ann/ur driver"))


def test_a_read_only_checkout_fails(monkeypatch):
    monkeypatch.setattr(doctor, "STATE", pathlib.Path("/proc"))
    found = doctor.checkout()
    assert found.state == doctor.FAILED and found.text.startswith("/proc cannot be written")


def test_the_jitter_is_compared_with_the_limits():
    even = [0.1] * 500
    for late, stolen, state, text in ((even, 0.0, doctor.OK, "0.10 ms (median), 0.10 ms (p99), 0.10 ms (max)"),
                                      (even[1:] + [20.0], 0.0, doctor.NOTE, "20.00 ms (max)"),
                                      (even[10:] + [1.0] * 10, 0.0, doctor.NOTE, "1.00 ms (p99)"),
                                      (even, 0.2, doctor.NOTE, "20 % of the processor time goes to other virtual machines")):
        found = doctor.judge_jitter(late, stolen)
        assert found.state == state and text in found.text, found.text


def test_wake_up_latencies_are_measured_against_the_clock(monkeypatch):
    """The clock is 3 ms late in the third cycle."""
    now = [0.0]

    def sleep(seconds):
        sleep.count += 1
        now[0] += seconds + (0.003 if sleep.count == 3 else 0.0)

    sleep.count = 0
    monkeypatch.setattr(doctor.time, "monotonic", lambda: now[0])
    monkeypatch.setattr(doctor.time, "sleep", sleep)
    monkeypatch.setattr(doctor, "CYCLES", 6)
    late = doctor.wake_up_latencies()
    assert late[2] == pytest.approx(3.0) and late[:2] == pytest.approx([0.0, 0.0]) and late[4:] == pytest.approx([0.0, 0.0])
