"""Origins of the joints, and forward kinematics.

The joint frames are those of ur_description: z is the axis of the joint. The origin of a joint in the frame of the one before consists
of the length a and the twist alpha of the previous Denavit-Hartenberg row and the length d of its own.
"""

import math
from dataclasses import dataclass
from typing import Sequence, Tuple

import numpy as np

from .models import Model

Vector3 = Tuple[float, float, float]
ALPHA = (math.pi / 2, 0.0, 0.0, math.pi / 2, -math.pi / 2, 0.0)  # rad, Denavit-Hartenberg, the same for all models


@dataclass(frozen=True)
class Origin:
    """A pose as in URDF: position in m; roll, pitch and yaw in rad about fixed axes."""

    xyz: Vector3 = (0.0, 0.0, 0.0)
    rpy: Vector3 = (0.0, 0.0, 0.0)

    def transform(self) -> np.ndarray:
        roll, pitch, yaw = self.rpy
        result = np.eye(4)
        result[:3, :3] = rotation(2, yaw) @ rotation(1, pitch) @ rotation(0, roll)
        result[:3, 3] = self.xyz
        return result


def rotation(axis: int, angle: float) -> np.ndarray:
    """Returns the 3x3 rotation about the x (0), y (1) or z axis (2). Exact for multiples of pi/2."""
    cosine, sine = math.cos(angle), math.sin(angle)
    if abs(cosine) < 1e-15 or abs(sine) < 1e-15:
        cosine, sine = float(round(cosine)), float(round(sine))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    result = np.eye(3)
    result[i, i] = result[j, j] = cosine
    result[j, i], result[i, j] = sine, -sine
    return result


def nominal_origins(model: Model) -> Tuple[Origin, ...]:
    """Returns the origins of the six joints from the nominal Denavit-Hartenberg parameters."""
    origins = []
    for i in range(6):
        a, alpha = (model.a[i - 1], ALPHA[i - 1]) if i else (0.0, 0.0)
        offset = rotation(0, alpha) @ (0.0, 0.0, model.d[i])
        origins.append(Origin((a, float(offset[1]), float(offset[2])), (alpha, 0.0, 0.0)))
    return tuple(origins)


def flange_pose(origins: Sequence[Origin], joints: Sequence[float]) -> np.ndarray:
    """Returns the pose of the tool flange in the base frame of the controller as a 4x4 matrix."""
    pose = np.eye(4)
    for origin, angle in zip(origins, joints):
        pose = pose @ origin.transform()
        pose[:3, :3] = pose[:3, :3] @ rotation(2, angle)
    return pose


def mass_frame(model: Model, link: int) -> Origin:
    """Returns the frame of a link's inertia in the URDF frame of this link: its center of mass, with the axes of the DH frame."""
    center = rotation(0, ALPHA[link]) @ model.links[link].center_of_mass
    return Origin((float(center[0]) + model.a[link], float(center[1]), float(center[2])), (ALPHA[link], 0.0, 0.0))
