"""The commands: types and examples from docs/use/commands, error codes from the sources."""

import functools
import pathlib
import re
import shlex
from dataclasses import dataclass
from typing import Any, Dict, Iterator, Set
from xml.etree import ElementTree

import yaml

from .layout import ROOT

_BLOCK = re.compile(r"^```bash\n(.*?)^```", re.M | re.S)
_EXAMPLE = re.compile(r"^(ur call (\S+)(?: .*?)?)\n"
                      r"ros2 action send_goal (?:--feedback )?/\2 (\w+/action/\w+)", re.M | re.S)
_EXPORT = re.compile(r'^\w*EXPORT\w*\(\s*\w+,\s*"([\w/]+)"', re.M)
_INCLUDE = re.compile(r'^#include "([\w/]+)\.hpp"', re.M)
_TRAITS = re.compile(r"CommandTraits traits\(\) const override\s*\{\s*return \{(.*?)\}", re.S)

# Error codes of all commands, and further ones by the kind of command.
_COMMON = {"INVALID_GOAL", "BUSY", "CANCELED", "TIMEOUT", "LINK_LOST", "EXCEPTION", "SHUTDOWN"}
_STATE = {"NOT_READY", "PROTECTIVE_STOP", "EMERGENCY_STOP", "SAFEGUARD_STOP", "PROGRAM_STOPPED", "SAFETY_VIOLATION"}
_BY_KIND: Dict[str, Set[str]] = {
    "motion": {*_STATE, "PREEMPTED", "CLIENT_LOST", "REJECTED_BY_ROBOT", "MODEL_MISMATCH", "ROBOT_IN_USE"},
    "stop": set(),
    "in every state": {"PREEMPTED", "CLIENT_LOST"},
    "other": {"NOT_READY", "CLIENT_LOST", "REJECTED_BY_ROBOT"},
    "dashboard": {"PREEMPTED", "REJECTED_BY_ROBOT", "NOT_SUPPORTED"},
}
# Those of the parts of the driver that a command uses.
_BY_USE = {
    re.compile(r"\breachable(_in)?\(|\bcheck_tcp_target\("): {"UNREACHABLE", "SAFETY_VIOLATION"},
    re.compile(r"\buntil_(joints_|pose_)reached\(|\buntil_at_rest_at_\w+\("): {"NOT_REACHED"},
    re.compile(r"\bpolyscope\("): {"NOT_SUPPORTED"},
    re.compile(r"\banswers_queries\("): _STATE,
    re.compile(r"\bResource::script\b"): {"NOT_SUPPORTED"},
    re.compile(r"\bExtension<"): {"NOT_SUPPORTED"},
    re.compile(r"\bur_ros_rtde_trajectory/cartesian\.hpp"): {"UNREACHABLE", "NOT_SUPPORTED"},
}


@dataclass(frozen=True)
class Command:
    name: str  # "dashboard/load"
    type: str  # "ur_ros_rtde_msgs/action/DashboardText"
    call: str  # 'ur call dashboard/load "{text: wait.urp}"'
    goal: Dict[str, Any]  # of the call


def of_page(page: str) -> Iterator[Command]:
    """Yields the commands of a page of docs/use/commands, each with its first example."""
    for section in re.split(r"^### ", page, flags=re.M)[1:]:
        for block in _BLOCK.findall(section):
            found = _EXAMPLE.search(block)
            if found and section.startswith(f"{found[2]}\n"):
                words = shlex.split(found[1].replace("\\\n", " "))
                yield Command(found[2], found[3], found[1], yaml.safe_load(words[3]) if len(words) > 3 else {})
                break


@functools.lru_cache(maxsize=1)
def descriptions() -> Dict[str, str]:
    """Returns the descriptions of the commands that have one in plugins.xml."""
    files = [*ROOT.glob("ur_ros_rtde_*/plugins.xml"), *ROOT.glob("ur_ros_rtde_*/src/**/*.xml")]
    plugins = (plugin for file in files for plugin in ElementTree.parse(file).iter("class"))
    return {plugin.get("name", ""): text.strip() for plugin in plugins if (text := plugin.findtext("description"))}


@functools.lru_cache(maxsize=1)
def _files() -> Dict[str, pathlib.Path]:
    """Returns the source file of each command by the name of the command."""
    return {name: file for file in ROOT.glob("ur_ros_rtde_*/src/**/*.cpp")
            for name in _EXPORT.findall(file.read_text())}


def _sources(name: str) -> str:
    """Returns the source of a command, followed by those of its package that it includes."""
    first = _files()[name]
    folder = ROOT / first.relative_to(ROOT).parts[0] / "src"
    files = [first]
    for file in files:  # grows
        for included in _INCLUDE.findall(file.read_text()):
            candidates = (path / f"{included}{suffix}"
                          for path in (file.parent, folder) for suffix in (".hpp", ".cpp"))
            files += [found for found in candidates if found.is_file() and found not in files]
    return "\n".join(file.read_text() for file in files)


def _kind(name: str, source: str) -> str:
    """Returns the key in _BY_KIND, which follows from the CommandTraits."""
    found = _TRAITS.search(source)
    traits = found[1] if found else ""
    if name.startswith("dashboard/"):
        return "dashboard"
    if re.search("preempts_all|stops_arm", traits):
        return "stop"
    if "allowed_in_any_state" in traits:
        return "in every state"
    return "other" if re.search("Resource::(none|io)", traits) else "motion"


def error_codes(command: Command, action_file: str) -> Set[str]:
    """Returns the codes of its kind, those in its sources, and all words in capitals of its .action file."""
    source = _sources(command.name)
    codes = _COMMON | _BY_KIND[_kind(command.name, source)]
    codes |= {code.upper() for code in re.findall(r"ErrorCode::(\w+)", source)}
    for used, of_use in _BY_USE.items():
        codes |= of_use if used.search(source) else set()
    return codes | set(re.findall(r"\b[A-Z_]{4,}\b", action_file))
