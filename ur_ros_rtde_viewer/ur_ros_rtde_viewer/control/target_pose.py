"""Plans a motion to a pose: inverse kinematics of the controller, and the path of the joints and of the TCP.

The path is what the command will do: move_j moves along a line in joint space, move_l along a line of the TCP.
"""

import math
from dataclasses import dataclass
from enum import Enum
from typing import Any, Callable, List, Optional, Sequence

import numpy as np

from ur_ros_rtde_msgs.action import GetInverseKinematics, MoveJ, MoveL

from .goals import Goals, Phase, SentGoal

JOINT_STEPS = 24  # of the preview of move_j
LINE_STEPS = 8  # queries for move_l
MAX_START_DISTANCE = 0.02  # rad, of the arm from the start of the plan when it is executed


class Motion(Enum):
    MOVE_J = "move_j: line in joint space"
    MOVE_L = "move_l: line of the TCP"


@dataclass(frozen=True)
class PoseTarget:
    """Pose of the TCP in the frame base."""

    position: np.ndarray  # m
    wxyz: np.ndarray


@dataclass(frozen=True)
class Plan:
    motion: Motion
    target: PoseTarget
    joint_path: Sequence[np.ndarray]  # rad, from the current to the target positions

    def goal(self, speed_fraction: float) -> Any:
        """Returns the goal that executes the plan. `speed_fraction` refers to the default speed of the command."""
        if self.motion == Motion.MOVE_J:
            goal = MoveJ.Goal(joint_positions=[float(value) for value in self.joint_path[-1]])
        else:
            goal = MoveL.Goal(identity_orientation=True)
            set_pose(goal.pose, self.target)
        goal.speed *= speed_fraction
        return goal

    @property
    def action(self) -> Any:
        return MoveJ if self.motion == Motion.MOVE_J else MoveL

    @property
    def name(self) -> str:
        return "move_j" if self.motion == Motion.MOVE_J else "move_l"

    def starts_at(self, positions: np.ndarray) -> bool:
        return bool(np.abs(positions - self.joint_path[0]).max() < MAX_START_DISTANCE)


def set_pose(pose: Any, target: PoseTarget) -> None:
    pose.position.x, pose.position.y, pose.position.z = map(float, target.position)
    pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z = map(float, target.wxyz)


def slerp(start: np.ndarray, end: np.ndarray, fraction: float) -> np.ndarray:
    """Returns the orientation on the shorter arc between two unit quaternions."""
    cosine = float(start @ end)
    if cosine < 0.0:
        end, cosine = -end, -cosine
    if cosine > 1.0 - 1e-9:
        return end
    angle = math.acos(cosine)
    return (math.sin((1.0 - fraction) * angle) * start + math.sin(fraction * angle) * end) / math.sin(angle)


def poses_on_line(start: PoseTarget, end: PoseTarget, steps: int) -> List[PoseTarget]:
    """Returns the poses after the start, the last of which is the end."""
    return [PoseTarget(start.position + fraction * (end.position - start.position), slerp(start.wxyz, end.wxyz, fraction))
            for fraction in np.linspace(0.0, 1.0, steps + 1)[1:]]


class Planner:
    """One planning. `on_end` receives the plan, or None and the reason, in the thread of the control node."""

    def __init__(self, goals: Goals, motion: Motion, joints: np.ndarray, tcp: PoseTarget, target: PoseTarget,
                 on_end: Callable[[Optional[Plan], str], None]):
        self._goals, self._motion, self._target, self._on_end = goals, motion, target, on_end
        self._solved: List[np.ndarray] = [joints]
        self._waiting = [target] if motion == Motion.MOVE_J else poses_on_line(tcp, target, LINE_STEPS)
        self._count = len(self._waiting)
        self._abandoned = False

    def start(self) -> None:
        goal = GetInverseKinematics.Goal(near=[float(value) for value in self._solved[-1]])
        set_pose(goal.pose, self._waiting[0])
        self._goals.send("get_inverse_kinematics", GetInverseKinematics, goal, self._on_change)

    def abandon(self) -> None:
        """Ends the planning without a call of `on_end`."""
        self._abandoned = True

    def _on_change(self, goal: SentGoal) -> None:
        if self._abandoned or not goal.has_ended:
            return
        if goal.phase != Phase.SUCCEEDED:
            share = 100.0 * (self._count - len(self._waiting) + 1) / self._count
            where = f"At {share:.0f} % of the line: " if self._motion == Motion.MOVE_L else ""
            self._on_end(None, where + goal.message)
            return
        self._solved.append(np.array(goal.result.joint_positions))
        self._waiting.pop(0)
        if self._waiting:
            self.start()
            return
        self._on_end(Plan(self._motion, self._target, self._path()), "")

    def _path(self) -> List[np.ndarray]:
        if self._motion == Motion.MOVE_L:
            return self._solved
        start, end = self._solved
        return [start + fraction * (end - start) for fraction in np.linspace(0.0, 1.0, JOINT_STEPS + 1)]
