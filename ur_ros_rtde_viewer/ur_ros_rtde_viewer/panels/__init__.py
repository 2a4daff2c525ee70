"""The panels of a robot."""

import pathlib
from typing import Any

from ..playback.player import Player
from .banner import Banner
from .plan_panel import PlanPanel, load_plan
from .plots_panel import PlotsPanel
from .recording_panel import RecordingPanel
from .state_panel import StatePanel
from .twin_panel import TwinPanel


def _player(viewer: Any, robot: Any, container: Any) -> Player:
    return Player(container, viewer.server, robot.scene, viewer.post)


def add_panels(viewer: Any, robot: Any) -> None:
    """Adds the panels of a RobotView. Those that move it are added by control.Control."""
    server, tabs, post = viewer.server, robot.tabs, viewer.post
    recordings = pathlib.Path(viewer.options.recordings).absolute()
    state_tab, recording_tab, twin_tab = (tabs.add_tab(name) for name in ("State", "Record", "Twin"))
    robot.panels += [
        Banner(viewer.layout.banner(robot.options), robot.options.name, robot.topics.name_of("joint_states"), robot.scene),
        StatePanel(state_tab, server.gui),
        PlotsPanel(viewer.layout.add_plots_tab(robot.options), server),
        RecordingPanel(recording_tab, server, robot.services, _player(viewer, robot, recording_tab), recordings, post),
        TwinPanel(twin_tab, server.gui, robot.topics, robot.services, viewer.nodes.node, post)]


def add_plan_panel(viewer: Any, robot: Any) -> None:
    """Adds the animation of the plan that the options name. Raises ViewerError if it cannot be shown."""
    tab = robot.tabs.add_tab("Plan")
    motion = load_plan(pathlib.Path(viewer.options.plan))
    robot.panels.append(PlanPanel(tab, viewer.server.gui, motion, _player(viewer, robot, tab)))
