"""Reads sizes and ranges from the comments of .action and .msg files.

A comment is plain text with these fixed forms:
"Size: exactly 6", "Size: exactly 6, or empty", "Size: 1 to 1000", "0.03 to 0.2", "above 0, at most 3.14", "within +-2 pi".
"""

import math
import pathlib
import re
from typing import Optional

from ur_ros_rtde_cli import interface_files

NUMERIC = re.compile(r"(float|u?int)\d+")
NUMBER = r"-?\d+(?:\.\d+)?(?:e-?\d+)?(?: pi)?"


def _number(text):
    return float(text[:-3]) * math.pi if text.endswith(" pi") else float(text)


class Field(interface_files.Field):
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


def paths(packages):
    """Returns the .action files of these packages."""
    return sorted(file for prefix in interface_files.prefixes() for package in packages
                  for file in pathlib.Path(prefix, "share", package, "action").glob("*.action"))


def parse(file):
    """Returns the sections of an interface file, each as a list of Fields."""
    return [[_with_limits(field) for field in part] for part in interface_files.parse(file)]


def field(name, kind) -> Optional[Field]:
    found = interface_files.field(name, kind)
    return None if found is None else _with_limits(found)


def _with_limits(field):
    return Field(field.type, field.name, field.comment)
