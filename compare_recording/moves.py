"""Recognizes movej and movel in the targets of a recording: a trapezoidal speed along a line in joint space, or of the tool.

When a program starts, its trajectory time starts slowly: the speed scaling grows from 0 to 1 within START_RAMP.
"""

import math
from dataclasses import dataclass
from typing import Optional, Sequence, Tuple, Union

import numpy as np
from robot_recording import TARGET, Motion, period
from ur_ros_rtde_cli.recording import Recording
from ur_ros_rtde_cli.recording_comparison import at
from ur_ros_rtde_description.kinematics import Origin, flange_pose

LEAST_PATH = {"movej": 0.02, "movel": 0.005}  # rad, m: shorter motions show no profile
MOST_MISFIT = {"movej": 2e-3, "movel": 5e-4}  # rad, m
MOST_ROTATION = 5e-3  # rad, of the tool in a movel, computed without the calibration of the arm
ITERATIONS = 30
START_RAMP = 0.16  # s
LEAST_ROWS = 6  # of a motion, to recognize its profile


@dataclass(frozen=True)
class Move:
    """`velocity` and `acceleration` are the arguments of the call: of the joint with the longest path in rad, or of the tool in m."""

    kind: str
    velocity: float
    acceleration: float
    last: Tuple[float, ...]  # rad, joints
    misfit: float  # largest, rad of a joint or m of the tool
    cruises: bool  # reaches its velocity
    starts_program: bool  # is the first motion of a program

    @property
    def script(self) -> str:
        wait = "" if self.starts_program else f"  sleep({2.0 * START_RAMP})\n"
        return f"{wait}  {self.kind}({_list(self.last)}, a={self.acceleration:.5f}, v={self.velocity:.5f})\n"

    def __str__(self) -> str:
        unit = "m" if self.kind == "movel" else "rad"
        notes = ("" if self.cruises else " (not reached)") + (", at the start of a program" if self.starts_program else "")
        return (f"{self.kind}, a={self.acceleration:.4g} {unit}/s², v={self.velocity:.4g} {unit}/s{notes}, "
                f"misfit {self.misfit:.2g} {unit}")


@dataclass(frozen=True)
class Track:
    """Any other motion: the simulator follows the targets by servoj."""

    targets: np.ndarray  # rad, one row per period
    period: float  # s

    @property
    def script(self) -> str:
        settings = f"t={self.period:.4f}, lookahead_time=0.03, gain=2000"
        return "".join(f"  servoj({_list(row)}, {settings})\n" for row in self.targets) + "  stopj(2)\n"

    def __str__(self) -> str:
        return "neither movej nor movel; the simulator follows it by servoj"


def _list(joints: Sequence[float]) -> str:
    return "[" + ", ".join(f"{joint:.6f}" for joint in joints) + "]"


def trapezoid(times: np.ndarray, distance: float, velocity: float, acceleration: float) -> np.ndarray:
    """Returns the way at each time after the start."""
    top = min(velocity, math.sqrt(distance * acceleration))
    ramp = top / acceleration
    duration = distance / top + ramp
    time = np.clip(times, 0.0, duration)
    return np.where(time < ramp, 0.5 * acceleration * time**2,
                    np.where(time < duration - ramp, top * (time - 0.5 * ramp), distance - 0.5 * acceleration * (duration - time) ** 2))


def _trajectory_time(times: np.ndarray, starts_program: bool) -> np.ndarray:
    ramp = START_RAMP if starts_program else 0.0
    return np.where(times < ramp, np.maximum(times, 0.0) ** 2 / (2.0 * START_RAMP), times - 0.5 * ramp)


def _fit(times: np.ndarray, way: np.ndarray, start: float, starts_program: bool) -> Tuple[float, float, float]:
    """Returns start, velocity and acceleration of the trapezoid that fits best (Gauss-Newton, damped)."""
    distance = way[-1]
    top = float(np.gradient(way, times).max())
    duration = times[-1] - start
    ramp = max(duration - distance / top, 0.05 * duration)
    found = np.array([start, math.log(top), math.log(top / ramp)])

    def error(values: np.ndarray) -> np.ndarray:
        return trapezoid(_trajectory_time(times - values[0], starts_program), distance, math.exp(values[1]), math.exp(values[2])) - way

    damping = 1e-3
    for _ in range(ITERATIONS):
        now = error(found)
        slopes = np.stack([(error(found + step) - now) / step.max() for step in 1e-6 * np.eye(3)], axis=1)
        normal = slopes.T @ slopes
        step = np.linalg.solve(normal + damping * np.diag(np.diag(normal) + 1e-12), -slopes.T @ now)
        better = np.sum(error(found + step) ** 2) < np.sum(now**2)
        found, damping = (found + step, damping / 3) if better else (found, damping * 5)
    return float(found[0]), math.exp(found[1]), math.exp(found[2])


def _move(kind: str, times: np.ndarray, joints: np.ndarray, points: np.ndarray, starts_program: bool) -> Optional[Move]:
    """`points`: positions in the space in which the motion may be a line, one row for each time."""
    line = points[-1] - points[0]
    lead = int(np.abs(line).argmax())
    distance = float(np.linalg.norm(line)) if kind == "movel" else abs(float(line[lead]))
    if distance < LEAST_PATH[kind]:
        return None
    way = (points - points[0]) @ line / np.dot(line, line) * distance
    start, velocity, acceleration = _fit(times, way, times[1], starts_program)
    fitted = trapezoid(_trajectory_time(times - start, starts_program), distance, velocity, acceleration)
    misfit = float(np.abs(points - points[0] - fitted[:, None] / distance * line).max())
    if misfit > MOST_MISFIT[kind]:
        return None
    top = math.sqrt(distance * acceleration)
    return Move(kind, min(velocity, top), acceleration, tuple(map(float, joints[-1])), misfit, velocity < top, starts_program)


def recognize(recording: Recording, motion: Motion, origins: Sequence[Origin]) -> Union[Move, Track]:
    rows = slice(motion.begin, motion.end + 1)
    times, joints = recording.times[rows], recording.outputs[TARGET][rows]
    poses = np.array([flange_pose(origins, row) for row in joints])
    rotation = math.acos(min(1.0, max(-1.0, (np.trace(poses[0, :3, :3].T @ poses[-1, :3, :3]) - 1.0) / 2.0)))
    candidates = []
    for starts_program in (False, True) if len(times) >= LEAST_ROWS else ():
        candidates.append(_move("movej", times, joints, joints, starts_program))
        if rotation < MOST_ROTATION:
            candidates.append(_move("movel", times, joints, poses[:, :3, 3], starts_program))
    found = [move for move in candidates if move is not None]
    if found:
        return min(found, key=lambda move: move.misfit / MOST_MISFIT[move.kind])
    step = period(recording)  # regular, unlike the rows: a connection loses packages
    return Track(at(recording, TARGET, np.arange(times[0], times[-1], step)), step)
