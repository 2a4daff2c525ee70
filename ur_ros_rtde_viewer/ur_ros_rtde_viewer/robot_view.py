"""One robot of the viewer: its topics, its scene and its panels."""

import logging
from typing import Any, List

from ur_ros_rtde_description.errors import DescriptionError

from .arguments import RobotOptions
from .panels.panel import Panel
from .ros.nodes import Nodes
from .ros.robot_topics import RobotTopics
from .scene.robot_scene import RobotScene
from .state.robot_state import RobotState

logger = logging.getLogger(__name__)


class RobotView:
    """`tabs` is the tab group of the robot, to which panels add their tabs. `panels` are updated in their order."""

    def __init__(self, server: Any, nodes: Nodes, options: RobotOptions, tabs: Any):
        self.options = options
        self.topics = RobotTopics(nodes, options.namespace)
        self.scene = RobotScene(server.scene, options)
        self.tabs = tabs
        self.panels: List[Panel] = []
        self._reported_model = ""

    @property
    def state(self) -> RobotState:
        return self.topics.state

    def update(self) -> None:
        self.topics.poll()
        self._follow_reported_model()
        self.scene.update(self.state)
        for panel in self.panels:
            panel.update(self.state)

    def _follow_reported_model(self) -> None:
        """Builds the arm when the driver reports its model for the first time, or another one after a restart."""
        reported = self.state.model
        if self.options.model or reported == self._reported_model:
            return
        self._reported_model = reported
        try:
            self.scene.set_model(reported)
        except DescriptionError as error:
            logger.warning("%s: %s", self.options.name, error)

    def close(self) -> None:
        for panel in reversed(self.panels):
            panel.close()
