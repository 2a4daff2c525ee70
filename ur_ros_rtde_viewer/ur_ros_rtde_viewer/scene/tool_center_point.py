"""The TCP: its frame, its trail and the force on it."""

from typing import Any, List

import numpy as np
import viser

from ..state.robot_state import RobotState
from .trail import Trail

METERS_PER_NEWTON = 0.005
SMALLEST_FORCE = 2.0  # N; the sensor of a robot at rest shows less
FORCE_STEP = 0.5  # N; smaller changes are not drawn
FORCE_COLOR = (255, 120, 0)


class ToolCenterPoint:
    """`base`: scene node of the controller's base frame, to which tcp_pose refers."""

    def __init__(self, scene: viser.SceneApi, base: str):
        self._frame = scene.add_frame(f"{base}/tcp", axes_length=0.12, axes_radius=0.004, visible=False)
        arrow = np.zeros((1, 2, 3), np.float32)
        self._force = scene.add_arrows(f"{base}/tcp/force", arrow, FORCE_COLOR, shaft_radius=0.008, head_radius=0.02, head_length=0.04,
                                       visible=False)
        self._drawn_force = np.zeros(3)
        self.trail = Trail(scene, f"{base}/trail")
        self._handles: List[Any] = [self._force, self._frame]

    def update(self, state: RobotState) -> None:
        if state.tcp_pose is not None:
            self._frame.position, self._frame.wxyz = state.tcp_pose.position, state.tcp_pose.wxyz
            self._frame.visible = True
            self.trail.add(state.tcp_pose.position)
        if state.wrench is not None:
            self._show_force(state.wrench[:3])

    def _show_force(self, force: np.ndarray) -> None:
        visible = bool(np.linalg.norm(force) > SMALLEST_FORCE)
        if visible and np.linalg.norm(force - self._drawn_force) > FORCE_STEP:
            self._drawn_force = force
            self._force.points = np.array([[-METERS_PER_NEWTON * force, np.zeros(3)]], np.float32)  # pushes the TCP
        self._force.visible = visible

    def remove(self) -> None:
        self.trail.remove()
        for handle in self._handles:
            handle.remove()
