"""Recordings of RTDE outputs as numpy arrays and pandas tables."""

import contextlib
import importlib
import os
import pathlib
import re
from collections.abc import Sequence
from types import TracebackType
from typing import Any

import numpy
from ur_ros_rtde_cli.record import remedy

from .connection import Answer, Connection, end_even_if_interrupted, ending, own_signals
from .errors import NoDriver

ANSWER_TIMEOUT = 10.0  # s, for the answer to an interrupted start


def read_recording(file: str | os.PathLike[str]) -> Any:
    """Returns a recording as structured array with a field for each RTDE output: `actual_q` has the shape (rows, 6)."""
    with open(file, encoding="utf-8") as lines:
        columns = lines.readline().strip().split(",")
        rows = lines.readlines()
    values = numpy.loadtxt(rows, delimiter=",", ndmin=2) if rows else numpy.empty((0, len(columns)))
    groups: dict[str, list[int]] = {}
    for index, column in enumerate(columns):
        groups.setdefault(_output(column, columns), []).append(index)
    kinds = [(name, float) if len(indices) == 1 else (name, float, (len(indices),)) for name, indices in groups.items()]
    recording = numpy.empty(len(values), kinds)
    for name, indices in groups.items():
        recording[name] = values[:, indices[0]] if len(indices) == 1 else values[:, indices]
    return recording


def _output(column: str, columns: Sequence[str]) -> str:
    """Returns the name of the RTDE output of a column: actual_q for actual_q_0."""
    match = re.fullmatch(r"(.+)_\d+", column)
    return match[1] if match and f"{match[1]}_0" in columns and f"{match[1]}_1" in columns else column


class Recording:
    """A recording that runs during a `with` block. `arm.record(...)` creates it."""

    def __init__(self, connection: Connection, file: str | os.PathLike[str], fields: Sequence[str], frequency: float):
        self._connection, self._fields, self._frequency = connection, list(fields), frequency
        self.file = pathlib.Path(file).absolute()
        self._name = f"the recording {self.file}"
        self.rows = 0  # number of rows, known at the end
        self.lost = 0  # number of packages that are missing in the file

    def __enter__(self) -> "Recording":
        done = Answer()
        try:
            with own_signals():
                self._connection.call("ur_ros_rtde_msgs/srv/StartRecording", "start_recording", done, filename=str(self.file),
                                      fields=self._fields, frequency=float(self._frequency))
            return self
        except BaseException:
            with own_signals(), ending(self._name):
                self._stop_if_started(done)
            raise

    def _stop_if_started(self, done: Answer) -> None:
        """After an interrupted start. If the start was rejected, a recording may be that of another client."""
        if done.cancel():
            return
        if not self._connection.wait(done, ANSWER_TIMEOUT):
            raise NoDriver(f"start_recording was not answered within {ANSWER_TIMEOUT:g} s; "
                           f"{remedy(self._connection.namespace)}")
        if done.result().success:
            self._stop()

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        with contextlib.nullcontext() if kind is None else ending(self._name):
            self._stop()

    def _stop(self) -> None:
        """Stops the recording, over another connection if that of the Robot is closed."""
        done = Answer()

        def request(connection: Connection) -> Any:
            nonlocal done
            done = Answer()
            return connection.call("ur_ros_rtde_msgs/srv/StopRecording", "stop_recording", done)

        def stop() -> None:
            response = self._connection.over_open_connection(request)
            self.rows, self.lost = response.rows, response.lost

        end_even_if_interrupted(self._name, stop, lambda: done.cancel())  # which succeeds if the request was not sent

    def read(self) -> Any:
        """Returns the recording as structured numpy array. The file must be on this host."""
        return read_recording(self.file)

    def to_pandas(self) -> Any:
        """Returns the recording as pandas.DataFrame with the columns of the file. The file must be on this host."""
        return importlib.import_module("pandas").read_csv(self.file)
