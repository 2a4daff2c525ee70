"""The tabs of a robot."""

from typing import Any


def add_panels(viewer: Any, robot: Any) -> None:
    """Adds all panels of a robot, and those that move it if the viewer was started with --control."""
    from .state_panel import StatePanel

    robot.panels.append(StatePanel(robot.tabs.add_tab("State"), viewer.server.gui))
    if viewer.options.control:
        from ..control import add_control

        add_control(viewer, robot)
