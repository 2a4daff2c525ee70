"""The layout of the page: the banners, the tabs of the robots below them, and a second panel with the plots."""

from typing import Any, Dict, Sequence

import viser

from ..arguments import RobotOptions

PLOTS_WIDTH, PANEL_WIDTH = 370, 400  # pixels; the six tabs of a robot fit into one row


class Layout:
    """With one robot, its panels are tabs of the page. With several, each robot has a tab that contains the tabs of its panels.
    """

    def __init__(self, server: viser.ViserServer, robots: Sequence[RobotOptions]):
        gui = server.gui
        gui.main_panel.dock_right()
        gui.main_panel.set_width(PANEL_WIDTH)
        self._banners: Dict[str, Any] = {robot.namespace: gui.add_html("", visible=False) for robot in robots}
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

    def banner(self, robot: RobotOptions) -> Any:
        """Returns the element above all tabs, which stays in view when tabs change."""
        return self._banners[robot.namespace]

    def tabs(self, robot: RobotOptions) -> Any:
        """Returns the tab group of a robot: `with layout.tabs(robot).add_tab("State"):`."""
        return self._tabs[robot.namespace]

    def add_plots_tab(self, robot: RobotOptions) -> Any:
        """Returns a new tab of the panel with the plots."""
        return self._plots.add_tab(f"Plots of {robot.name}" if robot.namespace else "Plots")
