"""Reads what the driver reports only on /diagnostics: the model of the arm, the controller's address, and the goal that moves the arm."""

from typing import Any, Callable, Dict, List

from diagnostic_msgs.msg import DiagnosticArray

from .nodes import Nodes

ENTRY = "command_server: driver"
NONE = ("", "none", "unknown")


class Diagnostics:
    """Calls `on_entry(address, values)` of a robot for each entry of its command_server."""

    def __init__(self, nodes: Nodes) -> None:
        self._robots: Dict[str, Callable[[str, Dict[str, str]], None]] = {}
        nodes.node.create_subscription(DiagnosticArray, "/diagnostics", self._on_message, 10)

    def add(self, namespace: str, on_entry: Callable[[str, Dict[str, str]], None]) -> None:
        self._robots[f"/{namespace}/{ENTRY}" if namespace else f"/{ENTRY}"] = on_entry

    def _on_message(self, message: DiagnosticArray) -> None:
        for status in message.status:
            on_entry = self._robots.get(status.name)
            if on_entry is not None:
                on_entry(status.hardware_id, _values(status.values))


def _values(pairs: List[Any]) -> Dict[str, str]:
    """Returns the values by key; those that mean "none" are left out."""
    return {pair.key: pair.value for pair in pairs if pair.value not in NONE}
