"""A motion over time, and its readers: CSV files of `ur record` and plans of `./ur plan --json`."""

import csv
import io
import json
import math
import pathlib
from dataclasses import dataclass
from typing import Callable, Iterable, Iterator, List, Sequence

import numpy as np

from ..errors import ViewerError

JOINT_COUNT = 6
FIELDS = ("actual_q", "target_q")  # RTDE outputs with joint positions; the first that a recording contains is shown
FRAME_RATE = 500.0  # Hz, of a recording without the column timestamp
MAX_BYTES = 200e6


@dataclass(frozen=True)
class Motion:
    name: str
    times: np.ndarray  # s, from 0, not decreasing
    positions: np.ndarray  # rad, one row per time

    @property
    def duration(self) -> float:
        return float(self.times[-1])

    def at(self, time: float) -> np.ndarray:
        """Returns the joint positions at a time, linearly interpolated and limited to the motion."""
        index = int(np.clip(np.searchsorted(self.times, time) - 1, 0, len(self.times) - 2))
        span = self.times[index + 1] - self.times[index]
        fraction = float(np.clip((time - self.times[index]) / span, 0.0, 1.0)) if span > 0.0 else 1.0
        return (1.0 - fraction) * self.positions[index] + fraction * self.positions[index + 1]


def _motion(name: str, times: np.ndarray, positions: np.ndarray) -> Motion:
    if len(times) < 2:
        raise ViewerError(f"{name} has {len(times)} rows with joint positions: expected 2 or more")
    if not (np.isfinite(times).all() and np.isfinite(positions).all()):
        raise ViewerError(f"{name} contains a value that is no finite number")
    if (np.diff(times) < 0.0).any():
        row = int(np.argmax(np.diff(times) < 0.0)) + 1
        raise ViewerError(f"{name}: the time of row {row + 1} is earlier than that of the row before: is it a recording of one robot?")
    return Motion(name, times - times[0], positions)


def read_file(path: pathlib.Path, ended: Callable[[], bool]) -> Motion:
    """As read_csv()."""
    try:
        _check_size(path.name, path.stat().st_size)
        content = path.read_bytes()
    except OSError as error:
        raise ViewerError(f"{path} cannot be read: {error.strerror}") from None
    return read_csv(path.name, content, ended)


def read_csv(name: str, content: bytes, ended: Callable[[], bool] = lambda: False) -> Motion:
    """Reads a recording with timestamp and actual_q or target_q. Raises ViewerError with the line, the value and the remedy, or after
    `ended()`."""
    _check_size(name, len(content))
    try:
        rows = csv.reader(io.StringIO(content.decode("utf-8"), newline=""))
        header = next(rows, [])
        columns = _columns(name, header)
        if "timestamp" in header:
            columns.append(header.index("timestamp"))
        numbers = list(_numbers(name, _until(ended, rows), columns, len(header)))
    except UnicodeDecodeError:
        raise ViewerError(f"{name} is no text: expected a CSV file of `ur record`") from None
    except csv.Error as error:
        raise ViewerError(f"{name} is no CSV file: {error}") from None
    data = np.array(numbers).reshape(-1, len(columns))
    times = data[:, JOINT_COUNT] if "timestamp" in header else np.arange(len(data)) / FRAME_RATE
    return _motion(name, times, data[:, :JOINT_COUNT])


def _check_size(name: str, size: int) -> None:
    if size > MAX_BYTES:
        raise ViewerError(f"{name} has {size / 1e6:.0f} MB: at most {MAX_BYTES / 1e6:.0f} MB are shown; record with --frequency")


def _until(ended: Callable[[], bool], rows: Iterable[List[str]]) -> Iterator[List[str]]:
    for row in rows:
        if ended():
            raise ViewerError("the page was closed")
        yield row


def _columns(name: str, header: Sequence[str]) -> List[int]:
    for field in FIELDS:
        names = [f"{field}_{joint}" for joint in range(JOINT_COUNT)]
        if all(column in header for column in names):
            return [header.index(column) for column in names]
    raise ViewerError(f"{name} has no columns actual_q_0 … actual_q_5: record with `ur record FILE timestamp actual_q`")


def _numbers(name: str, rows: Iterator[List[str]], columns: Sequence[int], width: int) -> Iterator[List[float]]:
    for line, row in enumerate(rows, start=2):
        if len(row) != width:
            raise ViewerError(f"{name}:{line} has {len(row)} values: expected {width}, as in the first line")
        try:
            yield [float(row[column]) for column in columns]
        except ValueError:
            wrong = next(row[column] for column in columns if not _is_number(row[column]))
            raise ViewerError(f"{name}:{line}: \"{wrong}\" is no number") from None


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def read_plan(name: str, text: str) -> Motion:
    """Reads the samples of a plan. Raises ViewerError if the text is no plan."""
    try:
        samples = json.loads(text)["samples"]
        times, positions = np.array(samples["time"], float), np.array(samples["position"], float)
        if times.ndim != 1:
            raise ValueError
    except (ValueError, KeyError, TypeError, OverflowError):
        raise ViewerError(f"{name} is no plan: write one with `./ur plan FILE --json {name}`") from None
    if positions.ndim != 2 or positions.shape != (len(times), JOINT_COUNT):
        raise ViewerError(f"{name}: samples.position has the shape {positions.shape}: expected {len(times)} rows of {JOINT_COUNT}")
    return _motion(name, times, positions)
