"""The calibration of an arm from the Denavit-Hartenberg parameters that its controller reports."""

import math
import pathlib
from dataclasses import dataclass
from typing import Optional, Protocol, Sequence, Tuple

import numpy as np
import yaml

from .calibration import FIELDS, JOINT_KEYS, check_model, largest_deviation, read_calibration
from .errors import DescriptionError
from .kinematics import Origin, nominal_origins, rotation
from .kinematics_hash import kinematics_hash
from .models import Model, find_model

# Two reports of one calibration agree far better than this. The repeatability of the arms is 3e-5 m to 1e-4 m.
NEGLIGIBLE_DISTANCE = 5e-5  # m
NEGLIGIBLE_ANGLE = 5e-5  # rad


class DhParameters(Protocol):
    """Rows of six joints: Rz(q + theta) Tz(d) Tx(a) Rx(alpha), in m and rad."""

    @property
    def theta(self) -> Sequence[float]: ...

    @property
    def a(self) -> Sequence[float]: ...

    @property
    def d(self) -> Sequence[float]: ...

    @property
    def alpha(self) -> Sequence[float]: ...


@dataclass(frozen=True)
class Deviation:
    """Largest deviation of the flange at the compared joint positions."""

    distance: float  # m
    angle: float  # rad

    def is_negligible(self) -> bool:
        return self.distance <= NEGLIGIBLE_DISTANCE and self.angle <= NEGLIGIBLE_ANGLE


def origins_from_dh(dh: DhParameters, model: Model) -> Tuple[Origin, ...]:
    """Returns the origins of the joints. Raises DescriptionError if the parameters are invalid or belong to another model.

    The axes of joints 2 to 4 are almost parallel. A calibration therefore may place the points where they meet their common normals
    many meters away, with d of opposite signs. A joint frame may move along its axis without an effect on the flange, so each one is
    placed next to its nominal position.
    """
    if not np.isfinite([dh.theta, dh.a, dh.d, dh.alpha]).all():
        raise DescriptionError("the controller reports kinematics with values that are no finite numbers")
    if abs(dh.a[5]) > 1e-9 or abs(dh.alpha[5]) > 1e-9:
        raise DescriptionError(f"the controller reports a = {dh.a[5]} m and alpha = {dh.alpha[5]} rad of joint 6: the format of "
                               "ur_description has no field for them")
    nominal = _positions(nominal_origins(model))
    frames = _joint_frames(dh)
    for frame, position in list(zip(frames, nominal))[:-1]:  # the last one is the flange
        axis = frame[:3, 2]
        frame[:3, 3] += axis * (axis @ (position - frame[:3, 3]))
    previous = [np.eye(4), *frames[:-1]]
    origins = tuple(_origin(np.linalg.inv(before) @ frame) for before, frame in zip(previous, frames))
    check_model("the controller", origins, model)
    return origins


def deviation(dh: DhParameters, model: str, file: Optional[pathlib.Path]) -> Deviation:
    """Compares the kinematics of a controller with a calibration file, or with the nominal kinematics without one."""
    found = find_model(model)
    described = read_calibration(file, found) if file else nominal_origins(found)
    return Deviation(*largest_deviation(origins_from_dh(dh, found), described))


def calibration_yaml(dh: DhParameters, model: Model, comment: str = "") -> str:
    """Returns the content of a kinematics file of ur_description."""
    joints = {key: dict(zip(FIELDS, map(float, (*origin.xyz, *origin.rpy))))
              for key, origin in zip(JOINT_KEYS, origins_from_dh(dh, model))}
    content = {"kinematics": {**joints, "hash": kinematics_hash(dh.theta, dh.d, dh.a, dh.alpha)}}
    return "".join(f"# {line}\n" for line in comment.splitlines()) + yaml.safe_dump(content, sort_keys=False)


def _joint_frames(dh: DhParameters) -> Sequence[np.ndarray]:
    """Returns the frame of each joint at the joint positions 0, after its own theta and d; z is the axis of the joint."""
    frames, pose = [], np.eye(4)
    for theta, a, d, alpha in zip(dh.theta, dh.a, dh.d, dh.alpha):
        pose = pose @ Origin((0.0, 0.0, d)).transform()
        pose[:3, :3] = pose[:3, :3] @ rotation(2, theta)
        frames.append(pose)
        pose = pose @ Origin((a, 0.0, 0.0)).transform()
        pose[:3, :3] = pose[:3, :3] @ rotation(0, alpha)
    return frames


def _positions(origins: Sequence[Origin]) -> Sequence[np.ndarray]:
    pose, positions = np.eye(4), []
    for origin in origins:
        pose = pose @ origin.transform()
        positions.append(pose[:3, 3])
    return positions


def _origin(transform: np.ndarray) -> Origin:
    matrix = transform[:3, :3]
    roll = math.atan2(matrix[2, 1], matrix[2, 2])
    pitch = math.atan2(-matrix[2, 0], math.hypot(matrix[0, 0], matrix[1, 0]))
    yaw = math.atan2(matrix[1, 0], matrix[0, 0])
    x, y, z = map(float, transform[:3, 3])
    return Origin((x, y, z), (roll, pitch, yaw))
