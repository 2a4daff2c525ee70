"""The tabs of a robot."""

from typing import Any


def add_panels(viewer: Any, robot: Any) -> None:
    """Adds the panels of a robot that only show it. Those that move it are added by control.Control."""
    from .state_panel import StatePanel

    robot.panels.append(StatePanel(robot.tabs.add_tab("State"), viewer.server.gui))
