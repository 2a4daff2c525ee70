"""The layout of the page: the banners over the scene, the tabs of the robots, and a second panel with the plots."""

from typing import Any, Dict, Sequence

import viser
from viser._messages import GuiSetPanelCollapsedMessage

from ..arguments import RobotOptions
from . import style
from .banner_area import BannerArea
from .scripts import NOTICES

PLOTS_WIDTH = 370  # pixels
NARROW = 0.45  # width of the scene by its height


class Layout:
    """With one robot, its panels are tabs of the page. With several, each robot has a tab that contains the tabs of its panels.

    In a window that is too narrow for three columns, the plots are minimized. A click opens them.
    """

    def __init__(self, server: viser.ViserServer, robots: Sequence[RobotOptions]):
        gui = server.gui
        gui.main_panel.dock_right()
        gui.main_panel.set_width(style.PANEL_WIDTH)
        gui.add_html(style.PAGE + NOTICES)
        self.banners = BannerArea(gui)
        self._plots = gui.add_panel()
        self._plots.dock_left()
        self._plots.set_width(PLOTS_WIDTH)
        server.on_client_connect(self._make_room)
        self._tabs: Dict[str, Any] = {}
        if len(robots) == 1:
            self._tabs[robots[0].namespace] = gui.add_tab_group()
            return
        outer = gui.add_tab_group()
        for robot in robots:
            with outer.add_tab(robot.name):
                self._tabs[robot.namespace] = gui.add_tab_group()

    async def _make_room(self, client: viser.ClientHandle) -> None:
        """Minimizes the plots once in a browser with a narrow scene. Its camera reports the size of the scene when it changes."""
        minimized = False

        async def check(camera: viser.CameraHandle) -> None:
            nonlocal minimized
            if not minimized and camera.image_width < NARROW * camera.image_height:
                minimized = True
                gui = client.gui
                gui._websock_interface.queue_message(GuiSetPanelCollapsedMessage(
                    self._plots._placement_uuid, True, counter=gui._next_layout_counter(), run_id=gui._layout_run_id))

        client.camera.on_update(check)

    def tabs(self, robot: RobotOptions) -> Any:
        """Returns the tab group of a robot: `with layout.tabs(robot).add_tab("State"):`."""
        return self._tabs[robot.namespace]

    def add_plots_tab(self, robot: RobotOptions) -> Any:
        """Returns a new tab of the panel with the plots."""
        return self._plots.add_tab(f"Plots of {robot.name}" if robot.namespace else "Plots")
