"""Reads and checks the options of a description, from the command line or a launch file."""

import math
import pathlib
import re
from typing import Optional, Sequence

from .arguments import DEFAULT_TOOL_RADIUS
from .calibration import read_calibration
from .errors import DescriptionError
from .kinematics import Origin
from .models import JOINTS, find_model
from .tool import CylinderTool, Tool, read_tool
from .urdf import ARM_LINKS, FIXED_JOINTS, Options


def read_options(model: str, tf_prefix: str = "", kinematics_params_file: str = "", parent: str = "world",
                 xyz: Sequence[float] = (0.0, 0.0, 0.0), rpy: Sequence[float] = (0.0, 0.0, 0.0), tool: str = "",
                 tool_length: Optional[float] = None, tool_radius: Optional[float] = None,
                 tool_mass: Optional[float] = None) -> Options:
    """Returns the options. Raises DescriptionError with the name, the value and the allowed values of an invalid one."""
    found = find_model(model)
    _check_name("tf_prefix", tf_prefix)
    _check_name("parent", parent)
    tool_read = _tool(tool, tool_length, tool_radius, tool_mass)
    if parent in {tf_prefix + link for link in (*ARM_LINKS, *(tool_read.link_names() if tool_read else ()))}:
        raise DescriptionError(f"parent is \"{parent}\", this is a link of the arm or its tool; it must be another link")
    origins = read_calibration(pathlib.Path(kinematics_params_file), found) if kinematics_params_file else None
    return Options(found, tf_prefix, origins, parent, Origin(_vector("xyz", xyz), _vector("rpy", rpy)), tool_read)


def _check_name(field: str, value: str) -> None:
    """Applies the rule of the driver's parameter tf_prefix."""
    if not re.fullmatch(r"[A-Za-z0-9_/]*", value):
        raise DescriptionError(f"{field} is \"{value}\", it may contain letters, digits, '_' and '/'")


def _vector(field: str, values: Sequence[float]) -> tuple:
    if len(values) != 3 or not all(map(math.isfinite, values)):
        raise DescriptionError(f"{field} is {list(values)}, it must be three finite numbers")
    return tuple(values)


def _tool(file: str, length: Optional[float], radius: Optional[float], mass: Optional[float]) -> Optional[Tool]:
    if file:
        if (length, radius, mass) != (None, None, None):
            raise DescriptionError("tool is given together with tool_length, tool_radius or tool_mass: give either a file or a cylinder")
        return read_tool(pathlib.Path(file), frozenset((*ARM_LINKS, *JOINTS, *FIXED_JOINTS)))
    if length is None:
        if (radius, mass) != (None, None):
            raise DescriptionError("tool_length is missing: a cylinder as a tool needs its length in m")
        return None
    return CylinderTool(length, DEFAULT_TOOL_RADIUS if radius is None else radius, 0.0 if mass is None else mass)
