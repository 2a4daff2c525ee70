"""`./ur` and, in `./ur shell`, `ur` have the same commands."""

import os
import re
import signal
import subprocess
import sys

import pytest
from ur_ros_rtde_cli.main import CHECKOUT_COMMANDS, CHECKOUT_VARIABLE, COMMANDS
from ur_tools import main
from ur_tools.environment import workspace_environment
from ur_tools.layout import ROOT, Layout

BACKGROUND = True
# ./ur with a build that fails the test.
UR = """import sys
from ur_tools import build, main
build.build = lambda _: sys.exit("it builds")
sys.exit(main.main())
"""


def run_outside(*arguments, cwd=ROOT):
    """Runs ./ur in an environment without ROS."""
    env = {name: value for name, value in os.environ.items() if name not in ("AMENT_PREFIX_PATH", CHECKOUT_VARIABLE)}
    return subprocess.run([sys.executable, "-c", UR, *arguments], cwd=cwd, env={**env, "PYTHONPATH": str(ROOT / "tools")},
                          capture_output=True, text=True, timeout=300)


def run_inside(*arguments, cwd=ROOT):
    """Runs ur in the environment of ./ur shell."""
    return subprocess.run(["ur", *arguments], cwd=cwd, env=workspace_environment(Layout.of_environment()), capture_output=True,
                          text=True, timeout=300)


def commands_in(text):
    return set(re.findall(r"^    (\w+)(?:  |$)", text, re.M))


def test_both_show_the_version_without_a_build():
    assert run_outside("--version").stdout == run_inside("--version").stdout == f"ur_ros_rtde {main._version()}\n"


def test_the_locale_need_not_be_utf_8():
    env = {**os.environ, "LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"}
    result = subprocess.run([sys.executable, ROOT / "ur", "tést"], env=env, capture_output=True, encoding="utf-8", timeout=300)
    assert "there is no command tést; did you mean test?" in result.stderr


def test_the_help_lists_the_same_commands():
    expected = {*COMMANDS, *CHECKOUT_COMMANDS}
    for result, name in ((run_outside("--help"), "./ur"), (run_inside("--help"), "ur")):
        assert result.returncode == 0 and f"usage: {name} " in result.stdout, result.stderr
        assert commands_in(result.stdout) == expected
        assert "==SUPPRESS==" not in result.stdout


def test_every_command_has_help_without_a_build():
    for command in {*COMMANDS, *CHECKOUT_COMMANDS} - {"sim"}:  # the program of the build prints that of sim
        result = run_outside(command, "--help")
        assert result.returncode == 0 and "usage: " in result.stdout.lower(), (command, result.stderr)


def test_a_package_is_created_in_the_working_directory(tmp_path):
    for run, package in ((run_inside, "wag_command"), (run_outside, "other_command")):  # run_outside: without a build
        result = run("new", "command", "wag", "--package", package, cwd=tmp_path)
        assert result.returncode == 0 and (tmp_path / package / "package.xml").is_file(), result.stderr


def test_commands_of_the_installed_program_run_from_the_checkout(tmp_path):
    result = run_outside("plugins", "move_l", cwd=tmp_path)
    assert result.returncode == 0 and result.stdout == run_inside("plugins", "move_l").stdout, result.stderr
    assert "move_l_relative" in result.stdout
    result = run_outside("call", "move_j", "--show", "{speed: 2}", cwd=tmp_path)
    assert result.returncode == 0 and "speed: 2.0" in result.stdout, result.stderr


def test_an_unknown_command_is_explained():
    for run in (run_outside, run_inside):
        for command, mentions in (("buidl", "did you mean build?"), ("cal", "did you mean call?"), ("qqq", "demo, test")):
            result = run(command)
            assert result.returncode == 2 and f"there is no command {command}" in result.stderr and mentions in result.stderr, result.stderr


# Half a second after the signal, it prints that it has stopped.
STOPS_LATE = """
import signal, sys, time
def stop(*_):
    time.sleep(0.5)
    sys.exit("stopped")
for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
    signal.signal(number, stop)
print("ready", flush=True)
time.sleep(60)
"""


@pytest.fixture
def in_shell():
    """Returns a function that runs a program with `./ur shell`, without a build, in a process group of its own."""

    def start(*command):
        return subprocess.Popen([sys.executable, "-c", UR.replace('sys.exit("it builds")', "None"), "shell", *command], cwd=ROOT,
                                env={**os.environ, "PYTHONPATH": str(ROOT / "tools")}, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                text=True, start_new_session=True)

    return start


def test_an_unknown_program_for_the_shell_is_named(in_shell):
    process = in_shell("nosuchprogram")
    error = process.communicate(timeout=60)[1]
    assert process.returncode == 1 and "there is no program nosuchprogram" in error and "Errno" not in error


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_program_of_the_shell_handles_signals_itself(in_shell, number):
    process = in_shell("python3", "-c", STOPS_LATE)
    assert process.stdout.readline() == "ready\n"
    os.killpg(process.pid, number)
    assert process.communicate(timeout=60)[1] == "stopped\n" and process.returncode == 1


def test_a_program_of_the_shell_ignores_no_signals(in_shell):
    ignored = ["grep", "SigIgn", "/proc/self/status"]
    assert in_shell(*ignored).communicate(timeout=60)[0] == subprocess.run(ignored, capture_output=True, text=True).stdout


@pytest.mark.parametrize("command, packages", [("plot", ["ur_ros_rtde_cli"]), ("urdf", ["ur_ros_rtde_cli"]), ("call", None)])
def test_without_a_build_a_command_builds_what_it_needs(monkeypatch, tmp_path, command, packages):
    def build(options):
        assert options.packages == packages
        program = options.layout.install / "bin" / "ur"
        program.parent.mkdir(parents=True)
        program.touch()

    monkeypatch.setattr("ur_tools.layout.STATE", tmp_path)
    monkeypatch.setattr(main.building, "build", build)
    monkeypatch.setattr(main, "workspace_environment", lambda _: {})
    monkeypatch.setattr(main.os, "execve", lambda program, arguments, _: sys.exit(arguments[1]))
    with pytest.raises(SystemExit) as started:
        main.main([command])
    assert started.value.code == command


def test_the_shell_keeps_its_build(monkeypatch):
    """In `./ur shell --debug`, commands use the debug build."""
    monkeypatch.setenv("UR_LAYOUT", "jazzy:debug")
    assert main._layout(main._parse(["build"])) == Layout("jazzy", "debug")
