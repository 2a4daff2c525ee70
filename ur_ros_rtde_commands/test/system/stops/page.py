"""STOP of the page, with the code of the page itself."""

import importlib
import time
from typing import List

from rclpy.action import ActionClient
from support import wait_for

# Not a dependency of this package, which would be a cycle: the viewer is tested with these commands.
stop = importlib.import_module("ur_ros_rtde_viewer.control.stop")
ENDED = (stop.Outcome.STOPPED, stop.Outcome.FAILED)


class Page:
    """The node, the thread and the action clients that the page's button needs, from the client of a lane."""

    def __init__(self, client):
        self._client = client
        self.node = client.node
        self._reports = []
        self._pressed, self._pressed_at = False, 0.0
        self._stopper = None
        self._clients = []

    def post(self, function):
        self._client.call_in_executor(lambda: function() or True)

    def client(self, name, action):
        self._clients.append(ActionClient(self.node, action, name))
        return self._clients[-1]

    def clear(self):
        if self._pressed:  # a press that follows at once would belong to the same hold of the button
            wait_for(lambda: time.monotonic() > self._pressed_at + stop.REPEAT_GAP, 2.0, "the button to count as released")
        self._reports, self._pressed = [], False

    def press(self) -> int:
        """Returns when the button was pressed, ns since the epoch."""
        if self._stopper is None:
            self._stopper = self._client.call_in_executor(lambda: stop.Stopper(self, self))
        wait_for(lambda: all(client.server_is_ready() for client in self._clients), 20.0, "the actions that STOP uses")
        self._pressed, self._pressed_at = True, time.monotonic()
        when = time.time_ns()
        self._stopper.press(lambda outcome, text: self._reports.append((outcome, text)))
        return when

    def fell_back(self) -> bool:
        return any(outcome == stop.Outcome.PROGRAM for outcome, _text in self._reports)

    def wait(self, excused: bool, local: bool) -> List[str]:
        """Waits until the page has reported the end of the stop. Returns the violations. `excused`: a late driver may have to stop the
        program, which it cannot in local control."""
        if not self._pressed:
            return []
        wait_for(lambda: any(outcome in ENDED for outcome, _text in list(self._reports)), 10.0, "the page to report the end of the stop")
        allowed = [stop.Outcome.PROGRAM, *([stop.Outcome.FAILED] if local else [])] if excused else []
        failed = [text for outcome, text in self._reports
                  if outcome in (stop.Outcome.FAILED, stop.Outcome.PROGRAM) and outcome not in allowed]
        return [f"STOP of the page: {text}" for text in failed]
