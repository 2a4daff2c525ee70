"""Counts the lines of each command, from its class to UR_ROS_RTDE_EXPORT, without comments and empty lines."""

import pathlib
import re
import statistics
from dataclasses import dataclass
from typing import Dict, List

from .layout import ROOT

SOURCES = ROOT / "ur_ros_rtde_commands" / "src"
COMMAND_TARGET = 25
DASHBOARD_TARGET = 8

_CLASS = re.compile(r"^(?:template\b.*|class \w+)", re.M)
_EXPORT = re.compile(r"^UR_ROS_RTDE_EXPORT\(\w+, \"([^\"]+)\"\)$", re.M)


@dataclass
class Command:
    name: str
    lines: float
    group: str
    target: int


def measure(text: str) -> "Dict[str, float]":
    """Returns the lines of each command that a source file exports. Several commands share the lines of a file evenly."""
    exports = list(_EXPORT.finditer(text))
    begin = _CLASS.search(text)
    if not exports or not begin:
        return {}
    body = re.sub(r"/\*.*?\*/|//[^\n]*", "", text[begin.start():exports[-1].end()], flags=re.S)
    lines = sum(1 for line in body.splitlines() if line.strip())
    return {export.group(1): lines / len(exports) for export in exports}


def commands(sources: pathlib.Path = SOURCES) -> List[Command]:
    found = []
    for file in sorted([*sources.glob("commands/*/*.cpp"), *sources.glob("dashboard/*.cpp")]):
        group = file.parent.name
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
    rows = ["lines of a command, from class to UR_ROS_RTDE_EXPORT:", "    group        count median  longest"]
    groups = sorted({command.group for command in found}, key=lambda group: (group == "dashboard", group))
    for group in groups:
        members = [command for command in found if command.group == group]
        rows.append(_row(group, members, members[0].target))
    others = [command for command in found if command.group != "dashboard"]
    if others:
        rows.append(_row("without dashboard", others, COMMAND_TARGET))
    return "\n".join(rows)
