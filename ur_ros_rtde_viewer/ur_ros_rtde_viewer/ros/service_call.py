"""Calls of services that never block the loop."""

import time
from dataclasses import dataclass
from typing import Any, Callable, Dict, List, Optional

from .nodes import Nodes

TIMEOUT = 10.0  # s
OnEnd = Callable[[Any, str], None]  # (response, "") or (None, reason)
OnLate = Callable[[Any], None]  # (response)


@dataclass
class _Call:
    name: str
    client: Any
    request: Any
    on_end: OnEnd
    on_late: Optional[OnLate]
    deadline: float
    future: Optional[Any] = None

    @property
    def reason(self) -> str:
        """Why there is no response."""
        if self.future is None:
            return f"there is no service {self.name}. Does robot_state_receiver run with this ROS_DOMAIN_ID?"
        return f"the service {self.name} did not answer within {TIMEOUT:g} s"


class ServiceCaller:
    """Calls services of one robot. Each call ends exactly once. All methods and `on_end` run in the thread of the loop."""

    def __init__(self, nodes: Nodes, name_of: Callable[[str], str]):
        self._node, self._name_of = nodes.node, name_of
        self._clients: Dict[str, Any] = {}
        self._calls: List[_Call] = []

    def call(self, kind: Any, name: str, on_end: OnEnd, on_late: Optional[OnLate] = None, **request: Any) -> None:
        """Waits up to TIMEOUT for the service and its response. A response that arrives afterwards is passed to `on_late`."""
        if name not in self._clients:
            self._clients[name] = self._node.create_client(kind, self._name_of(name))
        self._calls.append(_Call(self._name_of(name), self._clients[name], kind.Request(**request), on_end, on_late,
                                 time.monotonic() + TIMEOUT))

    def update(self) -> None:
        """Sends requests whose service has appeared, and ends calls. Called once per update."""
        for call in list(self._calls):
            if call.future is None and call.client.service_is_ready():
                call.future = call.client.call_async(call.request)
            if call.future is not None and call.future.done():
                self._calls.remove(call)
                call.on_end(call.future.result(), "")
            elif time.monotonic() > call.deadline:
                self._calls.remove(call)
                if call.future is not None and call.on_late is not None:
                    call.future.add_done_callback(lambda future, on_late=call.on_late: on_late(future.result()))
                call.on_end(None, call.reason)

    @property
    def is_idle(self) -> bool:
        return not self._calls
