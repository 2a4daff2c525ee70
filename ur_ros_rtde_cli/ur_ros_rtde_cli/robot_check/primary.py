"""The configuration and the kinematics of the arm, from the primary interface (Universal Robots, "Client Interface")."""

import struct
import time
from dataclasses import dataclass
from typing import Dict, Optional, Tuple

from .connection import Connection, ConnectionFailure

PORT = 30001
_ROBOT_STATE = 16
_KINEMATICS = 5
_CONFIGURATION = 6
_SUBPACKAGE_HEADER = 5
# Limits of position, speed and acceleration of six joints, five defaults, Denavit-Hartenberg parameters, two versions.
_TYPE_OFFSET = 8 * (12 + 12 + 5 + 24) + 4 * 2
_KINEMATICS_FORMAT = struct.Struct(">6I6d6d6d6dI")
LONGEST_MESSAGE = 1 << 20

Six = Tuple[float, float, float, float, float, float]


@dataclass(frozen=True)
class ControllerKinematics:
    """Denavit-Hartenberg parameters with which the controller computes: Rz(q + theta) Tz(d) Tx(a) Rx(alpha)."""

    checksums: Tuple[int, int, int, int, int, int]
    theta: Six  # rad
    a: Six  # m
    d: Six  # m
    alpha: Six  # rad
    calibration_status: int


@dataclass(frozen=True)
class ArmData:
    type_number: Optional[int]
    kinematics: Optional[ControllerKinematics]


def read_arm_data(address: str, limit: float) -> ArmData:
    """Waits for a robot state message, which the controller sends ten times a second."""
    deadline = time.monotonic() + limit
    with Connection(address, PORT, limit) as connection:
        while time.monotonic() < deadline:
            size, kind = struct.unpack(">IB", connection.read(5))
            if not 5 <= size <= LONGEST_MESSAGE:
                raise ConnectionFailure(f"port {PORT}: does not follow the protocol of the primary interface")
            body = connection.read(size - 5)
            if kind == _ROBOT_STATE:
                return _arm_data(_subpackages(body))
    raise ConnectionFailure(f"port {PORT}: sent no robot state within {limit:g} s")


def _subpackages(body: bytes) -> Dict[int, bytes]:
    found = {}
    while len(body) >= _SUBPACKAGE_HEADER:
        size, kind = struct.unpack(">IB", body[:_SUBPACKAGE_HEADER])
        if not _SUBPACKAGE_HEADER <= size <= len(body):
            raise ConnectionFailure(f"port {PORT}: a part of its robot state has an invalid length")
        found[kind] = body[_SUBPACKAGE_HEADER:size]
        body = body[size:]
    return found


def _arm_data(packages: Dict[int, bytes]) -> ArmData:
    configuration, kinematics = packages.get(_CONFIGURATION, b""), packages.get(_KINEMATICS, b"")
    type_number = None
    if len(configuration) >= _TYPE_OFFSET + 4:
        type_number = struct.unpack_from(">i", configuration, _TYPE_OFFSET)[0]
    if len(kinematics) < _KINEMATICS_FORMAT.size:
        return ArmData(type_number, None)
    numbers = _KINEMATICS_FORMAT.unpack_from(kinematics)
    checksums, theta, a, d, alpha = (numbers[first:first + 6] for first in range(0, 30, 6))
    return ArmData(type_number, ControllerKinematics(checksums, theta, a, d, alpha, numbers[30]))
