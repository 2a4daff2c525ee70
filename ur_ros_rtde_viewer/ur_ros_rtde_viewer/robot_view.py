"""One robot of the viewer: its topics, its scene and its panels."""

import logging
from typing import Any, Dict, List, Optional

from ur_ros_rtde_description.errors import DescriptionError

from .arguments import RobotOptions
from .panels.panel import Panel
from .ros.active_goal import ActiveGoalTopic
from .ros.diagnostics import Diagnostics
from .ros.nodes import Nodes
from .ros.robot_topics import RobotTopics
from .ros.service_call import ServiceCaller
from .scene.robot_scene import RobotScene
from .simulator import SimulatorWatcher, watcher_of
from .state.robot_state import RobotState

logger = logging.getLogger(__name__)


class RobotView:
    """`tabs` is the tab group of the robot, to which panels add their tabs. `panels` are updated in their order.

    `index`: of the robot in the viewer.
    `simulator`: stated address of a simulator; empty: that of the controller, if it is on this machine.
    """

    def __init__(self, server: Any, nodes: Nodes, diagnostics: Diagnostics, options: RobotOptions, index: int, tabs: Any,
                 simulator: str = ""):
        self.options = options
        self.topics = RobotTopics(nodes, options.namespace)
        self.services = ServiceCaller(nodes, self.topics.name_of)
        self.scene = RobotScene(server.scene, options, index)
        self.tabs = tabs
        self.panels: List[Panel] = []
        self._goal = ActiveGoalTopic(nodes, self.topics.name_of(""))
        self._reported_model = ""
        self._stated_simulator = simulator
        self._simulator: Optional[SimulatorWatcher] = None
        diagnostics.add(options.namespace, self._on_diagnostics)

    @property
    def state(self) -> RobotState:
        return self.topics.state

    def _on_diagnostics(self, address: str, values: Dict[str, str]) -> None:
        self.state.model = values.get("model", "")
        self._goal.on_holder(values.get("motion goal", ""))
        if address != self.state.address:
            self.state.address = address
            self._watch_simulator(watcher_of(address, self._stated_simulator))

    def _watch_simulator(self, watcher: Optional[SimulatorWatcher]) -> None:
        if self._simulator is not None:
            self._simulator.close()
        self._simulator = watcher

    def update(self) -> None:
        self.topics.poll()
        self.services.update()
        self._goal.update()
        self.state.goal = self._goal.goal
        self._follow_reported_model()
        self.scene.update(self.state)
        if self._simulator is not None:
            self.scene.show_surfaces(self._simulator.surfaces)
        for panel in self.panels:
            panel.update(self.state)

    def _follow_reported_model(self) -> None:
        """Builds the arm when the driver reports its model for the first time, or another one after a restart."""
        reported = self.state.model
        if self.options.model or not reported or reported == self._reported_model:
            return
        self._reported_model = reported
        try:
            self.scene.set_model(reported)
        except DescriptionError as error:
            self.scene.error = str(error)
            logger.warning("%s: %s", self.options.name, error)

    def close(self) -> None:
        """Asks the panels to end what they have started. The services are called until `services.is_idle`."""
        for panel in reversed(self.panels):
            panel.close()
        self._watch_simulator(None)
