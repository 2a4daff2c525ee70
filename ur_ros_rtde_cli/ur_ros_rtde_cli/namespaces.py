"""Namespaces: those that are valid, and those of drivers, for a command that was given the wrong one."""

import argparse
import re
from typing import Any, List

_NAME = "[A-Za-z_][A-Za-z0-9_]*"
NODES = ("robot_state_receiver", "command_server", "dashboard_server")  # of a driver


def valid(text: str) -> str:
    """Returns the namespace without slashes at its ends. Raises argparse.ArgumentTypeError."""
    namespace = text.strip("/")
    if namespace and not re.fullmatch(rf"{_NAME}(/{_NAME})*", namespace):
        raise argparse.ArgumentTypeError(f"\"{text}\" is no namespace: names of letters, digits and _ that begin with no digit, "
                                         "separated by /")
    return namespace


def drivers(node: Any) -> List[str]:
    """Returns the namespaces in which nodes of a driver are."""
    return sorted({namespace for name, namespace in node.get_node_names_and_namespaces() if name in NODES})


def other_drivers(node: Any) -> str:
    """Returns ", but there is a driver in / and /left: give --namespace left". Returns an empty text if there is one in the namespace of
    `node`, or none at all."""
    found = drivers(node)
    if not found or node.get_namespace() in found:
        return ""
    remedy = "leave out --namespace" if found[0] == "/" else f"give --namespace {found[0].strip('/')}"
    return f", but there is a driver in {' and '.join(found)}: {remedy}"
