"""The surfaces of a simulated world."""

from typing import Any, Dict, Sequence, Tuple

import numpy as np
import viser

SIZE = 1.6  # m, of the drawn part of a plane
COLOR, OPACITY = (150, 120, 90), 0.5

Surface = Tuple[Tuple[float, ...], Tuple[float, ...]]  # point in m and unit normal, both in the base frame


def turn_z_to(normal: Sequence[float]) -> np.ndarray:
    """Returns the rotation wxyz that turns z to the unit vector `normal`."""
    x, y, z = normal
    if z < -1.0 + 1e-9:
        return np.array((0.0, 1.0, 0.0, 0.0))
    rotation = np.array((1.0 + z, -y, x, 0.0))
    return rotation / np.linalg.norm(rotation)


class Surfaces:
    """Draws each surface as a square around the point below the base, in the controller's base frame `base`."""

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
        center = normal * float(normal @ point)  # nearest to the base
        path = f"{self._base}/surface_{abs(hash(surface)):x}"
        return self._scene.add_box(path, dimensions=(SIZE, SIZE, 0.004), color=COLOR, opacity=OPACITY, position=center - 0.002 * normal,
                                   wxyz=turn_z_to(normal))

    def remove(self) -> None:
        self.show(())
