"""The viewer: all robots of one page, and the loop that updates them."""

import argparse
import logging
import queue
import time
from typing import Any, Callable, List

from .arguments import robots
from .page.layout import Layout
from .panels import add_panels, add_plan_panel
from .robot_view import RobotView
from .ros.diagnostics import Diagnostics
from .ros.nodes import Nodes
from .ros.other_drivers import OtherDrivers

logger = logging.getLogger(__name__)
CLOSE_TIMEOUT = 2.0  # s
FLOOR, FLOOR_IN_THE_DARK = ((200, 200, 200), (140, 140, 140)), ((45, 45, 50), (80, 80, 88))  # colors of its cells and sections
CAMERA = (-1.35, -1.6, 1.05), (-0.35, 0.0, 0.42)  # m, position and the point that it looks at


class Viewer:
    """One thread, that of run(), uses ROS, the scene and the panels. Callbacks of the page reach it through post()."""

    def __init__(self, server: Any, nodes: Nodes, options: argparse.Namespace):
        self.server, self.nodes, self.options = server, nodes, options
        self._posted: "queue.SimpleQueue[Callable[[], None]]" = queue.SimpleQueue()
        self._last_error = ""
        with server.atomic():
            cell, section = FLOOR_IN_THE_DARK if options.dark else FLOOR
            server.scene.add_grid("/floor", width=4.0, height=4.0, cell_size=0.1, section_size=0.5, cell_color=cell, section_color=section)
            server.initial_camera.position, server.initial_camera.look_at = CAMERA
            found = robots(options)
            self.layout = Layout(server, found)
            diagnostics = Diagnostics(nodes)
            self.robots: List[RobotView] = [
                RobotView(server, nodes, diagnostics, robot, index, self.layout.tabs(robot), options.simulator)
                for index, robot in enumerate(found)]
            self._other_drivers = OtherDrivers(nodes, [robot.topics for robot in self.robots])
            for robot in self.robots:
                add_panels(self, robot)
            if options.plan:
                add_plan_panel(self, self.robots[0])
            self.control: Any = None
            if options.control:
                from .control.control import Control  # without --control, nothing that can move an arm is loaded
                self.control = Control(self)

    def post(self, function: Callable[[], None]) -> None:
        """Calls a function in the thread of the loop, without waiting for the next update. Can be called in any thread."""
        self._posted.put(function)
        self.nodes.wake()

    def run(self, ended: Callable[[], bool]) -> None:
        """Updates the page until `ended()`, which is asked once per update."""
        while not ended():
            self.step()

    def step(self) -> None:
        """Updates the page, then runs callbacks until the next update is due."""
        due = time.monotonic() + 1.0 / self.options.rate
        self._call(self.update)
        self._spin_until(due)

    def _spin_until(self, due: float) -> None:
        """Runs callbacks of ROS and posted functions."""
        self.run_posted()
        while (remaining := due - time.monotonic()) > 0.0:
            self._call(lambda: self.nodes.spin_once(remaining))
            self.run_posted()

    def _call(self, function: Callable[[], None]) -> None:
        """An error must not end the viewer, and STOP with it. One that repeats itself is logged once."""
        try:
            function()
        except Exception as error:
            text = f"{type(error).__name__}: {error}"
            if text != self._last_error:
                self._last_error = text
                logger.exception("a part of the page failed")

    def run_posted(self) -> None:
        while not self._posted.empty():
            self._call(self._posted.get())

    def update(self) -> None:
        with self.server.atomic():
            self._other_drivers.update()
            for robot in self.robots:
                robot.update()
            if self.control is not None:
                self.control.update()

    def close(self, is_interrupted: Callable[[], bool] = lambda: False) -> None:
        """Ends what the page has started: goals, recordings and the digital twin. Waits for the driver until `is_interrupted()`."""
        if self.control is not None:
            self.control.end_goals(is_interrupted)
        for robot in self.robots:
            robot.close()
        if self.control is not None:
            self.control.close()
        end = time.monotonic() + CLOSE_TIMEOUT
        while not all(robot.services.is_idle for robot in self.robots):
            for robot in self.robots:
                robot.services.update()
            if time.monotonic() >= end or is_interrupted():
                break
            self.nodes.spin_once(0.01)
