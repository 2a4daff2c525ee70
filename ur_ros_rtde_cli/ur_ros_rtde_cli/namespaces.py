"""Finds the namespaces of drivers, for a command that was given the wrong one."""

from typing import Any, List

NODES = ("robot_state_receiver", "command_server", "dashboard_server")  # of a driver


def drivers(node: Any) -> List[str]:
    """Returns the namespaces in which nodes of a driver are."""
    return sorted({namespace for name, namespace in node.get_node_names_and_namespaces() if name in NODES})


def other_drivers(node: Any) -> str:
    """Returns ", but there is a driver in / and /left: give --namespace". Returns an empty text if there is one in the namespace of
    `node`, or none at all."""
    found = drivers(node)
    return f", but there is a driver in {' and '.join(found)}: give --namespace" if found and node.get_namespace() not in found else ""
