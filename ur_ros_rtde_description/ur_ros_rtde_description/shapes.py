"""Geometry of the links: cylinders and spheres in the proportions of the arms.

The lengths follow from the Denavit-Hartenberg parameters, the radii from the sizes of the joints. All positions are in the frame of
the link.
"""

from dataclasses import dataclass
from enum import Enum
from typing import Dict, List, Tuple, Union

from .kinematics import Vector3
from .models import Model

CAP = 1.0  # length of a joint housing beyond the axis of the tube, in radii
UPPER_TUBE = 0.74  # radius of the tube of the upper arm, in radii of the shoulder lift joint
FOREARM_TUBE = 0.92  # radius of the tube of the forearm, in radii of the wrist 1 joint
LID = ((0.95, 0.08), (0.78, 0.08))  # radius and height of the two steps of the lid of a joint, in radii
RING = 1.01, 0.09  # radius and width of the ring between two links, in radii
FLANGE = 0.25  # length of the metal part of wrist_3_link, in lengths of the link
COVER = 2e-4  # m by which the metal part covers the housing


class Part(Enum):
    """What a shape represents. Lids, rings and the flange belong to the visual geometry alone."""

    HOUSING = "ur_housing"
    TUBE = "ur_tube"
    LID = "ur_lid"
    RING = "ur_ring"
    FLANGE = "ur_flange"
    TOOL = "ur_tool"

    @property
    def is_only_visible(self) -> bool:
        return self in (Part.LID, Part.RING, Part.FLANGE)


@dataclass(frozen=True)
class Cylinder:
    axis: str  # "x", "y" or "z"
    center: Vector3
    radius: float
    length: float
    part: Part = Part.HOUSING


@dataclass(frozen=True)
class Sphere:
    center: Vector3
    radius: float
    part: Part = Part.HOUSING


Shape = Union[Cylinder, Sphere]
Shapes = List[Shape]


def along(axis: str, begin: float, end: float, radius: float, at: Tuple[float, float] = (0.0, 0.0), part: Part = Part.HOUSING
          ) -> Cylinder:
    """Returns a cylinder along an axis from `begin` to `end`. `at` is its position on the two other axes, in the order x, y, z."""
    center = list(at)
    center.insert("xyz".index(axis), (begin + end) / 2.0)
    return Cylinder(axis, (center[0], center[1], center[2]), radius, abs(end - begin), part)


def _joint(begin: float, end: float, radius: float, x: float = 0.0) -> Shapes:
    """Returns the housing of a joint along z, with a lid at `end`."""
    shapes: Shapes = [along("z", begin, end, radius, (x, 0.0))]
    direction = 1.0 if end > begin else -1.0
    for step_radius, height in LID:
        top = end + direction * height * radius
        shapes.append(along("z", end, top, step_radius * radius, (x, 0.0), Part.LID))
        end = top
    return shapes


def _ring(axis: str, position: float, radius: float, at: Tuple[float, float] = (0.0, 0.0)) -> Cylinder:
    """Returns the ring at the boundary of two links."""
    half = 0.5 * RING[1] * radius
    return along(axis, position - half, position + half, RING[0] * radius, at, Part.RING)


def base_height(model: Model) -> float:
    """Returns the height in m of the boundary between base_link_inertia and shoulder_link."""
    return model.d[0] - 1.1 * model.joint_radius[0]


def link_shapes(model: Model) -> Dict[str, Shapes]:
    """Returns the shapes of each link."""
    shoulder, lift, elbow, wrist_1, wrist_2, wrist_3 = model.joint_radius
    d1, _, _, d4, d5, d6 = model.d
    _, a2, a3, *_ = model.a
    upper, fore = model.upper_arm_offset, model.forearm_offset
    base_top = base_height(model)  # this and the next line: boundaries between two links
    lift_side, elbow_side, wrist_side = upper - 1.05 * lift, (upper + fore) / 2.0, (fore + d4) / 2.0
    flange_length = 0.42 * d6
    foot = min(0.2 * shoulder, 0.5 * base_top)
    return {
        "base_link_inertia": [along("z", 0.0, foot, model.base_radius), along("z", 0.0, base_top, shoulder),
                              _ring("z", base_top, shoulder)],
        "shoulder_link": [along("z", base_top - d1, 0.0, shoulder), Sphere((0.0, 0.0, 0.0), shoulder),
                          along("y", -lift_side, 0.0, lift, (0.0, 0.0)), _ring("y", -lift_side, lift)],
        "upper_arm_link": [*_joint(lift_side, upper + CAP * lift, lift),
                           along("x", a2, 0.0, UPPER_TUBE * lift, (0.0, upper), Part.TUBE),
                           *_joint(elbow_side, upper + CAP * elbow, elbow, a2), _ring("z", elbow_side, elbow, (a2, 0.0))],
        "forearm_link": [*_joint(elbow_side, fore - CAP * elbow, elbow),
                         along("x", a3, 0.0, FOREARM_TUBE * wrist_1, (0.0, fore), Part.TUBE),
                         *_joint(wrist_side, fore - CAP * wrist_1, wrist_1, a3), _ring("z", wrist_side, wrist_1, (a3, 0.0))],
        "wrist_1_link": [*_joint(wrist_side - d4, CAP * wrist_1, wrist_1), along("y", -d5 / 2.0, 0.0, wrist_1, (0.0, 0.0)),
                         _ring("y", -d5 / 2.0, wrist_1)],
        "wrist_2_link": [*_joint(-d5 / 2.0, CAP * wrist_2, wrist_2), along("y", 0.0, d6 - flange_length, wrist_2, (0.0, 0.0)),
                         _ring("y", d6 - flange_length, wrist_2)],
        "wrist_3_link": [along("z", -flange_length, 0.0, wrist_3),
                         along("z", -FLANGE * flange_length, COVER, wrist_3 + COVER, part=Part.FLANGE)],
    }
