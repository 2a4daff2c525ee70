"""Finds drivers that the page does not show, while it waits for a robot: the viewer may have the wrong namespace."""

import time
from typing import Sequence

from ur_ros_rtde_cli.namespaces import drivers

from .nodes import Nodes
from .robot_topics import RobotTopics

PERIOD = 1.0  # s


class OtherDrivers:
    def __init__(self, nodes: Nodes, robots: Sequence[RobotTopics]):
        self._node, self._robots = nodes.node, robots
        self._shown = {robot.name_of("").rstrip("/") or "/" for robot in robots}
        self._due = 0.0

    def update(self) -> None:
        waiting = [robot.state for robot in self._robots if robot.state.joints is None]
        if not waiting or time.monotonic() < self._due:
            return
        self._due = time.monotonic() + PERIOD
        found = tuple(namespace for namespace in drivers(self._node) if namespace not in self._shown)
        for state in waiting:
            state.other_drivers = found
