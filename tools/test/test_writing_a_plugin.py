"""Follows docs/use/writing_a_plugin.md step by step in a temporary workspace. `ur new` writes the packages."""

import os
import re
import shutil
import subprocess

import pytest
from ur_tools.environment import shell_environment
from ur_tools.layout import ROOT, Layout

PAGE = (ROOT / "docs" / "use" / "writing_a_plugin.md").read_text()
BLOCKS = re.findall(r"```bash\n(.*?)```", PAGE, re.S)
BUILD_LIMIT = 1100.0  # s, on two busy cores without a compiler cache: the builds get what other tests leave
LOAD = 0.2  # cores, of everything but the builds
# The builds get the processor time that other tests leave.
LOW_PRIORITY = 'colcon() { nice -n 5 "$(type -P colcon)" "$@"; }\n'
READY = "until ur call get_robot_status --quiet > /dev/null 2>&1; do sleep 0.2; done\n"


def environment(folder):
    env = {**shell_environment(Layout.of_environment()), "ROBOT_IP": os.environ.get("UR_TEST_ADDRESS", "127.0.1.200")}
    if shutil.which("ccache"):  # as in the build of the packages; the folder has another name in each run
        env.update(CMAKE_C_COMPILER_LAUNCHER="ccache", CMAKE_CXX_COMPILER_LAUNCHER="ccache", CCACHE_BASEDIR=str(folder),
                   CCACHE_NOHASHDIR="1")
    return env


@pytest.fixture(scope="module")
def workspace(tmp_path_factory):
    """Returns the folder and the output of each block."""
    folder = tmp_path_factory.mktemp("reader")
    # Job control as in a terminal. The next block begins when the driver is ready.
    script = "set -em\ntrap 'kill %1 %2 2> /dev/null || true' EXIT\n" + LOW_PRIORITY
    for number, block in enumerate(BLOCKS):
        script += f"echo '=== {number}'\n{block}" + (READY if "driver --ros-args" in block else "")
    result = subprocess.run(["bash", "-c", script], cwd=folder, env=environment(folder), stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True, timeout=BUILD_LIMIT)
    print(result.stdout)
    assert result.returncode == 0, result.stdout[-4000:]
    return folder / "my_workspace", re.split(r"^=== \d+\n", result.stdout, flags=re.M)[1:]


def output(workspace, command):
    """Returns the output of the block with this command."""
    return next(text for block, text in zip(BLOCKS, workspace[1]) if command in block)


def test_the_command_moves_the_arm_and_rejects_an_invalid_goal(workspace):
    assert "success: true" in output(workspace, '"{angle: 0.2}"')
    assert "rejected: angle is 7 rad" in output(workspace, '"{angle: 7}"')


def test_the_dashboard_command_shows_a_text_and_queries_the_mode(workspace):
    assert "answer: RUNNING" in output(workspace, "dashboard/tell")


def test_the_extension_runs_on_the_controller(workspace):
    text = output(workspace, "ur call twist")
    position = re.search(r"^ *position: ([-.0-9]+)$", text, re.MULTILINE)
    assert "success: true" in text and position and float(position[1]) == pytest.approx(0.3, abs=1e-3), text


def test_the_written_tests_pass(workspace):
    text = output(workspace, "python3 -m pytest")
    assert re.search(r"\b20 passed\b", text) and "failed" not in text, text


def test_the_new_plugins_are_listed(workspace):
    listed = output(workspace, "ur plugins\n").splitlines()
    for plugin, package, description in (
            ("wag", "my_commands", "Turns wrist 3 by an angle and back"),
            ("twist", "my_extensions", "Turns wrist 3 by an angle, by a program on the controller"),
            ("dashboard/tell", "my_dashboard", "Shows a text on the teach pendant and asks for the robot mode")):
        assert [plugin, package, *description.split()] in [line.split() for line in listed], listed


def test_the_code_on_the_page_matches_the_written_files(workspace):
    codes = re.findall(r"<!-- file: (\S+) -->\n```(?:cpp|python)\n(.*?)```", PAGE, re.S)
    assert codes and [file for file, code in codes if code not in (workspace[0] / file).read_text()] == []
