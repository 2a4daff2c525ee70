"""The switch and the sliders of the digital twin, in the page of one browser tab."""

import math
from typing import Any, Callable, Hashable

from ur_ros_rtde_description.models import JOINTS

from ..page.sliders import within_limits
from .robot_control import RobotControl

INTRODUCTION = ("Sets the positions in `joint_states` for the programs that read them. The robot does not move. The real positions stay "
                "visible as a blue ghost. The mode ends when this tab is closed.")
MAX_POSITION = 2.0 * math.pi  # rad


class TwinPanel:
    """Callbacks of the page are called in other threads; `post` calls a function in that of the viewer's loop."""

    def __init__(self, gui: Any, container: Any, robot: RobotControl, tab: Hashable, post: Callable[..., None]):
        self._robot, self._tab, self._post = robot, tab, post
        self._closed = False
        with container:
            gui.add_markdown(INTRODUCTION)
            self.switch = gui.add_checkbox("Digital twin", False)
            self.message = gui.add_markdown("")
            self.sliders = [gui.add_slider(f"{joint.removesuffix('_joint')}, rad", -round(MAX_POSITION, 2), round(MAX_POSITION, 2), 0.01,
                                           0.0, disabled=True) for joint in JOINTS]
        self.switch.on_update(lambda event: post(self.switched) if event.client_id is not None else None)
        for slider in self.sliders:
            slider.on_update(lambda event: post(self.publish) if event.client_id is not None else None)

    def switched(self) -> None:
        if self.switch.value:
            self._robot.twin.begin(self._tab, self._show)
        else:
            self._robot.twin.end(self._tab)

    def _show(self, on: bool, message: str) -> None:
        if self._closed:  # the elements do not exist anymore
            return
        self.switch.value, self.message.content = on, message
        positions = self._robot.last_joint_positions
        for index, slider in enumerate(self.sliders):
            slider.disabled = not on
            if on and positions is not None:
                slider.value = float(positions[index])

    def publish(self) -> None:
        """Sends the positions of the sliders."""
        for slider in self.sliders:
            limited = within_limits(slider)
            if limited != slider.value:
                slider.value = limited
        self._robot.twin.publish(self._tab, [float(slider.value) for slider in self.sliders])

    def close(self) -> None:
        self._closed = True
        self._post(lambda: self._robot.twin.end(self._tab))
