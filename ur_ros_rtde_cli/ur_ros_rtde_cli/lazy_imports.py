"""Imports message types on demand, which shortens the start of a program that uses few of them.

The generated packages import all of their types, and rosidl_generator_py imports the code generator with its parser.
"""

import importlib
import importlib.util
import re
import sys
from typing import Any

TYPE_PACKAGES = ("ur_ros_rtde_msgs.action", "ur_ros_rtde_msgs.msg")
GENERATOR = "rosidl_generator_py.generate_py_impl"  # rosidl_generator_py works without it


def enable() -> None:
    """Applies to this process. Must be called before any message type is imported."""
    sys.modules.setdefault(GENERATOR, None)  # type: ignore[arg-type]
    for package in TYPE_PACKAGES:
        if package not in sys.modules:
            _import_types_on_demand(package)


def _import_types_on_demand(package: str) -> None:
    try:
        spec = importlib.util.find_spec(package)
    except ImportError:
        return
    if spec is None:
        return
    module = importlib.util.module_from_spec(spec)  # not executed, because that would import all types

    def get_type(name: str) -> Any:
        if not name[:1].isupper():
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        try:
            return getattr(importlib.import_module(f"{package}.{_module_of(name)}"), name)
        except ModuleNotFoundError:
            raise AttributeError(f"module {package!r} has no attribute {name!r}") from None

    module.__getattr__ = get_type  # type: ignore[method-assign]
    sys.modules[package] = module
    parent, _, child = package.rpartition(".")
    setattr(sys.modules[parent], child, module)


def _module_of(name: str) -> str:
    """Returns the name that rosidl gives the module of a type: _move_jik for MoveJIK."""
    partly = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", name)
    return "_" + re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", partly).lower()
