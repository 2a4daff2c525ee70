"""The surfaces of a simulated world."""

from typing import Any, Dict, Sequence, Tuple

import numpy as np
import viser

SIZE = 2.0  # m, of the drawn part of a plane
THICKNESS = 0.006  # m
COLOR, OPACITY = (190, 150, 105), 0.35

Surface = Tuple[Tuple[float, ...], Tuple[float, ...]]  # point in m and unit normal, both in the base frame


def turn_z_to(normal: Sequence[float]) -> np.ndarray:
    """Returns the rotation wxyz that turns z to the unit vector `normal`."""
    x, y, z = normal
    if z < -1.0 + 1e-9:
        return np.array((0.0, 1.0, 0.0, 0.0))
    rotation = np.array((1.0 + z, -y, x, 0.0))
    return rotation / np.linalg.norm(rotation)


class Surfaces:
    """Draws of each plane the square next to the origin of the controller's base frame `base`; the simulated planes are infinite."""

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
        return self._scene.add_box(f"{self._base}/surface_{abs(hash(surface)):x}", dimensions=(SIZE, SIZE, THICKNESS), color=COLOR,
                                   opacity=OPACITY, wxyz=turn_z_to(normal), position=center)

    def remove(self) -> None:
        self.show(())
