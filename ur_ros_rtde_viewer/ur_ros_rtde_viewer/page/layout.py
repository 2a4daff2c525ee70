"""The layout of the page: a header that is always in view, and the tabs of the robots below it."""

from typing import Any, Dict, Sequence

import viser

from ..arguments import RobotOptions


class Layout:
    """`header` is above the tabs and stays in view when tabs change: banners and STOP belong here.

    With one robot, its panels are tabs of the page. With several, each robot has a tab that contains the tabs of its panels.
    """

    def __init__(self, server: viser.ViserServer, robots: Sequence[RobotOptions]):
        gui = server.gui
        gui.main_panel.dock_right()
        self.header: Any = gui.add_folder("", expand_by_default=True)
        self._tabs: Dict[str, Any] = {}
        if len(robots) == 1:
            self._tabs[robots[0].namespace] = gui.add_tab_group()
            return
        outer = gui.add_tab_group()
        for robot in robots:
            with outer.add_tab(robot.name):
                self._tabs[robot.namespace] = gui.add_tab_group()

    def tabs(self, robot: RobotOptions) -> Any:
        """Returns the tab group of a robot: `with layout.tabs(robot).add_tab("Plots"):`."""
        return self._tabs[robot.namespace]
