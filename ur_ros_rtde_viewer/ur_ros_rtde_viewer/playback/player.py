"""Shows a motion with an arm of its own, so that it is never mistaken for the robot."""

import time
from typing import Any, Callable, Optional

from ..errors import ViewerError
from ..scene.arm import Arm
from ..scene.urdf import read_description
from ..state.robot_state import RobotState
from .motion import Motion

COLOR, OPACITY = (255, 170, 40), 0.75


class Player:
    """Play, pause, and a slider for the time. `scene` is the RobotScene of the robot to which the motion belongs."""

    def __init__(self, container: Any, server: Any, scene: Any, post: Callable[[Callable[[], None]], None]):
        self._server, self._robot_scene = server, scene
        self._motion: Optional[Motion] = None
        self._arm: Optional[Arm] = None
        self._began = 0.0  # monotonic time of the motion's start, while it plays
        self.playing = False
        gui = server.gui
        with container:
            self._play = gui.add_button("Play", visible=False)
            self._slider = gui.add_slider("Time, s", 0.0, 1.0, 0.01, 0.0, visible=False)
            self._loop = gui.add_checkbox("Repeat", True, visible=False)
            self._remove = gui.add_button("Remove", visible=False)
        self._play.on_click(lambda _event: post(self.toggle))
        self._remove.on_click(lambda _event: post(self.remove))
        self._slider.on_update(lambda event: post(lambda: self.seek(self._slider.value)) if event.client_id is not None else None)

    @property
    def arm(self) -> Optional[Arm]:
        return self._arm

    def load(self, motion: Motion) -> None:
        """Shows a motion from its start. Raises ViewerError while the model of the robot is unknown."""
        if not self._robot_scene.urdf:
            raise ViewerError("The model of the arm is unknown: start the viewer with --model, for example --model ur10e")
        self.remove()
        self._arm = Arm(self._server.scene, f"{self._robot_scene.root}/playback", read_description(self._robot_scene.urdf), OPACITY, COLOR)
        self._motion = motion
        self._slider.max = max(motion.duration, 0.01)
        self._show_controls(True)
        self.seek(0.0)
        self._set_playing(True)

    def toggle(self) -> None:
        if self._motion is not None:
            at_end = self._slider.value >= self._slider.max
            self.seek(0.0 if at_end and not self.playing else self._slider.value)
            self._set_playing(not self.playing)

    def seek(self, position: float) -> None:
        """Shows the motion at a time in s. If it plays, it goes on from there."""
        self._began = time.monotonic() - position
        if self._motion is not None and self._arm is not None:
            self._arm.set_positions(self._motion.at(position))
            self._slider.value = min(position, self._slider.max)

    def update(self, _state: RobotState) -> None:
        if not self.playing or self._motion is None:
            return
        position = time.monotonic() - self._began
        if position > self._motion.duration and self._loop.value:
            position = 0.0
        self.seek(position)
        if position > self._motion.duration:
            self._set_playing(False)

    def _set_playing(self, playing: bool) -> None:
        self.playing = playing
        self._play.label = "Pause" if playing else "Play"

    def _show_controls(self, visible: bool) -> None:
        for element in (self._play, self._slider, self._loop, self._remove):
            element.visible = visible

    def remove(self) -> None:
        self._set_playing(False)
        if self._arm is not None:
            self._arm.remove()
        self._arm = self._motion = None
        self._show_controls(False)

    def close(self) -> None:
        pass
