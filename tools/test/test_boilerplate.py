"""Limits the length of commands. Longer commands have their own limits, which may only be lowered."""

import statistics

import pytest
from ur_tools import boilerplate

LONG = {
    "execute_cartesian_path": 45,  # plans in two steps: path, then its timing
    "execute_parametrized_trajectory": 40,  # checks a message of another package
    "execute_trajectory": 28,
    "follow_joint_trajectory": 245,  # has other results and tolerances, and does not use the base class
}
SLACK = 10  # lines that an entry of LONG may exceed the length of its command by

COMMANDS = boilerplate.commands()

SOURCE = """
namespace {
int helper();
}
class A : public Command<X> {
  // a comment
  void check() {}

};
UR_ROS_RTDE_EXPORT(A, "a")
"""


def test_lines_are_counted_from_class_to_export_without_comments():
    assert boilerplate.measure(SOURCE) == {"a": 4}


def test_commands_that_share_a_file_share_its_lines():
    assert boilerplate.measure(SOURCE + 'UR_ROS_RTDE_EXPORT(B, "b")\n') == {"a": 2.5, "b": 2.5}


@pytest.mark.parametrize("dashboard, target", [(False, boilerplate.COMMAND_TARGET), (True, boilerplate.DASHBOARD_TARGET)])
def test_the_typical_command_is_short(dashboard, target):
    lines = [command.lines for command in COMMANDS if (command.group == "dashboard") == dashboard]
    assert statistics.median(lines) <= target


def test_only_known_commands_are_long():
    too_long = [f"{command.name}: {command.lines:g} lines, {LONG.get(command.name, command.target)} at most"
                for command in COMMANDS if command.lines > LONG.get(command.name, command.target)]
    assert not too_long, "\n".join(too_long)


def test_the_limits_of_long_commands_are_tight():
    lines = {command.name: command for command in COMMANDS}
    needless = [name for name, most in LONG.items() if name not in lines or lines[name].lines <= lines[name].target
                or lines[name].lines < most - SLACK]
    assert not needless, "remove or lower: " + ", ".join(needless)
