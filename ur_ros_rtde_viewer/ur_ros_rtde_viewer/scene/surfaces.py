"""The surfaces of a simulated world."""

from typing import Any, Dict, Sequence, Tuple

import numpy as np
import viser

SIZE = 2.0  # m, of the drawn part of a plane
THICKNESS = 0.006  # m
OPENING = 0.44  # m, in a table above the foot of the arm, which the simulated arm does not touch
COLOR, OPACITY = (190, 150, 105), 0.35

Surface = Tuple[Tuple[float, ...], Tuple[float, ...]]  # point in m and unit normal, both in the base frame


def turn_z_to(normal: Sequence[float]) -> np.ndarray:
    """Returns the rotation wxyz that turns z to the unit vector `normal`."""
    x, y, z = normal
    if z < -1.0 + 1e-9:
        return np.array((0.0, 1.0, 0.0, 0.0))
    rotation = np.array((1.0 + z, -y, x, 0.0))
    return rotation / np.linalg.norm(rotation)


def has_opening(center: np.ndarray, normal: np.ndarray) -> bool:
    """Whether the column of the arm passes through a plane: a horizontal one above its foot."""
    return bool(abs(normal[2]) > 0.99 and center[2] > 0.02)


def ring(outer: float, inner: float) -> Tuple[np.ndarray, np.ndarray]:
    """Returns vertices and triangles of a square with a square opening, in the plane z = 0."""
    corners = np.array(((-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0))) / 2.0
    triangles = [(a, b, c) for k in range(4) for a, b, c in ((k, (k + 1) % 4, 4 + k), ((k + 1) % 4, 4 + (k + 1) % 4, 4 + k))]
    return np.concatenate((outer * corners, inner * corners)), np.array(triangles)


class Surfaces:
    """Draws of each plane a square, whose center is next to the origin of the controller's base frame `base`, without the place where
    the arm stands. The simulated planes are infinite."""

    def __init__(self, scene: viser.SceneApi, base: str):
        self._scene, self._base = scene, base
        self._drawn: Dict[Surface, Any] = {}

    def __len__(self) -> int:
        return len(self._drawn)

    def show(self, surfaces: Sequence[Surface]) -> None:
        for gone in set(self._drawn) - set(surfaces):
            self._drawn.pop(gone).remove()
        for surface in surfaces:
            if surface not in self._drawn:
                self._drawn[surface] = self._draw(surface)

    def _draw(self, surface: Surface) -> Any:
        point, normal = (np.array(part) for part in surface)
        center = (normal @ point - 0.5 * THICKNESS) * normal
        name, pose = f"{self._base}/surface_{abs(hash(surface)):x}", {"wxyz": turn_z_to(normal), "position": center}
        if has_opening(center, normal):
            return self._scene.add_mesh_simple(name, *ring(SIZE, OPENING), color=COLOR, opacity=OPACITY, side="double", **pose)
        return self._scene.add_box(name, dimensions=(SIZE, SIZE, THICKNESS), color=COLOR, opacity=OPACITY, **pose)

    def remove(self) -> None:
        self.show(())
