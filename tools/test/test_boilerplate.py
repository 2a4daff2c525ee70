"""Commands are short. LONG lists the exceptions with their limits, which may only be lowered."""

import statistics

from ur_tools import boilerplate

LONG = {
    "execute_cartesian_path": 45,  # plans in two steps: the path, then its timing
    "execute_parametrized_trajectory": 28,
    "execute_trajectory": 28,
    "follow_joint_trajectory": 229,  # MoveIt's action has its own result codes and tolerances
}
SLACK = 10  # lines by which a limit in LONG may exceed the length of its command

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
TABLE = """
EXPORT_DASHBOARD_COMMAND(A, "a", Query, {"a"})
EXPORT_DASHBOARD_COMMAND(
  B, "b", Query, {"b"}, {5, 0})
"""


def test_lines_are_counted_from_class_to_export_without_comments_and_divided_among_the_commands_of_a_file():
    assert boilerplate.measure(SOURCE) == {"a": 4}
    assert boilerplate.measure(SOURCE + 'UR_ROS_RTDE_EXPORT(B, "b")\n') == {"a": 2.5, "b": 2.5}
    assert boilerplate.measure(TABLE) == {"a": 1.5, "b": 1.5}


def test_the_typical_command_is_short():
    for dashboard, target in ((False, boilerplate.COMMAND_TARGET), (True, boilerplate.DASHBOARD_TARGET)):
        lines = [command.lines for command in COMMANDS if (command.group == "dashboard") == dashboard]
        assert statistics.median(lines) <= target


def test_only_known_commands_are_long():
    too_long = [f"{command.name}: {command.lines:g} lines, {LONG.get(command.name, command.target)} at most"
                for command in COMMANDS if command.lines > LONG.get(command.name, command.target)]
    assert not too_long, "\n".join(too_long)


def test_every_exported_plugin_is_found():
    described = sum(file.read_text().count("<class ") for file in boilerplate.SOURCES.glob("*/*_commands.xml"))
    assert len(COMMANDS) == len({command.name for command in COMMANDS}) == described


def test_the_list_of_long_commands_has_no_needless_entries():
    lines = {command.name: command for command in COMMANDS}
    needless = [name for name, most in LONG.items() if name not in lines or lines[name].lines <= lines[name].target
                or lines[name].lines < most - SLACK]
    assert not needless, "remove or lower: " + ", ".join(needless)
