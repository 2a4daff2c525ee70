"""Finds actions by name: in installed plugins and in the ROS graph."""

import difflib
import importlib
from typing import Any, Dict, Iterable, List, Optional, Tuple

from .errors import CliError
from .plugins import Plugin, action_type, installed

FEEDBACK_TOPIC, FEEDBACK_TYPE = "/_action/feedback", "_FeedbackMessage"  # behind the name and the type of an action


def load(name: str, kind: str) -> Any:
    """Returns the class of an action type such as "ur_ros_rtde_msgs/action/MoveJ", with its type support loaded."""
    package, _, short = kind.partition("/action/")
    try:
        action = getattr(importlib.import_module(f"{package}.action"), short)
    except (ImportError, AttributeError):
        raise CliError(f"{name} has the type {kind}, which is not installed on this machine: source the workspace that "
                       "contains it") from None
    type(action).__import_type_support__()  # the action client would load it later, when the server is already discovered
    return action


def type_of_plugin(name: str) -> Optional[str]:
    """Returns the action type of an installed plugin, which is known without a server, or None."""
    plugin = next((plugin for plugin in installed() if plugin.name == name), None)
    return None if plugin is None else type_of(plugin)


def type_of(plugin: Plugin) -> Optional[str]:
    """Returns the action type of a plugin: the one that plugins.xml names, or that with the name of the plugin; otherwise None."""
    if plugin.action:
        return plugin.action
    found = action_type(plugin.name, plugin.package)
    return None if found is None else "/action/".join(found)


def split_name(name: str, namespace: str) -> Tuple[str, str]:
    """Returns the namespace of the driver and the name of the action in it, for a name such as left/move_j or /left/dashboard/power_on.

    An absolute name does not depend on `namespace`. The action is the name of an installed plugin; other names are not split.
    """
    full = name.lstrip("/") if name.startswith("/") else f"{namespace}/{name}".lstrip("/")
    action = max((plugin for plugin in plugin_names() if f"/{full}".endswith(f"/{plugin}")), key=len, default=name.lstrip("/"))
    return full[:-len(action)].rstrip("/"), action


def plugin_names() -> List[str]:
    return sorted(plugin.name for plugin in installed())


def suggestion(name: str, known: Iterable[str]) -> str:
    """Returns "; did you mean move_j or move_l?", or an empty string if no known name is similar."""
    close = difflib.get_close_matches(name, sorted(known), 3)
    return f"; did you mean {' or '.join(close)}?" if close else ""


def served(node: Any) -> Dict[str, str]:
    """Returns the types of all actions in the ROS graph by action name, from the topics of their feedback.

    rclpy's get_action_names_and_types() never releases its list: 27 KB per call with the actions of this driver.
    """
    return {topic.removesuffix(FEEDBACK_TOPIC): types[0].removesuffix(FEEDBACK_TYPE) for topic, types in node.get_topic_names_and_types()
            if topic.endswith(FEEDBACK_TOPIC) and types[0].endswith(FEEDBACK_TYPE)}
