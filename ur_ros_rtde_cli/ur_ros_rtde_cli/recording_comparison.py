"""Compares two recordings of the same motion."""

import math
from dataclasses import dataclass, replace
from typing import Dict, List, Optional, Sequence

import numpy as np

from .errors import CliError
from .recording import Recording
from .recording_figure import labels

COARSE_STEPS = 400  # of the search for the shift, over its whole range
FINE_STEPS = 40  # within two coarse ones
LEAST_OVERLAP = 0.5  # of the shorter recording


@dataclass(frozen=True)
class Difference:
    largest: np.ndarray  # of the absolute difference, by element
    at: np.ndarray  # s, its time in the first recording
    rms: np.ndarray


@dataclass(frozen=True)
class Comparison:
    first: Recording
    second: Recording  # shifted
    shift: float  # s
    differences: Dict[str, Difference]


def at(recording: Recording, name: str, times: np.ndarray) -> np.ndarray:
    """Returns the values at these times, between two rows by interpolation."""
    return np.stack([np.interp(times, recording.times, column) for column in recording.outputs[name].T], axis=1)


def _overlap(first: Recording, second: Recording) -> np.ndarray:
    return first.times[(first.times >= second.times[0]) & (first.times <= second.times[-1])]


def _moved(recording: Recording, shift: float) -> Recording:
    return replace(recording, times=recording.times + shift, events=[(time + shift, text) for time, text in recording.events])


def _misfit(first: Recording, second: Recording, scales: Dict[str, float]) -> float:
    """Returns the mean squared difference, relative to the range of each output."""
    times = _overlap(first, second)
    if not len(times) or np.ptp(times) < LEAST_OVERLAP * min(np.ptp(first.times), np.ptp(second.times)):
        return math.inf
    kept = first.times.searchsorted(times)
    return sum(float(np.mean((at(second, name, times) - first.outputs[name][kept]) ** 2)) / scale**2 for name, scale in scales.items())


def best_shift(first: Recording, second: Recording) -> float:
    """Returns the time by which the second recording has to be moved to later so that the changing outputs fit best, s."""
    scales = {name: float(np.ptp(values, axis=0).max()) for name, values in first.outputs.items()}
    scales = {name: scale for name, scale in scales.items() if scale > 0.0 and math.isfinite(scale)}
    if not scales:
        return 0.0
    least = LEAST_OVERLAP * min(np.ptp(first.times), np.ptp(second.times))
    candidates = np.linspace(first.times[0] - second.times[-1] + least, first.times[-1] - second.times[0] - least, COARSE_STEPS + 1)
    for _ in range(2):
        misfits = [_misfit(first, _moved(second, shift), scales) for shift in candidates]
        best, step = float(candidates[int(np.argmin(misfits))]), float(candidates[1] - candidates[0])
        candidates = np.linspace(best - step, best + step, FINE_STEPS + 1)
    return round(best, 6)


def compare(first: Recording, second: Recording, names: Sequence[str], shift: Optional[float]) -> Comparison:
    common = [name for name in first.outputs if name in second.outputs]
    if not common:
        raise CliError(f"{first.name} and {second.name} have no output in common: {', '.join(first.outputs)}; {', '.join(second.outputs)}")
    first, second = first.select(names or common), second.select(names or common)
    for name, values in first.outputs.items():
        if values.shape[1] != second.outputs[name].shape[1]:
            raise CliError(f"{name} has {values.shape[1]} elements in {first.name}, {second.outputs[name].shape[1]} in {second.name}")
    given, shift = shift, best_shift(first, second) if shift is None else shift
    second = _moved(second, shift)
    times = _overlap(first, second)
    if not len(times):
        raise CliError("the recordings do not overlap in time" + ("" if given is None else f" with --shift {given:g}"))
    return Comparison(first, second, shift, {name: _difference(first, second, name, times) for name in first.outputs})


def _difference(first: Recording, second: Recording, name: str, times: np.ndarray) -> Difference:
    error = np.abs(at(second, name, times) - first.outputs[name][first.times.searchsorted(times)])
    return Difference(error.max(axis=0), times[error.argmax(axis=0)], np.sqrt(np.mean(error**2, axis=0)))


def report(comparison: Comparison) -> str:
    first, second = comparison.first, comparison.second
    rows = len(_overlap(first, second))
    lines: List[str] = [f"{second.name} is moved by {comparison.shift:+.3f} s; {rows} rows of {first.name} are compared", ""]
    lines += [f"{'output':28} {'largest':>10} {'at [s]':>8} {'rms':>10}  unit"]
    for name, difference in comparison.differences.items():
        unit, elements = labels(name, len(difference.rms))
        for element, largest, at, rms in zip(elements, difference.largest, difference.at, difference.rms):
            text = name if len(elements) == 1 else f"{name} {element}"
            lines.append(f"{text:28} {largest:10.4g} {at:8.3f} {rms:10.4g}  {unit}".rstrip())
    return "\n".join(lines)
