"""Reads the comments of .action and .msg files, which state the size, unit and range of each field.

A comment precedes its field or follows it on the same line. It is read as plain text with these fixed forms:
"Size: exactly 6", "Size: exactly 6, or empty", "Size: 1 to 1000", "0.03 to 0.2", "above 0, at most 3.14", "within +-2 pi".
"""

import math
import os
import pathlib
import re
from dataclasses import dataclass
from typing import Optional

NUMERIC = re.compile(r"(float|u?int)\d+")
NUMBER = r"-?\d+(?:\.\d+)?(?:e-?\d+)?(?: pi)?"


def _number(text):
    return float(text[:-3]) * math.pi if text.endswith(" pi") else float(text)


@dataclass
class Field:
    type: str
    name: str
    comment: str

    @property
    def numeric(self):
        return NUMERIC.match(self.type) is not None

    @property
    def length(self):
        """The required number of elements of an array: "exactly 6"."""
        found = re.search(r"exactly (\d+)", self.comment)
        return int(found.group(1)) if found else None

    @property
    def may_be_empty(self):
        return "or empty" in self.comment or self.counts is None and self.length is None

    @property
    def counts(self):
        """The allowed numbers of elements of an array of messages: "Size: 1 to 1000"."""
        found = re.search(r"Size: (\d+) to (\d+)", self.comment)
        return (int(found.group(1)), int(found.group(2))) if found and "[]" in self.type else None

    def too_low(self):
        """Returns a value below all allowed values. None if the comment states no lower limit."""
        if self._above_zero():
            return 0.0
        lows = [low for low, _ in self._ranges()]
        if lows:
            return min(lows) - max(1e-6, 1e-3 * abs(min(lows)))
        return -1.0 if re.search(r"\bat most\b", self.comment) else None

    def too_high(self):
        """Returns a value above all allowed values. None if the comment states no upper limit."""
        highs = [high for _, high in self._ranges()]
        highs += [_number(text) for text in re.findall(rf"\bat most ({NUMBER})", self.comment)]
        return max(highs) + max(1e-6, 1e-3 * abs(max(highs))) if highs else None

    def _above_zero(self):
        return re.search(r"\babove 0\b", self.comment, re.I) is not None

    def _ranges(self):
        for low, high in re.findall(rf"({NUMBER}) to ({NUMBER})", self.comment):
            yield _number(low), _number(high)
        for limit in re.findall(rf"within \+-({NUMBER})", self.comment):
            yield -_number(limit), _number(limit)


def _file(name):
    package, folder, message = name.split("/")
    for prefix in os.environ["AMENT_PREFIX_PATH"].split(os.pathsep):
        file = pathlib.Path(prefix, "share", package, folder, f"{message}.{folder}")
        if file.is_file():
            return file
    raise FileNotFoundError(f"{name} is in no prefix of AMENT_PREFIX_PATH")


def paths(packages):
    """Returns the .action files of these packages."""
    return sorted(file for prefix in os.environ["AMENT_PREFIX_PATH"].split(os.pathsep) for package in packages
                  for file in pathlib.Path(prefix, "share", package, "action").glob("*.action"))


def parse(file):
    """Returns the sections of an interface file, each as a list of Fields."""
    parts = [[]]
    above = []  # the comment lines directly above a field
    for line in file.read_text().splitlines():
        found = re.match(r"([\w/]+(?:\[[^\]]*\])?)\s+(\w+)\b(?!\s*=)[^#]*(?:#\s*(.*))?$", line)
        if line.startswith("#"):
            above.append(line.strip("# "))
            continue
        if line.strip() == "---":
            parts.append([])
        elif found:
            comment = " ".join(filter(None, [*above, (found.group(3) or "").strip()]))
            parts[-1].append(Field(found.group(1), found.group(2), comment))
        above = []
    return parts


def fields(name, part=0):
    """Returns {name: Field} of a type such as "ur_ros_rtde_msgs/action/MoveJ". Empty if the interface file is not installed."""
    kind = name if name.count("/") == 2 else name.replace("/", "/msg/")
    try:
        return {field.name: field for field in parse(_file(kind))[part]}
    except FileNotFoundError:
        return {}


def field(name, kind) -> Optional[Field]:
    return fields(kind).get(name)


def description(kind):
    """Returns the comment at the beginning of the file."""
    lines = _file(kind).read_text().splitlines()
    end = next(index for index, line in enumerate(lines) if not line.startswith("#"))
    return " ".join(line.strip("# ") for line in lines[:end])
