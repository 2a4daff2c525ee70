"""The panels of a robot."""

import pathlib
from typing import Any

from ..playback.player import Player
from .banner import Banner
from .plan_panel import PlanPanel, load_plan
from .plots_panel import PlotsPanel
from .replay_panel import ReplayPanel
from .state_panel import StatePanel


def _player(viewer: Any, robot: Any, container: Any) -> Player:
    return Player(container, viewer.server, robot.scene, viewer.post)


def add_panels(viewer: Any, robot: Any) -> None:
    """Adds the panels of a RobotView that all tabs of the browser share. The others are added by control.Control."""
    server, tabs, post = viewer.server, robot.tabs, viewer.post
    state_tab, replay_tab = tabs.add_tab("State"), tabs.add_tab("Record" if viewer.options.control else "Replay")
    replay = ReplayPanel(replay_tab, server.gui, _player(viewer, robot, replay_tab), post)
    robot.panels += [
        Banner(viewer.layout.banners, robot.options.name, robot.topics.name_of("joint_states"), robot.scene),
        StatePanel(state_tab, server.gui, post),
        PlotsPanel(viewer.layout.add_plots_tab(robot.options), server),
        replay]
    if viewer.options.control:
        from ..control.recording_panel import RecordingPanel  # without --control, the page changes nothing
        folder = pathlib.Path(viewer.options.recordings).absolute()
        robot.panels.append(RecordingPanel(replay_tab, server, robot.services, replay, folder, post))


def add_plan_panel(viewer: Any, robot: Any) -> None:
    """Adds the animation of the plan that the options name. Raises ViewerError if it cannot be shown."""
    tab = robot.tabs.add_tab("Plan")
    motion = load_plan(pathlib.Path(viewer.options.plan))
    robot.panels.append(PlanPanel(tab, viewer.server.gui, motion, _player(viewer, robot, tab)))
