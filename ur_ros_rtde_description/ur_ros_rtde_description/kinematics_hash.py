"""The field `hash` of a kinematics file: the one that Universal Robots' client library computes from a controller's parameters.

KinematicsInfo::toHash writes theta, d, a and alpha of the joints one after the other into a C++ stream and takes std::hash of the text.
std::hash is not specified; this is the one of libstdc++ on 64-bit machines, MurmurHash64A with a seed of its own. `ur_robot_driver` warns
if the hash of the robot differs from that of the description.
"""

from typing import Sequence

SEED = 0xC70F6907  # of std::hash in libstdc++
FACTOR = 0xC6A4A7935BD1E995
MASK = 2**64 - 1


def kinematics_hash(theta: Sequence[float], d: Sequence[float], a: Sequence[float], alpha: Sequence[float]) -> str:
    # A C++ stream writes six significant digits.
    text = "".join(f"{value:g}" for row in zip(theta, d, a, alpha) for value in row)
    return f"calib_{std_hash(text.encode())}"


def std_hash(data: bytes) -> int:
    """Returns std::hash<std::string> of libstdc++ on 64-bit machines."""
    result = SEED ^ (len(data) * FACTOR & MASK)
    whole = len(data) & ~7
    for i in range(0, whole, 8):
        block = int.from_bytes(data[i:i + 8], "little")
        result = (result ^ (_mix(block * FACTOR & MASK) * FACTOR & MASK)) * FACTOR & MASK
    if len(data) > whole:
        result = (result ^ int.from_bytes(data[whole:], "little")) * FACTOR & MASK
    return _mix(_mix(result) * FACTOR & MASK)


def _mix(value: int) -> int:
    return value ^ (value >> 47)
