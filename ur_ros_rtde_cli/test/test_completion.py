"""Completion of command lines: what the program answers, and what bash and zsh make of it."""

import os
import pty
import shutil
import subprocess

import pytest
from programs import find_program
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
    ("ur call /left/move_j '", {DEFAULTS}),
    ("ur call move_j '{j", {"{joint_positions:"}),
    ("ur call move_j '{joint_positions: [0, 0, 0, 0, 0, 0], ", {"{joint_positions: [0, 0, 0, 0, 0, 0], speed:",
                                                                "{joint_positions: [0, 0, 0, 0, 0, 0], acceleration:"}),
    ("ur call move_j '{speed: ", {"{speed: 0.5"}),
    ("ur call nothing '{", set()),
])
def test_completes(tmp_path, line, expected):
    assert set(completions(tmp_path, line)) == expected


def test_completes_the_options_of_the_viewer(tmp_path):
    pytest.importorskip("ur_ros_rtde_viewer")
    assert set(completions(tmp_path, "ur view --rob")) == {"--robot"}
    assert set(completions(tmp_path, "ur view --con")) == {"--control"}


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


@pytest.fixture
def environment():
    programs = os.path.dirname(find_program("ur_ros_rtde_cli", "ur"))
    return {**os.environ, "PATH": programs + os.pathsep + os.environ["PATH"], "TERM": "dumb"}


def test_bash_completes_a_command_line(environment):
    result = subprocess.run(["bash", "-c", PRESS_TAB], env=environment, capture_output=True, text=True)
    assert result.stdout.split() == ["insert_peg"], result.stdout + result.stderr


# Completes LINE in the line editor of zsh, as Tab does.
ZSHRC = r"""
eval "$(ur completion zsh)"
zle-line-init() {
  BUFFER=$LINE CURSOR=$#LINE
  zle complete-word
  print -r -- "$BUFFER" > "$RESULT"
  exit
}
zle -N zle-line-init
"""


@pytest.mark.skipif(shutil.which("zsh") is None, reason="zsh is not installed")
@pytest.mark.parametrize("line, expected", [
    ("ur state --wat", "ur state --watch "),
    ("ur call insert_p", "ur call insert_peg "),
    ("ur call move_j '", f"ur call move_j '{DEFAULTS}"),
    ("ur call move_j '{j", "ur call move_j '{joint_positions: "),
    ('ur call move_j "{joint_positions: [0, 0, 0, 0, 0, 0], s', 'ur call move_j "{joint_positions: [0, 0, 0, 0, 0, 0], speed: '),
    ("ur call move_j '{speed: ", "ur call move_j '{speed: 0.5"),
])
def test_zsh_completes_a_command_line(tmp_path, environment, line, expected):
    (tmp_path / ".zshrc").write_text(ZSHRC)
    result = tmp_path / "result"
    terminal, end = pty.openpty()
    environment.update(ZDOTDIR=str(tmp_path), LINE=line, RESULT=str(result))
    subprocess.run(["zsh", "-d", "-i"], stdin=end, stdout=end, stderr=end, env=environment, start_new_session=True, timeout=60)
    os.close(end)
    os.close(terminal)
    assert result.read_text().removesuffix("\n") == expected
