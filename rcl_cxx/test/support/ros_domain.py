"""A ROS domain of its own for each run of tests, so that a test reaches no node but its own. Used by the Python tests of all packages
and by `./ur`; test_main.cpp and ur_ros_rtde.testing, which users have without this file, do the same."""

import os
import pathlib
import socket
from typing import List, MutableMapping, Optional

FIRST_PORT, LAST_DOMAIN = 32768, 100  # of ROS's domain_coordinator: the owner of a domain has bound its TCP port
RESERVED = "UR_TEST_DOMAIN"  # environment variable: a domain that a parent process has reserved
_RTPS_PORT, _RTPS_PORTS = 7400, 250  # the first UDP port of domain 0, and the number of ports of each domain
# With these variables of the user, a participant finds others on other hosts; a discovery server also ignores domains.
_PEERS = ("ROS_STATIC_PEERS", "ROS_DISCOVERY_SERVER", "ROS_SUPER_CLIENT", "ROS2_EASY_MODE", "CYCLONEDDS_URI")
_PROFILES = ("FASTDDS_DEFAULT_PROFILES_FILE", "FASTRTPS_DEFAULT_PROFILES_FILE")  # may name peers; that of ur_ros_rtde does not


def _udp_ports() -> List[int]:
    """Returns the local ports of all UDP sockets on this host."""
    rows = [line.split() for file in pathlib.Path("/proc/net").glob("udp*") for line in file.read_text().splitlines()[1:]]
    return [int(row[1].rpartition(":")[2], 16) for row in rows]


def _has_participants(domain: int) -> bool:
    """Returns whether a node of the domain runs on this host. Only tests bind the port of domain_coordinator, drivers do not."""
    first = _RTPS_PORT + _RTPS_PORTS * domain
    return any(first <= port < first + _RTPS_PORTS for port in _udp_ports())


class Domain:
    """A ROS domain that no other test and no running node on this host uses, until close(). Users prefer low numbers."""

    def __init__(self) -> None:
        for self.number in range(LAST_DOMAIN, 0, -1):
            self._reservation = socket.socket()
            try:
                self._reservation.bind(("", FIRST_PORT + self.number))
                if not _has_participants(self.number):
                    return
            except OSError:
                pass
            self._reservation.close()
        raise RuntimeError(f"all ROS domains from 1 to {LAST_DOMAIN} are in use")

    def close(self) -> None:
        self._reservation.close()

    def __enter__(self) -> "Domain":
        return self

    def __exit__(self, *_unused: object) -> None:
        self.close()

    @property
    def address(self) -> str:
        """A loopback address for a simulated robot."""
        return f"127.0.1.{self.number}"

    def isolate(self, environment: MutableMapping[str, str]) -> None:
        """Lets processes with this environment find the nodes of this domain on this host, and no others."""
        for name in (*_PEERS, *(name for name in _PROFILES if "/ur_ros_rtde/config/" not in environment.get(name, ""))):
            environment.pop(name, None)
        environment[RESERVED] = environment["ROS_DOMAIN_ID"] = str(self.number)
        environment["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
        if environment.get("ROS_DISTRO") == "humble":  # does not know it
            environment["ROS_LOCALHOST_ONLY"] = "1"
        environment["UR_TEST_ADDRESS"] = self.address


_own: Optional[Domain] = None


def reserve() -> None:
    """Isolates this process and its children, unless a parent process has done so. A ROS_DOMAIN_ID of the user is that of a robot.

    Call it before rclpy is used for the first time."""
    global _own
    if _own is None and os.environ.get(RESERVED) != os.environ.get("ROS_DOMAIN_ID", ""):
        _own = Domain()
        _own.isolate(os.environ)
