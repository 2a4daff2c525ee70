"""Reads recordings: CSV files with the columns timestamp, NAME or NAME_0 ... NAME_n for each RTDE output, and event.

Commas separate the columns, or spaces as in the files of UR's RTDE client library.
"""

import csv
import pathlib
import re
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Dict, List, Mapping, Optional, Sequence, TextIO, Tuple

import numpy as np

from .errors import CliError

TIME, EVENT = "timestamp", "event"
ELEMENT = re.compile(r"(.+)_(\d+)")  # the column of an element of a vector


@dataclass(frozen=True)
class Recording:
    name: str
    times: np.ndarray  # s, from 0
    outputs: Dict[str, np.ndarray]  # one row per time, one column per element
    events: List[Tuple[float, str]]  # s, text

    @classmethod
    def read(cls, path: pathlib.Path, names: Mapping[str, str] = MappingProxyType({}), rate: Optional[float] = None) -> "Recording":
        """Reads a file. `names`: the column of an output that has another name there, of a vector without the number. `rate`: rows
        per second, instead of a column with time stamps."""
        try:
            with path.open(newline="") as file:
                rows = _rows(file)
        except (OSError, UnicodeDecodeError, csv.Error) as error:
            reason = error.strerror if isinstance(error, OSError) else "it is no text"
            raise CliError(f"{path} cannot be read: {reason}") from None
        header, rows = (_renamed(rows[0], names), rows[1:]) if rows else ([], [])
        if TIME not in header and rate is None:
            raise CliError(f"{path} has no column {TIME}: record with `ur record {path.name} {TIME} actual_q`")
        if len(rows) < 2:
            raise CliError(f"{path} has {len(rows)} rows: expected 2 or more")
        events = header.index(EVENT) if EVENT in header else None
        numbers = [index for index in range(len(header)) if index != events]
        values = np.array([_numbers(path, line, row, numbers, len(header)) for line, row in enumerate(rows, start=2)])
        columns = {header[index]: values[:, position] for position, index in enumerate(numbers)}
        times = np.arange(len(rows)) / rate if rate is not None else columns[TIME] - columns[TIME][0]
        columns.pop(TIME, None)
        if not columns:
            raise CliError(f"{path} has no output besides {TIME}: record with `ur record {path.name} {TIME} actual_q`")
        return cls(path.name, times, _outputs(columns), [] if events is None else
                   [(float(time), row[events]) for time, row in zip(times, rows) if row[events]])

    def first_step_back(self) -> Optional[int]:
        """Returns the first row whose time is earlier than that of the row before."""
        backwards = np.flatnonzero(np.diff(self.times) < 0.0)
        return int(backwards[0]) + 1 if backwards.size else None

    def select(self, names: Sequence[str]) -> "Recording":
        """Returns the recording with these outputs only; all if there are no names."""
        missing = [name for name in names if name not in self.outputs]
        if missing:
            raise CliError(f"{self.name} has no output {missing[0]}. It has: {', '.join(self.outputs)}")
        return replace(self, outputs={name: self.outputs[name] for name in names or self.outputs})


def _rows(file: TextIO) -> List[List[str]]:
    """Returns the rows that are not empty."""
    begin = file.readline()
    file.seek(0)
    separator = "," if "," in begin or " " not in begin.strip() else " "
    return [row for row in csv.reader(file, delimiter=separator, skipinitialspace=True) if row]


def _renamed(header: Sequence[str], names: Mapping[str, str]) -> List[str]:
    outputs = {column: output for output, column in names.items()}
    return [_renamed_column(column.strip(), outputs) for column in header]


def _renamed_column(column: str, outputs: Mapping[str, str]) -> str:
    match = ELEMENT.fullmatch(column)
    if column in outputs:
        return outputs[column]
    return f"{outputs[match[1]]}_{match[2]}" if match and match[1] in outputs else column


def _numbers(path: pathlib.Path, line: int, row: List[str], columns: Sequence[int], width: int) -> List[float]:
    if len(row) != width:
        raise CliError(f"{path}:{line} has {len(row)} values: expected {width}, as in the first line")
    try:
        return [float(row[column]) for column in columns]
    except ValueError as error:
        raise CliError(f"{path}:{line}: {error}") from None


def _outputs(columns: Dict[str, np.ndarray]) -> Dict[str, np.ndarray]:
    """Joins the elements of vectors: actual_q_0 ... actual_q_5 are actual_q."""
    elements: Dict[str, List[np.ndarray]] = {}
    for column, values in columns.items():
        match = ELEMENT.fullmatch(column)
        name = match[1] if match and int(match[2]) == len(elements.get(match[1], [])) else column
        elements.setdefault(name, []).append(values)
    return {name: np.stack(vectors, axis=1) for name, vectors in elements.items()}


def beside(path: pathlib.Path, ending: str = "") -> pathlib.Path:
    """Returns the name of a figure beside a recording."""
    if path.is_dir():
        folder = path.resolve()  # "." has no name
        return folder.with_name(f"{folder.name}{ending}.png")
    return path.with_name(f"{path.stem}{ending}.png")


def read(path: pathlib.Path) -> Recording:
    """Reads a CSV file, or a recording of rosbag2."""
    from .bag import is_bag, read_bag  # they need Recording
    return read_bag(path) if is_bag(path) else Recording.read(path)
