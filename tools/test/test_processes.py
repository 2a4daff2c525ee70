import os
import pathlib
import signal
import subprocess
import sys
import time

import pytest
from ur_tools.console import Failure
from ur_tools.processes import Programs, group_is_alive

# Ignores SIGINT and SIGTERM, as does its child process.
IGNORES_SIGNALS = """
import signal, subprocess, sys, time
for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, signal.SIG_IGN)
child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"])
print("ready", flush=True)
time.sleep(60)
"""
QUICK = ((signal.SIGINT, 0.2), (signal.SIGTERM, 0.2), (signal.SIGKILL, 5.0))


def python(code):
    return [sys.executable, "-c", code]


def test_leaving_the_block_stops_all_programs(tmp_path):
    with Programs(tmp_path) as programs:
        sleeper = programs.start("sleeper", python("import time; print('up', flush=True); time.sleep(60)"))
        programs.wait_until(lambda: "up" in sleeper.output, 10.0, "the sleeper")
    assert not sleeper.running


def test_the_logs_of_ros_are_beside_the_output_unless_the_user_has_chosen_a_folder(tmp_path, monkeypatch):
    """The driver keeps the last 20 stops in the folder of these logs: those of the user's robots must stay."""
    command = python(f"import os, pathlib; pathlib.Path({str(tmp_path / 'folder')!r}).write_text(os.environ['ROS_LOG_DIR'])")
    monkeypatch.delenv("ROS_LOG_DIR", raising=False)
    for folder in (str(tmp_path / "ros"), "/chosen"):
        with Programs(tmp_path) as programs:
            assert programs.run(command, os.environ, 30.0) == 0
            assert (tmp_path / "folder").read_text() == folder
            (tmp_path / "folder").unlink()
            assert programs.start("started", command).process.wait(30.0) == 0
            assert (tmp_path / "folder").read_text() == folder
        monkeypatch.setenv("ROS_LOG_DIR", "/chosen")


def test_an_exception_in_the_block_stops_all_programs(tmp_path):
    with pytest.raises(RuntimeError):
        with Programs(tmp_path) as programs:
            sleeper = programs.start("sleeper", python("import time; time.sleep(60)"))
            raise RuntimeError
    assert not sleeper.running


def test_a_program_that_ignores_signals_is_killed_with_its_children(tmp_path):
    with Programs(tmp_path) as programs:
        stubborn = programs.start("stubborn", python(IGNORES_SIGNALS))
        programs.wait_until(lambda: "ready" in stubborn.output, 10.0, "the program")
        stubborn.stop(QUICK)
        assert not stubborn.running
        assert not group_is_alive(stubborn.process.pid)


def test_waiting_fails_at_once_with_the_log_if_a_program_exits(tmp_path):
    with Programs(tmp_path) as programs:
        programs.start("broken", python("import sys; sys.exit('port 30004 is in use')"))
        start = time.monotonic()
        with pytest.raises(Failure, match="port 30004 is in use"):
            programs.wait_until(lambda: False, 60.0, "nothing")
        assert time.monotonic() - start < 30.0


def test_waiting_fails_at_its_limit(tmp_path):
    with Programs(tmp_path) as programs:
        programs.start("sleeper", python("import time; time.sleep(60)"))
        with pytest.raises(Failure, match="timeout after 0.1 s waiting for the dashboard"):
            programs.wait_until(lambda: False, 0.1, "the dashboard")


def test_a_missing_program_is_reported(tmp_path):
    with Programs(tmp_path) as programs:
        with pytest.raises(Failure, match="ghost cannot be started"):
            programs.start("ghost", [str(tmp_path / "ghost")])


def test_programs_are_stopped_when_the_parent_is_terminated(tmp_path):
    code = f"""
import pathlib, sys, time
sys.path[:0] = {sys.path!r}
from ur_tools.processes import Programs
with Programs(pathlib.Path({str(tmp_path)!r})) as programs:
    child = programs.start("child", [sys.executable, "-c", "import time; time.sleep(60)"])
    print(child.process.pid, flush=True)
    time.sleep(60)
"""
    parent = subprocess.Popen(python(code), stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, universal_newlines=True)
    child = int(parent.stdout.readline())
    assert group_is_alive(child)
    os.kill(parent.pid, signal.SIGTERM)
    parent.wait(20.0)
    assert not group_is_alive(child)


# Ends half a second after SIGINT.
ENDS_LATE = """
import pathlib, sys, time
try:
    pathlib.Path(sys.argv[1], "started").touch()
    time.sleep(60)
except KeyboardInterrupt:
    pathlib.Path(sys.argv[1], "interrupted").touch()
    time.sleep(0.5)
    pathlib.Path(sys.argv[1], "ended").touch()
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("call", ["programs.start('late', command); time.sleep(60)", "programs.run(command, {}, 60.0)"])
def test_a_second_signal_leaves_no_program_running(tmp_path, call, number):
    code = f"""
import pathlib, sys, time
sys.path[:0] = {sys.path!r}
from ur_tools.processes import Programs
command = {[*python(ENDS_LATE), str(tmp_path)]!r}
with Programs(pathlib.Path({str(tmp_path)!r})) as programs:
    {call}
"""
    parent = subprocess.Popen(python(code), stderr=subprocess.DEVNULL)
    wait_for_file(tmp_path / "started")
    parent.send_signal(number)
    wait_for_file(tmp_path / "interrupted")
    parent.send_signal(number)
    parent.wait(20.0)
    assert (tmp_path / "ended").exists()


def test_a_hang_up_that_nohup_ignores_stays_ignored(tmp_path):
    previous = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with Programs(tmp_path) as programs:
            os.kill(os.getpid(), signal.SIGHUP)
            program = programs.start("hangs_up", ["sleep", "60"])
            program.process.send_signal(signal.SIGHUP)
            assert program.process.wait(10.0) == -signal.SIGHUP, "it does not inherit it"
        assert signal.getsignal(signal.SIGHUP) == signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, previous)


def wait_for_file(path: pathlib.Path):
    end = time.monotonic() + 60.0
    while not path.exists():
        assert time.monotonic() < end, path
        time.sleep(0.01)
