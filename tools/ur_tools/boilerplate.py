"""Counts the source lines of each command, without comments and empty lines.

A command is a class that UR_ROS_RTDE_EXPORT exports, or one EXPORT_DASHBOARD_COMMAND(...).
"""

import pathlib
import re
import statistics
from dataclasses import dataclass
from typing import Dict, List

from .layout import ROOT

SOURCES = ROOT / "ur_ros_rtde_commands" / "src"
COMMAND_TARGET = 25
DASHBOARD_TARGET = 8

_BEGIN = re.compile(r"^(?:template\b|class \w|EXPORT_DASHBOARD_COMMAND\()", re.M)
_EXPORT = re.compile(r"^(?:UR_ROS_RTDE_EXPORT|EXPORT_DASHBOARD_COMMAND)\(\s*\w+, \"([^\"]+)\".*?\)$", re.M | re.S)


@dataclass
class Command:
    name: str
    lines: float
    group: str
    target: int


def measure(text: str) -> "Dict[str, float]":
    """The lines of each command that a source file exports: the lines of the file divided evenly among its commands."""
    exports = list(_EXPORT.finditer(text))
    begin = _BEGIN.search(text)
    if not exports or not begin:
        return {}
    body = re.sub(r"/\*.*?\*/|//[^\n]*", "", text[begin.start():exports[-1].end()], flags=re.S)
    lines = sum(1 for line in body.splitlines() if line.strip())
    return {export.group(1): lines / len(exports) for export in exports}


def commands(sources: pathlib.Path = SOURCES) -> List[Command]:
    found = []
    for file in sorted(sources.glob("*/**/*.cpp")):
        group = file.relative_to(sources).parts[0]
        target = DASHBOARD_TARGET if group == "dashboard" else COMMAND_TARGET
        found += [Command(name, lines, group, target) for name, lines in measure(file.read_text()).items()]
    return found


def _row(group: str, members: List[Command], target: int) -> str:
    lines = [command.lines for command in members]
    longest = max(members, key=lambda command: command.lines)
    return (f"    {group:12} {len(members):4} {statistics.median(lines):7.0f} {max(lines):8.0f}  {longest.name:32}"
            f" {sum(1 for value in lines if value > target):4} above {target}")


def table() -> str:
    found = commands()
    rows = ["source lines of each command:", "    group        count median  longest"]
    groups = sorted({command.group for command in found}, key=lambda group: (group == "dashboard", group))
    for group in groups:
        members = [command for command in found if command.group == group]
        rows.append(_row(group, members, members[0].target))
    others = [command for command in found if command.group != "dashboard"]
    if others:
        rows.append(_row("all but dashboard", others, COMMAND_TARGET))
    return "\n".join(rows)
