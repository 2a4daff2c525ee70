"""The surfaces of a simulated world."""

from typing import Any, Dict, Optional, Sequence, Tuple

import numpy as np
import viser

SIZE = 0.7  # m, of the drawn part of a plane
LARGEST_OFFSET = 0.3  # m, of the TCP from the center of this part, along the plane
LEAST_FROM_BASE = 0.5 ** 0.5 * SIZE + 0.1  # m, of the center: half of the diagonal, and the arm's base
THICKNESS = 0.006  # m
COLOR, OPACITY = (190, 150, 105), 0.75

Surface = Tuple[Tuple[float, ...], Tuple[float, ...]]  # point in m and unit normal, both in the base frame


def turn_z_to(normal: Sequence[float]) -> np.ndarray:
    """Returns the rotation wxyz that turns z to the unit vector `normal`."""
    x, y, z = normal
    if z < -1.0 + 1e-9:
        return np.array((0.0, 1.0, 0.0, 0.0))
    rotation = np.array((1.0 + z, -y, x, 0.0))
    return rotation / np.linalg.norm(rotation)


def _center(point: np.ndarray, normal: np.ndarray, tcp: np.ndarray) -> np.ndarray:
    """Returns the point of the plane next to the TCP, or one farther away from the base, so that the square does not cut the arm's base."""
    below_base, center = (near - normal * float(normal @ (near - point)) for near in (np.zeros(3), tcp))
    distance = float(np.linalg.norm(center - below_base))
    return center if distance == 0.0 else below_base + (center - below_base) * max(1.0, LEAST_FROM_BASE / distance)


class Surfaces:
    """Draws of each plane a square near the TCP, in the controller's base frame `base`. The simulated planes are infinite; the whole
    of them would hide the arm."""

    def __init__(self, scene: viser.SceneApi, base: str):
        self._scene, self._base = scene, base
        self._drawn: Dict[Surface, Any] = {}
        self._centers: Dict[Surface, np.ndarray] = {}

    def __len__(self) -> int:
        return len(self._drawn)

    def show(self, surfaces: Sequence[Surface], tcp: Optional[np.ndarray] = None) -> None:
        """`tcp` is the position of the TCP in the base frame, if it is known."""
        for gone in set(self._drawn) - set(surfaces):
            self._drawn.pop(gone).remove()
            del self._centers[gone]
        for surface in surfaces:
            point, normal = (np.array(part) for part in surface)
            center = _center(point, normal, np.zeros(3) if tcp is None else tcp)
            if surface not in self._drawn:
                self._drawn[surface] = self._draw(surface, normal)
            elif np.linalg.norm(center - self._centers[surface]) < LARGEST_OFFSET:
                continue
            self._centers[surface] = center
            self._drawn[surface].position = center - 0.5 * THICKNESS * normal

    def _draw(self, surface: Surface, normal: np.ndarray) -> Any:
        path = f"{self._base}/surface_{abs(hash(surface)):x}"
        return self._scene.add_box(path, dimensions=(SIZE, SIZE, THICKNESS), color=COLOR, opacity=OPACITY, wxyz=turn_z_to(normal))

    def remove(self) -> None:
        self.show(())
