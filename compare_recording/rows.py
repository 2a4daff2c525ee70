"""Figures of a recording: what a robot and a simulator have in common, as numbers."""

from dataclasses import dataclass
from typing import Callable, Dict, List, Optional, Sequence, Tuple

import numpy as np
from robot_recording import ACTUAL, ACTUAL_SPEED, TARGET, TARGET_SPEED, Motion, motions, period, settled
from ur_ros_rtde_cli.recording import Recording
from ur_ros_rtde_cli.recording_figure import labels
from ur_ros_rtde_description.kinematics import Origin, flange_pose

TRACKED_SPEED = 0.05  # rad/s: slower joints show friction, not a lag
SETTLED_ERROR = 1e-4  # rad, some steps of the encoders
LEAST_ROWS = 20
TCP_POSE = "actual_TCP_pose"
POSES = 100  # that are compared
NOISY = (ACTUAL, ACTUAL_SPEED, "actual_current", "actual_TCP_force", TCP_POSE, "actual_tool_accelerometer")
DIGITS = 4


@dataclass(frozen=True)
class Row:
    name: str
    unit: str
    robot: Optional[float]  # None: not in this recording
    simulator: Optional[float]

    def text(self) -> str:
        ratio = "" if not self.robot or self.simulator is None else f"{self.simulator / self.robot:8.2f}"
        return f"  {self.name:34} {_number(self.robot)} {_number(self.simulator)} {ratio:8}  {self.unit}".rstrip()


def _number(value: Optional[float]) -> str:
    return f"{'-' if value is None else format(value, f'.{DIGITS}g'):>10}"


def _duration(recording: Recording, motion: Motion) -> float:
    return float(recording.times[motion.end] - recording.times[motion.begin])


def _largest_speed(recording: Recording, _motion: Motion) -> float:
    return float(np.abs(recording.outputs[TARGET_SPEED]).max())


def _lag(recording: Recording, _motion: Motion) -> Optional[float]:
    """Returns by how much the joints are later than their targets, ms: the slope of the error over the speed."""
    speed = recording.outputs[TARGET_SPEED]
    moving = np.abs(speed) > TRACKED_SPEED
    if moving.sum() < LEAST_ROWS:
        return None
    error = recording.outputs[ACTUAL] - recording.outputs[TARGET]
    return -1e3 * float(np.sum(error[moving] * speed[moving]) / np.sum(speed[moving] ** 2))


def _largest_error(recording: Recording, _motion: Motion) -> float:
    return float(np.abs(recording.outputs[ACTUAL] - recording.outputs[TARGET]).max())


def _rms_error(recording: Recording, _motion: Motion) -> Optional[float]:
    """Of the joints while they move, rad."""
    moving = np.abs(recording.outputs[TARGET_SPEED]) > TRACKED_SPEED
    if moving.sum() < LEAST_ROWS:
        return None
    return _rms((recording.outputs[ACTUAL] - recording.outputs[TARGET])[moving])


def _settling_time(recording: Recording, motion: Motion) -> Optional[float]:
    """Returns the time from the end of the target's motion until the joints stay within SETTLED_ERROR of where they end, s."""
    joints = recording.outputs[ACTUAL][motion.end:]
    if len(joints) < LEAST_ROWS:
        return None
    away = np.flatnonzero(np.abs(joints - joints[-LEAST_ROWS // 2:].mean(axis=0)).max(axis=1) > SETTLED_ERROR)
    return 0.0 if not len(away) else float((away[-1] + 1) * period(recording))


MOTION_FIGURES: Tuple[Tuple[str, str, Callable[[Recording, Motion], Optional[float]]], ...] = (
    ("duration of the target", "s", _duration), ("largest speed of a joint", "rad/s", _largest_speed),
    ("lag of the joints", "ms", _lag), ("rms error of moving joints", "rad", _rms_error),
    ("largest error of a joint", "rad", _largest_error), ("settling time", "s", _settling_time))


def motion_rows(robot: Recording, motion: Motion, simulator: Recording) -> List[Row]:
    same = next(iter(motions(simulator)), None)
    return [Row(name, unit, figure(robot, motion), None if same is None else figure(simulator, same))
            for name, unit, figure in MOTION_FIGURES]


def noise(recording: Recording, name: str) -> Optional[np.ndarray]:
    """Returns the standard deviation of each element of an output at rest, from the differences of successive rows."""
    rest = settled(recording)
    pairs = rest[1:] & rest[:-1]
    if name not in recording.outputs or pairs.sum() < LEAST_ROWS:
        return None
    return np.sqrt(np.mean(np.diff(recording.outputs[name], axis=0)[pairs] ** 2, axis=0) / 2.0)


def noise_rows(robot: Recording, simulator: Recording) -> List[Row]:
    rows = []
    for name in NOISY:
        found = noise(robot, name)
        if found is None:
            continue
        simulated = noise(simulator, name)
        units = (labels(name, len(found))[0].split(", ") * 2)[:2]
        for part, unit, text in ((slice(0, 3), units[0], "0-2"), (slice(3, 6), units[1], "3-5"))[:len(found) // 3]:
            rows.append(Row(f"noise {name} {text}", unit, _rms(found[part]), None if simulated is None else _rms(simulated[part])))
    return rows


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def time_rows(robot: Recording, simulator: Recording) -> List[Row]:
    def jitter(recording: Recording) -> float:
        return float(np.std(np.diff(recording.times)))

    figures: Dict[str, Callable[[Recording], float]] = {"period": period, "standard deviation of the period": jitter}
    return [Row(name, "s", figure(robot), figure(simulator)) for name, figure in figures.items()]


def pose_row(robot: Recording, simulator: Recording, origins: Sequence[Origin]) -> List[Row]:
    """How far the TCP strays from its place at the flange according to the nominal kinematics: the calibration of the arm."""
    if TCP_POSE not in robot.outputs:
        return []
    return [Row("TCP pose off the nominal kinematics", "m", _stray(robot, origins), _stray(simulator, origins))]


def _stray(recording: Recording, origins: Sequence[Origin]) -> float:
    joints, poses = recording.outputs[ACTUAL], recording.outputs[TCP_POSE]
    places = []
    for index in range(0, len(joints), max(1, len(joints) // POSES)):
        flange = flange_pose(origins, joints[index])
        places.append(flange[:3, :3].T @ (poses[index, :3] - flange[:3, 3]))
    return float(np.linalg.norm(places - np.median(places, axis=0), axis=1).max())
