"""The newest values of one robot, without ROS types. The ROS side writes them, scene and panels read them."""

from collections import deque
from dataclasses import dataclass, field
from typing import Deque, Optional, Tuple

import numpy as np

MAX_REJECTIONS = 20
SILENT = 1.0  # s without joint states
OTHER_MODES = ("", "NORMAL", "REDUCED", "RECOVERY", "VALIDATE_JOINT_ID", "UNDEFINED", "PROFISAFE_WAITING_FOR_PARAMETERS")  # than a stop


@dataclass(frozen=True)
class Joints:
    """One message with joint states. Order: shoulder_pan, shoulder_lift, elbow, wrist_1, wrist_2, wrist_3."""

    stamp: float  # s
    positions: np.ndarray  # rad
    velocities: np.ndarray  # rad/s
    efforts: np.ndarray  # N m


@dataclass(frozen=True)
class Pose:
    position: np.ndarray  # m
    wxyz: np.ndarray  # unit quaternion


@dataclass(frozen=True)
class Signals:
    """Inputs and outputs. Digital ones by pin: 0-7 standard, 8-15 configurable, 16-17 tool. Analog ones of the control box, in A or V."""

    digital_inputs: Tuple[bool, ...]
    digital_outputs: Tuple[bool, ...]
    analog_inputs: Tuple[float, ...]
    analog_outputs: Tuple[float, ...]


@dataclass(frozen=True)
class DriverStatus:
    name: str  # "READY"
    cause: int  # ErrorCode
    message: str  # cause and remedy


@dataclass(frozen=True)
class ActiveGoal:
    action: str  # "move_j"
    progress: float  # 0 to 1; 0 if the end is not known
    elapsed: float  # s


@dataclass(frozen=True)
class Rejection:
    stamp: float  # s
    action: str
    message: str


@dataclass
class RobotState:
    """None and empty texts stand for values that were never received."""

    joints: Optional[Joints] = None  # joint_states: the real or the fake joints
    joint_states_are_fake: bool = False
    actual_joints: Optional[Joints] = None  # actual_joint_states; received only while joint_states are fake
    target_joints: Optional[Joints] = None
    tcp_pose: Optional[Pose] = None  # in base
    wrench: Optional[np.ndarray] = None  # N, N m, in the TCP frame
    signals: Optional[Signals] = None
    robot_mode: str = ""
    safety_mode: str = ""
    program_running: Optional[bool] = None
    speed_scaling: Optional[float] = None
    driver: Optional[DriverStatus] = None
    active_modes: Tuple[str, ...] = ()  # "freedrive", ...
    goal: Optional[ActiveGoal] = None
    rejections: Deque[Rejection] = field(default_factory=lambda: deque(maxlen=MAX_REJECTIONS))
    model: str = ""  # that the driver reports
    other_drivers: Tuple[str, ...] = ()  # namespaces of drivers that the page does not show; before the first joint states only
    address: str = ""  # of the controller, that the driver reports
    age: float = float("inf")  # s, since the last joint state was received
    pose_age: float = float("inf")  # s, since the last tcp_pose was received

    @property
    def is_silent(self) -> bool:
        """Whether no joint states have arrived for some time."""
        return self.age > SILENT

    @property
    def is_current(self) -> bool:
        """Whether the position is that of the arm now. The driver publishes fake joint states also without a robot, but no TCP pose."""
        return max(self.age, self.pose_age) <= SILENT

    @property
    def is_stopped(self) -> bool:
        """Whether a safety function has stopped the arm."""
        return self.safety_mode not in OTHER_MODES
