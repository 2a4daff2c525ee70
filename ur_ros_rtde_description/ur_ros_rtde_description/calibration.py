"""Reads the calibration of an arm: the kinematics file of ur_description, as ur_calibration extracts it from a controller."""

import math
import pathlib
from typing import Any, Dict, Sequence, Tuple

import numpy as np
import yaml

from .errors import DescriptionError, nearest
from .kinematics import Origin, flange_pose, nominal_origins
from .models import Model, models

JOINT_KEYS = ("shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3")  # the child links of the six joints
FIELDS = ("x", "y", "z", "roll", "pitch", "yaw")
# The deviation of a calibrated arm from its model is some millimeters at most. The driver identifies models with the same limits.
MAX_DISTANCE = 0.015  # m
MAX_ANGLE = 0.03  # rad
# Joint positions in rad at which the flange is compared. Together they show a difference in each length.
COMPARED_POSITIONS = ((0.0, -1.6, 1.5, -1.5, -1.6, 0.0), (0.4, -0.8, 0.6, 0.3, 1.5, 1.0), (-1.0, 0.0, 0.0, 0.0, 0.0, 0.0),
                      (0.0, -1.6, 0.0, -1.6, 0.0, 0.0), (0.7, -2.2, -1.8, 0.9, -0.2, 2.0))


def read_calibration(file: pathlib.Path, model: Model) -> Tuple[Origin, ...]:
    """Returns the origins of the six joints. Raises DescriptionError if the file is invalid or belongs to another model."""
    kinematics = _mapping(file, "kinematics", _mapping(file, "", _load(file)).get("kinematics"))
    unknown = sorted(set(map(str, kinematics)) - {*JOINT_KEYS, "hash"})
    if unknown:
        raise DescriptionError(f"{file}: kinematics has the unknown field {unknown[0]}; {nearest(unknown[0], JOINT_KEYS)}The fields are: "
                               f"{', '.join(JOINT_KEYS)}, hash")
    origins = tuple(_origin(file, key, kinematics) for key in JOINT_KEYS)
    check_model(str(file), origins, model)
    return origins


def _load(file: pathlib.Path) -> Any:
    try:
        return yaml.safe_load(file.read_text())
    except (OSError, UnicodeDecodeError) as error:
        raise DescriptionError(f"kinematics_params_file is \"{file}\": {getattr(error, 'strerror', None) or 'not a text file'}") from None
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        raise DescriptionError(f"{file}{f':{mark.line + 1}' if mark else ''}: not YAML: {getattr(error, 'problem', error)}") from None


def _mapping(file: pathlib.Path, field: str, value: Any) -> Dict[str, Any]:
    if isinstance(value, dict):
        return value
    if value is None and field:
        raise DescriptionError(f"{file}: the field {field} is missing. The file must have the format of config/<model>/"
                               "default_kinematics.yaml of ur_description; ur_calibration extracts it from a robot")
    raise DescriptionError(f"{file}: {field or 'the content'} is {value!r}, it must be a mapping")


def _origin(file: pathlib.Path, key: str, kinematics: Dict[str, Any]) -> Origin:
    values = _mapping(file, f"kinematics.{key}", kinematics.get(key))
    unknown = sorted(set(map(str, values)) - set(FIELDS))
    if unknown:
        raise DescriptionError(f"{file}: kinematics.{key} has the unknown field {unknown[0]}; the fields are: {', '.join(FIELDS)}")
    x, y, z, roll, pitch, yaw = (_number(file, f"kinematics.{key}.{field}", values.get(field)) for field in FIELDS)
    return Origin((x, y, z), (roll, pitch, yaw))


def _number(file: pathlib.Path, field: str, value: Any) -> float:
    if value is None:
        raise DescriptionError(f"{file}: the field {field} is missing")
    try:
        number = math.nan if isinstance(value, bool) else float(value)  # YAML reads 1e-5 as a string
    except (TypeError, ValueError):
        number = math.nan
    if not math.isfinite(number):
        raise DescriptionError(f"{file}: {field} is {value!r}, it must be a finite number")
    return number


def largest_deviation(origins: Sequence[Origin], others: Sequence[Origin]) -> Tuple[float, float]:
    """Returns the largest distance in m and angle in rad between the flanges of two arms at the compared positions."""
    distance = angle = 0.0
    for joints in COMPARED_POSITIONS:
        pose, other = flange_pose(origins, joints), flange_pose(others, joints)
        distance = max(distance, float(np.linalg.norm(pose[:3, 3] - other[:3, 3])))
        turned = other[:3, :3].T @ pose[:3, :3]
        # The arc cosine of the trace would have an error of 1e-8 for small angles.
        sine = 0.5 * np.linalg.norm([turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]])
        angle = max(angle, math.atan2(float(sine), (float(np.trace(turned)) - 1.0) / 2.0))
    return distance, angle


def _fits(origins: Sequence[Origin], model: Model) -> bool:
    distance, angle = largest_deviation(origins, nominal_origins(model))
    return distance <= MAX_DISTANCE and angle <= MAX_ANGLE


def check_model(source: str, origins: Sequence[Origin], model: Model) -> None:
    """Raises DescriptionError if the calibration belongs to another model."""
    if _fits(origins, model):
        return
    distance, angle = largest_deviation(origins, nominal_origins(model))
    fitting = [other.name for other in models().values() if _fits(origins, other)]
    remedy = f"It fits {' and '.join(fitting)}" if fitting else "It fits no model: extract the calibration of this robot again"
    raise DescriptionError(f"{source}: the calibration does not belong to the model {model.name}: the flange deviates by up to "
                           f"{1e3 * distance:.1f} mm and {angle:.3f} rad, at most {1e3 * MAX_DISTANCE:.0f} mm and {MAX_ANGLE} rad are "
                           f"possible. {remedy}")
