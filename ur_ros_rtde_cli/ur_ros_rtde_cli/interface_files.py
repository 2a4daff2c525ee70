"""Reads the comments of installed .action and .msg files, which state the size, unit and range of each field.

A comment precedes its field or follows it on the same line.
"""

import os
import pathlib
import re
from dataclasses import dataclass
from typing import Dict, List, Optional

_FIELD = re.compile(r"([\w/]+(?:<=\d+)?(?:\[[^\]]*\])?)\s+(\w+)\b(?!\s*=)\s*([^#]*?)\s*(?:#\s*(.*))?$")
_CONSTANT = re.compile(r"([\w/]+)\s+([A-Z]\w*)\s*=\s*([^#]*?)\s*(?:#\s*(.*))?$")


@dataclass
class Field:
    type: str  # "float64[]"
    name: str
    comment: str
    default: str = ""


@dataclass(frozen=True)
class Constant:
    name: str
    value: str
    comment: str


def prefixes() -> List[str]:
    return os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)


def find(name: str) -> pathlib.Path:
    """Returns the installed file of an interface such as "ur_ros_rtde_msgs/action/MoveJ". Raises FileNotFoundError."""
    package, folder, message = name.split("/")
    for prefix in prefixes():
        file = pathlib.Path(prefix, "share", package, folder, f"{message}.{folder}")
        if file.is_file():
            return file
    raise FileNotFoundError(f"{name} is in no prefix of AMENT_PREFIX_PATH")


def header_name(kind: str) -> str:
    """Returns the name that rosidl gives the header of an interface: "move_jik" for "MoveJIK"."""
    return re.sub("([a-z0-9])([A-Z])", r"\1_\2", re.sub("(.)([A-Z][a-z]+)", r"\1_\2", kind)).lower()


def parse(file: pathlib.Path) -> List[List[Field]]:
    """Returns the sections of an interface file, each as a list of Fields."""
    parts: List[List[Field]] = [[]]
    above: List[str] = []  # the comment lines directly above a field
    for line in file.read_text().splitlines():
        found = _FIELD.match(line)
        if line.startswith("#"):
            above.append(line.strip("# "))
            continue
        if line.strip() == "---":
            parts.append([])
        elif found:
            comment = " ".join(filter(None, [*above, (found.group(4) or "").strip()]))
            parts[-1].append(Field(found.group(1), found.group(2), comment, found.group(3)))
        above = []
    return parts


def fields(name: str, part: int = 0) -> Dict[str, Field]:
    """Returns the fields of a type such as "ur_ros_rtde_msgs/action/MoveJ". Empty if its file is not installed."""
    kind = name if name.count("/") == 2 else name.replace("/", "/msg/")
    try:
        return {field.name: field for field in parse(find(kind))[part]}
    except FileNotFoundError:
        return {}


def field(name: str, kind: str) -> Optional[Field]:
    return fields(kind).get(name)


def constants(name: str) -> Dict[str, Constant]:
    """Returns the constants of an interface. Empty if it is not installed."""
    try:
        return constants_of(find(name))
    except FileNotFoundError:
        return {}


def constants_of(file: pathlib.Path) -> Dict[str, Constant]:
    """Returns the constants in the first section of a file, in its order."""
    found = map(_CONSTANT.match, file.read_text().split("\n---")[0].splitlines())
    constants = (Constant(match.group(2), match.group(3), match.group(4) or "") for match in found if match)
    return {constant.name: constant for constant in constants}


def description(name: str) -> str:
    return description_of(find(name))


def description_of(file: pathlib.Path) -> str:
    """Returns the comment at the beginning of the file."""
    lines = file.read_text().splitlines()
    end = next((index for index, line in enumerate(lines) if not line.startswith("#")), len(lines))
    return " ".join(line.strip("# ") for line in lines[:end])
