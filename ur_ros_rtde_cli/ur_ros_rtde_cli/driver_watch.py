"""Whether the driver that has a goal is still there, and how long it may take to end it."""

import time
from typing import Any, FrozenSet, Optional

STATUS_TOPIC = "/_action/status"  # behind the name of an action
LOSS_TIME = 2.0  # s without the driver, after which it counts as gone
CANCEL_TIMEOUT = 35.0  # s, for the result of a canceled goal, which may brake for 30 s within gentle limits of its own
CHECK_PERIOD = 0.5  # s, at which a program that waits calls is_gone()
LOOK_PERIOD = 0.5 * CHECK_PERIOD  # s, at least between two looks at the ROS graph


def servers(node: Any, name: str) -> FrozenSet[bytes]:
    """Returns the endpoints of the servers of an action with this full name. A driver that has been started again has others."""
    return frozenset(bytes(info.endpoint_gid) for info in node.get_publishers_info_by_topic(name + STATUS_TOPIC))


def loss(name: str) -> str:
    """Returns what to tell the user whose goal of this action has lost its driver."""
    return (f"the driver has ended or is out of reach while {name} was running: its result is unknown. "
            "A driver that ends stops the arm. Start it again, and look at its log")


class DriverWatch:
    """The driver that has a goal of the action `name`, which is a full name. It counts as gone even if another one has been started in
    its place."""

    def __init__(self, node: Any, client: Any, name: str):
        self.name = name
        self._node, self._client = node, client
        self._lost_since: Optional[float] = None
        self._next_look = 0.0
        self.remember()

    def remember(self) -> None:
        """Uses the servers that are known now from here on. To be called again when the goal is accepted."""
        self._servers = servers(self._node, self.name)

    def is_gone(self) -> bool:
        """Returns whether the driver has been missing for LOSS_TIME."""
        now = time.monotonic()
        if now >= self._next_look:
            self._next_look = now + LOOK_PERIOD
            if self._is_served():
                self._lost_since = None
            elif self._lost_since is None:
                self._lost_since = now
        return self._lost_since is not None and now - self._lost_since > LOSS_TIME

    def _is_served(self) -> bool:
        is_same = not self._servers or not self._servers.isdisjoint(servers(self._node, self.name))
        return is_same and bool(self._client.server_is_ready())
