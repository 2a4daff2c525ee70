"""An arm in the scene: one frame per joint, moved by joint positions."""

import math
from typing import Any, Dict, List, Optional, Sequence

import numpy as np
import viser
from ur_ros_rtde_description.models import JOINTS

from .urdf import Box, Color, Cylinder, Description, Joint, Shape

SMALLEST_STEP = 1e-5  # rad; smaller changes are not sent


def _multiply_z(wxyz: np.ndarray, angle: float) -> tuple:
    """Returns the orientation after a turn about its z axis."""
    c, s = math.cos(0.5 * angle), math.sin(0.5 * angle)
    w, x, y, z = wxyz
    return w * c - z * s, x * c + y * s, y * c - x * s, z * c + w * s


class Arm:
    """`root` is the scene node of the root link, for example /robot_0/arm; its links are below it.

    The positions are those of the driver: shoulder_pan, shoulder_lift, elbow, wrist_1, wrist_2, wrist_3, in rad.
    """

    def __init__(self, scene: viser.SceneApi, root: str, description: Description, opacity: Optional[float] = None,
                 color: Optional[Color] = None):
        self._scene, self._opacity, self._color = scene, opacity, color
        self._paths: Dict[str, str] = {description.root: root}
        self._shapes: List[Any] = []
        self._colors: List[Color] = []
        self._turning: List[Any] = []  # (joint, handle) in the order of JOINTS
        self._positions = np.full(len(JOINTS), np.nan)
        self._root = scene.add_frame(root, show_axes=False)
        self._add(description)

    def _add(self, description: Description) -> None:
        frames = {joint.name: (joint, self._add_joint(joint)) for joint in description.joints}
        self._turning = [frames[name] for name in JOINTS]
        for link in description.links:
            for index, shape in enumerate(link.shapes):
                self._add_shape(f"{self._paths[link.name]}/shape_{index}", shape)

    def _add_joint(self, joint: Joint) -> Any:
        path = self._paths[joint.child] = f"{self._paths[joint.parent]}/{joint.child}"
        return self._scene.add_frame(path, show_axes=False, position=joint.position, wxyz=joint.wxyz)

    def _add_shape(self, path: str, shape: Shape) -> None:
        place = {"position": shape.position, "wxyz": shape.wxyz, "opacity": self._opacity, "color": self._color or shape.color,
                 "cast_shadow": self._opacity is None}
        if isinstance(shape.geometry, Cylinder):
            handle = self._scene.add_cylinder(path, shape.geometry.radius, shape.geometry.length, **place)
        elif isinstance(shape.geometry, Box):
            handle = self._scene.add_box(path, dimensions=shape.geometry.size, **place)
        else:
            handle = self._scene.add_icosphere(path, shape.geometry.radius, **place)
        self._shapes.append(handle)
        self._colors.append(self._color or shape.color)

    @property
    def positions(self) -> np.ndarray:
        """Joint positions that are shown, rad; NaN before the first set_positions()."""
        return self._positions.copy()

    def link_path(self, name: str) -> str:
        """Returns the scene node of a link, for example of "tool0"."""
        return self._paths[name]

    def set_positions(self, positions: Sequence[float]) -> None:
        for index, ((joint, handle), position) in enumerate(zip(self._turning, positions)):
            if not abs(position - self._positions[index]) < SMALLEST_STEP:  # also true for NaN
                handle.wxyz = _multiply_z(joint.wxyz, position)
                self._positions[index] = position

    def set_visible(self, visible: bool) -> None:
        self._root.visible = visible

    def set_color(self, color: Optional[Color]) -> None:
        """Colors the whole arm; None restores the colors of the description."""
        for handle, original in zip(self._shapes, self._colors):
            handle.color = color or original

    def remove(self) -> None:
        self._root.remove()
