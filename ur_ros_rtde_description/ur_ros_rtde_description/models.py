"""The models and their published parameters, read from models.yaml."""

import functools
import math
import pathlib
from dataclasses import dataclass
from typing import Dict, Tuple

import numpy as np
import yaml

from .errors import DescriptionError, nearest

TABLE = pathlib.Path(__file__).with_name("models.yaml")
JOINTS = ("shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint", "wrist_3_joint")
LINKS = ("shoulder_link", "upper_arm_link", "forearm_link", "wrist_1_link", "wrist_2_link", "wrist_3_link")


@dataclass(frozen=True)
class LinkMass:
    """Mass properties of a link in the frame of its Denavit-Hartenberg row."""

    mass: float  # kg
    center_of_mass: np.ndarray  # m
    inertia: np.ndarray  # kg m^2, 3x3, about the center of mass


@dataclass(frozen=True)
class Model:
    """Published parameters of a model. The sequences have one value for each joint or link."""

    name: str  # "ur10e"
    display_name: str  # "UR10e"
    a: Tuple[float, ...]  # m, Denavit-Hartenberg
    d: Tuple[float, ...]  # m, Denavit-Hartenberg
    max_velocity: Tuple[float, ...]  # rad/s
    max_torque: Tuple[float, ...]  # N m
    continuous_wrist_3: bool
    links: Tuple[LinkMass, ...]
    base_mass: float  # kg
    base_radius: float  # m
    joint_radius: Tuple[float, ...]  # m
    upper_arm_offset: float  # m, from the origin of upper_arm_link to the axis of its tube, along z
    forearm_offset: float  # m, the same for forearm_link


def _link(values: dict) -> LinkMass:
    xx, xy, xz, yy, yz, zz = values["inertia"]
    return LinkMass(values["mass"], np.array(values["center_of_mass"], float), np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))


def _model(name: str, values: dict, base_mass: float, joint_radius: Dict[int, float]) -> Model:
    dh, shape = values["dh"], values["shape"]
    return Model(name=name, display_name=values["name"], a=(0.0, dh["a2"], dh["a3"], 0.0, 0.0, 0.0),
                 d=(dh["d1"], 0.0, 0.0, dh["d4"], dh["d5"], dh["d6"]), max_velocity=tuple(map(math.radians, values["max_velocity"])),
                 max_torque=tuple(map(float, values["max_torque"])), continuous_wrist_3=values.get("continuous_wrist_3", False),
                 links=tuple(_link(values["links"][link]) for link in LINKS), base_mass=base_mass,
                 joint_radius=tuple(joint_radius[torque] for torque in values["max_torque"]), **shape)


@functools.lru_cache(maxsize=None)
def models() -> Dict[str, Model]:
    """Returns all models by name."""
    table = yaml.safe_load(TABLE.read_text())
    return {name: _model(name, values, table["base_mass"], table["joint_radius"]) for name, values in table["models"].items()}


def find_model(name: str) -> Model:
    """Returns a model. Case, spaces, '-' and '_' in its name are ignored: "UR8 Long" is ur8long."""
    normalized = "".join(c for c in name.lower() if c not in " -_")
    if normalized not in models():
        raise DescriptionError(f"model is \"{name}\", there is no such model; {nearest(normalized, models())}The models are: "
                               f"{', '.join(models())}")
    return models()[normalized]
