"""The values of the last seconds, in a bounded buffer."""

import numpy as np


class History:
    """A ring of rows [time, values…]. Its memory is allocated once."""

    def __init__(self, columns: int, rows: int):
        self._data = np.zeros((rows, columns))
        self._next = 0
        self._full = False

    def __len__(self) -> int:
        return len(self._data) if self._full else self._next

    def add(self, row: np.ndarray) -> None:
        self._data[self._next] = row
        self._next += 1
        if self._next == len(self._data):
            self._next, self._full = 0, True

    def rows(self, duration: float) -> np.ndarray:
        """Returns a copy of the rows of the last `duration` s before the newest one, in order."""
        data = np.vstack((self._data[self._next:], self._data[:self._next])) if self._full else self._data[:self._next].copy()
        return data[data[:, 0] >= data[-1, 0] - duration] if len(data) else data

    def clear(self) -> None:
        self._next, self._full = 0, False
