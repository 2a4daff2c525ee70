"""The layout of the page: a header that is always in view, the tabs of the robots, and a second panel with the plots."""

from typing import Any, Dict, Sequence

import viser

from ..arguments import RobotOptions

PLOTS_WIDTH = 380  # pixels


class Layout:
    """`header` is above the tabs and stays in view when tabs change: banners and STOP belong here.

    With one robot, its panels are tabs of the page. With several, each robot has a tab that contains the tabs of its panels.
    """

    def __init__(self, server: viser.ViserServer, robots: Sequence[RobotOptions]):
        gui = server.gui
        gui.main_panel.dock_right()
        self.header: Any = gui.add_folder("Robots" if len(robots) > 1 else "Robot")
        self._plots = gui.add_panel()
        self._plots.dock_left()
        self._plots.set_width(PLOTS_WIDTH)
        self._tabs: Dict[str, Any] = {}
        if len(robots) == 1:
            self._tabs[robots[0].namespace] = gui.add_tab_group()
            return
        outer = gui.add_tab_group()
        for robot in robots:
            with outer.add_tab(robot.name):
                self._tabs[robot.namespace] = gui.add_tab_group()

    def tabs(self, robot: RobotOptions) -> Any:
        """Returns the tab group of a robot: `with layout.tabs(robot).add_tab("State"):`."""
        return self._tabs[robot.namespace]

    def add_plots_tab(self, robot: RobotOptions) -> Any:
        """Returns a new tab of the panel with the plots."""
        return self._plots.add_tab(f"Plots of {robot.name}" if robot.namespace else "Plots")
