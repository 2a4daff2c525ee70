"""The path of the TCP during the last seconds, as line segments."""

import time
from typing import Any, Optional

import numpy as np
import viser

POINTS = 300
SPACING = 0.004  # m between two points
PERIOD = 0.1  # s between two updates: each one sends the whole trail
COLOR = (30, 170, 90)


class Trail:
    """A bounded line. Its points are at least SPACING apart, so that an arm at rest adds none."""

    def __init__(self, scene: viser.SceneApi, path: str):
        self._points = np.empty((0, 3), np.float32)
        self._drawn: float = -np.inf
        self._changed = False
        self._scene, self._path = scene, path
        self._line: Optional[Any] = None

    @property
    def points(self) -> np.ndarray:
        return self._points

    def add(self, position: np.ndarray) -> None:
        if not len(self._points) or np.linalg.norm(position - self._points[-1]) >= SPACING:
            self._points = np.vstack((self._points[-(POINTS - 1):], position.astype(np.float32)[None]))
            self._changed = True
        if self._changed and len(self._points) > 1 and time.monotonic() - self._drawn >= PERIOD:
            self._draw()

    def clear(self) -> None:
        self._points = np.empty((0, 3), np.float32)
        self.remove()

    def _draw(self) -> None:
        segments = np.stack((self._points[:-1], self._points[1:]), axis=1)
        if self._line is None:
            self._line = self._scene.add_line_segments(self._path, segments, COLOR, thickness=0.004)
        else:
            self._line.points = segments
        self._drawn, self._changed = time.monotonic(), False

    def remove(self) -> None:
        if self._line is not None:
            self._line.remove()
            self._line = None
