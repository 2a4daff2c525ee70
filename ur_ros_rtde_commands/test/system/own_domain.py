"""A ROS domain of its own for each test run. `./ur test` reserves it and sets it in the environment; `colcon test` does not."""

import contextlib
import os
import socket

FIRST_PORT, LAST_DOMAIN = 32768, 100  # of ROS's domain_coordinator: the owner of a domain has bound its port


class Domain:
    """A ROS domain that no other test on this machine uses, until close()."""

    def __init__(self):
        for self.number in range(1, LAST_DOMAIN + 1):
            self._reservation = socket.socket()
            with contextlib.suppress(OSError):
                self._reservation.bind(("", FIRST_PORT + self.number))
                return
            self._reservation.close()
        raise RuntimeError("all ROS domains are in use by other tests")

    def close(self):
        self._reservation.close()


if "ROS_DOMAIN_ID" not in os.environ:  # before rclpy is used for the first time
    _reserved = Domain()
    os.environ["ROS_DOMAIN_ID"] = str(_reserved.number)
os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
