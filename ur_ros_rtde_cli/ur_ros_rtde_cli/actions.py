"""The actions of installed plugins and of the ROS graph."""

import difflib
import importlib
from typing import Any, Dict, Iterable, List, Optional

from rclpy.action.graph import get_action_names_and_types

from .plugins import action_type, installed
from .problem import Problem


def load(name: str, kind: str) -> Any:
    """The class of an action, whose type is "ur_ros_rtde_msgs/action/MoveJ"."""
    package, _, short = kind.partition("/action/")
    try:
        return getattr(importlib.import_module(f"{package}.action"), short)
    except (ImportError, AttributeError):
        raise Problem(f"{name} has the type {kind}, which is not installed here: source the workspace that contains it") from None


def type_of_plugin(name: str) -> Optional[str]:
    """The type of an installed plugin that is known before a server is discovered, because it has the plugin's name."""
    package = next((package for plugin, package, _ in installed() if plugin == name), None)
    found = None if package is None else action_type(name, package)
    return None if found is None else "/action/".join(found)


def plugin_names() -> List[str]:
    return sorted(name for name, _, _ in installed())


def suggestion(name: str, known: Iterable[str]) -> str:
    """"; did you mean move_j or move_l?" or an empty string."""
    close = difflib.get_close_matches(name, sorted(known), 3)
    return f"; did you mean {' or '.join(close)}?" if close else ""


def served(node: Any) -> Dict[str, str]:
    """Type by name of all actions in the ROS graph."""
    return {name: types[0] for name, types in get_action_names_and_types(node)}
