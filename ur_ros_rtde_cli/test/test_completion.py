"""Completion of command lines, as bash asks for it."""

import os
import subprocess

import pytest
from support import find_program
from ur_ros_rtde_cli.main import CHECKOUT_VARIABLE

BACKGROUND = True
DEFAULTS = "{joint_positions: [], speed: 0.5, acceleration: 1.0}"


def completions(tmp_path, line):
    file = tmp_path / "completions"
    file.write_text("")
    asked = {CHECKOUT_VARIABLE: "", "_ARGCOMPLETE": "1", "_ARGCOMPLETE_STDOUT_FILENAME": str(file),
             "COMP_LINE": line, "COMP_POINT": str(len(line)),
             "_ARGCOMPLETE_IFS": "\n", "COMP_TYPE": "9", "_ARGCOMPLETE_COMP_WORDBREAKS": ""}
    result = subprocess.run([find_program("ur_ros_rtde_cli", "ur")], env={**os.environ, **asked}, capture_output=True, text=True)
    assert "Traceback" not in result.stderr, result.stderr
    return [text.strip() for text in file.read_text().split("\n") if text.strip()]


@pytest.mark.parametrize("line, expected", [
    ("ur pl", {"plugins", "plot"}),
    ("ur call move_j", {"move_j", "move_j_ik", "move_j_relative"}),
    ("ur call dashboard/power_o", {"dashboard/power_on", "dashboard/power_off"}),
    ("ur state --wa", {"--watch", "--wait"}),
    ("ur call move_j --j", {"--json"}),
    ("ur call move_j '", {DEFAULTS}),
    ("ur call move_j '{j", {"{joint_positions:"}),
    ("ur call move_j '{joint_positions: [0, 0, 0, 0, 0, 0], ", {"{joint_positions: [0, 0, 0, 0, 0, 0], speed:",
                                                                "{joint_positions: [0, 0, 0, 0, 0, 0], acceleration:"}),
    ("ur call move_j '{speed: ", {"{speed: 0.5"}),
    ("ur call nothing '{", set()),
])
def test_completes(tmp_path, line, expected):
    assert set(completions(tmp_path, line)) == expected


@pytest.mark.parametrize("shell", ["bash", "zsh"])
def test_prints_the_code_for_the_shell(shell):
    command = [find_program("ur_ros_rtde_cli", "ur"), "completion", shell]
    printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert "_ARGCOMPLETE=1" in printed and "./ur" in printed and ("bashcompinit" in printed) == (shell == "zsh")


# What bash does when Tab is pressed: it calls the function that `complete` has registered.
PRESS_TAB = r"""
eval "$(ur completion bash)"
COMP_WORDS=(ur call insert_p) COMP_CWORD=2 COMP_LINE="ur call insert_p" COMP_POINT=16 COMP_TYPE=9
function=$(complete -p ur | sed 's/.*-F \([^ ]*\) .*/\1/')
$function ur insert_p call
echo "${COMPREPLY[@]}"
"""


def test_bash_completes_a_command_line():
    env = {**os.environ, "PATH": os.path.dirname(find_program("ur_ros_rtde_cli", "ur")) + os.pathsep + os.environ["PATH"]}
    result = subprocess.run(["bash", "-c", PRESS_TAB], env=env, capture_output=True, text=True)
    assert result.stdout.split() == ["insert_peg"], result.stdout + result.stderr
