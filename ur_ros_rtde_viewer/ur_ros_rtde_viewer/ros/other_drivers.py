"""Finds drivers that the page does not show, while it waits for a robot: the viewer may have the wrong namespace."""

import time
from typing import Sequence

from ur_ros_rtde_cli.namespaces import drivers

from .nodes import Nodes
from .robot_topics import RobotTopics

PERIOD = 1.0  # s


class OtherDrivers:
    def __init__(self, nodes: Nodes, robots: Sequence[RobotTopics]):
        self._node = nodes.node
        self._robots = {robot.name_of("").rstrip("/") or "/": robot.state for robot in robots}
        self._due = 0.0

    def update(self) -> None:
        waiting = {namespace: state for namespace, state in self._robots.items() if state.joints is None}
        if not waiting or time.monotonic() < self._due:
            return
        self._due = time.monotonic() + PERIOD
        found = drivers(self._node)
        others = tuple(namespace for namespace in found if namespace not in self._robots)
        for namespace, state in waiting.items():
            state.other_drivers = () if namespace in found else others  # its own may have no robot
