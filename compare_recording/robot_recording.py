"""Reads recordings of robots that other programs made."""

import pathlib
from dataclasses import dataclass
from typing import Dict, Optional, Tuple

import numpy as np
from ur_ros_rtde_cli.errors import CliError
from ur_ros_rtde_cli.recording import Recording

ACTUAL, TARGET, ACTUAL_SPEED, TARGET_SPEED = "actual_q", "target_q", "actual_qd", "target_qd"
REST_SPEED = 1e-3  # rad/s of a target
REST = 0.5  # s of rest that is compared with a motion
SETTLED = 0.3  # s at rest before an arm counts as settled


@dataclass(frozen=True)
class Motion:
    """Rows of a recording from the last one at rest to the first one at rest again."""

    begin: int
    end: int


def read(path: pathlib.Path, names: Dict[str, str], rate: Optional[float]) -> Recording:
    """Reads a recording. `names`: the column, or its name without _0 to _5, of an output with another name. `rate`, in Hz, replaces
    the time stamps."""
    recording = Recording.read(path, names, rate)
    for name in (ACTUAL, TARGET):
        if name not in recording.outputs or recording.outputs[name].shape[1] != 6:
            raise CliError(f"{path} has no {name}_0 to {name}_5: name the columns with --column {name}=COLUMN. It has: "
                           f"{', '.join(recording.outputs)}")
    if period(recording) <= 0.0:
        raise CliError(f"{path} has time stamps that do not increase from row to row: give the rows per second with --rate")
    if TARGET_SPEED not in recording.outputs:
        recording.outputs[TARGET_SPEED] = np.gradient(recording.outputs[TARGET], recording.times, axis=0)
    return recording


def period(recording: Recording) -> float:
    return float(np.median(np.diff(recording.times)))


def _moves(recording: Recording) -> np.ndarray:
    return np.abs(recording.outputs[TARGET_SPEED]).max(axis=1) > REST_SPEED


def motions(recording: Recording) -> Tuple[Motion, ...]:
    """Returns the motions that begin and end within the recording; if it has no rest, all of it is one."""
    edges = np.diff(_moves(recording).astype(int))
    begins, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) + 1
    if len(begins) and len(ends) and ends[0] <= begins[0]:
        ends = ends[1:]
    complete = tuple(Motion(int(begin), int(end)) for begin, end in zip(begins, ends))
    return complete or ((Motion(0, len(recording.times) - 1),) if _moves(recording).all() else ())


def with_rest(recording: Recording, motion: Motion) -> Tuple[Recording, Motion]:
    """Returns the rows of a motion and of at most REST s of rest before and after it, with times from 0, and the motion in them."""
    moves, count = _moves(recording), round(REST / period(recording))
    begin, end = motion.begin, motion.end
    while begin > max(motion.begin - count, 0) and not moves[begin - 1]:
        begin -= 1
    while end < min(motion.end + count, len(moves) - 1) and not moves[end + 1]:
        end += 1
    rows = slice(begin, end + 1)
    times = recording.times[rows] - recording.times[begin]
    outputs = {name: values[rows] for name, values in recording.outputs.items()}
    return Recording(recording.name, times, outputs, []), Motion(motion.begin - begin, motion.end - begin)


def settled(recording: Recording) -> np.ndarray:
    """Returns the rows before which the arm has been at rest for SETTLED s."""
    moved_at = np.where(_moves(recording), recording.times, -np.inf)
    return recording.times - np.maximum.accumulate(np.concatenate(([recording.times[0] - SETTLED], moved_at)))[1:] >= SETTLED
