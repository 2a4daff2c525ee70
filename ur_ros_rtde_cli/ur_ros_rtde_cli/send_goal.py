"""Sends one goal, until its result or its cancellation."""

import argparse
import sys
from typing import Any, Optional, Tuple

from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from rclpy.qos import DurabilityPolicy, QoSProfile
from ur_ros_rtde_msgs.msg import GoalRefused

from . import actions, fields
from .feedback import FeedbackDisplay, write
from .interruptions import Interrupted
from .problem import Problem
from .session import GRAPH_POLL_PERIOD, Session

CANCEL_LIMIT = 10.0  # s, for the result after the goal was canceled


def _read_goal(options: argparse.Namespace) -> fields.Document:
    return fields.Document.of_file(options.file) if options.file is not None else fields.Document(options.goal or "{}")


def _nobody_serves(session: Session, name: str, requested: str) -> Problem:
    served = actions.served(session.node)
    hint = actions.suggestion(requested, {full.lstrip("/") for full in served} | set(actions.plugin_names()))
    if not served:
        return Problem(f"no server of {name}{hint or '.'} No node with actions was found. Does command_server run, in this "
                       "ROS_DOMAIN_ID?")
    return Problem(f"no server of {name}{hint}" if hint else f"no server of {name}; there are: {', '.join(sorted(served))}")


class _Server:
    """Of one action. Its goal is checked as soon as the action's type is known."""

    def __init__(self, session: Session, options: argparse.Namespace):
        self._session, self._options = session, options
        namespace = session.node.get_namespace().rstrip("/")
        self.name = options.action if options.action.startswith("/") else f"{namespace}/{options.action}"
        self._document = _read_goal(options)

    def connect(self) -> Tuple[Optional[ActionClient], Any]:
        """The client and the goal; no client with --show, which needs no server if a plugin tells the type."""
        expected = actions.type_of_plugin(self._options.action.lstrip("/"))
        if expected is not None:
            action, goal = self._checked(expected)
            if self._options.show:
                return None, goal
        else:
            self._hint_at_names()
        kind = self._session.wait(self._served_type, self._options.wait, GRAPH_POLL_PERIOD)
        if kind is None:
            raise _nobody_serves(self._session, self.name, self._options.action)
        if kind != expected:
            action, goal = self._checked(kind)
        if self._options.show:
            return None, goal
        # Not earlier: the client would be discovered in parts, while the server's announcements still arrive.
        client = ActionClient(self._session.node, action, self.name)
        if not self._session.wait(client.server_is_ready, self._options.wait, GRAPH_POLL_PERIOD):
            raise Problem(f"the server of {self.name} does not answer")
        return client, goal

    def _served_type(self) -> Optional[str]:
        return actions.served(self._session.node).get(self.name)

    def _checked(self, kind: str) -> Tuple[Any, Any]:
        action = actions.load(self.name, kind)
        return action, self._document.fill(action.Goal())

    def _hint_at_names(self) -> None:
        requested, plugins = self._options.action, actions.plugin_names()
        hint = actions.suggestion(requested, plugins)
        if hint and not requested.startswith("/") and requested not in plugins and self._served_type() is None:
            write(f"no plugin is called {requested}{hint} Waiting {self._options.wait:g} s for a server\n")


class _Canceling:
    """The first interruption after the goal was sent cancels it; the result is still awaited. A second interruption, or a
    result that does not arrive in time, ends the program: the driver stops the arm when it finds the client gone."""

    def __init__(self, session: Session, display: Any):
        self._session, self._display = session, display
        self._handle: Any = None
        self.reason: Optional[Interrupted] = None

    def wait(self, future: Any) -> Any:
        while True:
            try:
                if self._session.wait(future.done, CANCEL_LIMIT if self.reason else None):
                    return future.result()
            except Interrupted as interrupted:
                if self.reason:
                    raise
                self.reason = interrupted
                self._display.clear()
                write(f"canceling ({interrupted}), again to go without the result\n")
                self._cancel()
            else:
                write(f"no result within {CANCEL_LIMIT:g} s after the goal was canceled\n")
                raise self.reason

    def accepted(self, handle: Any) -> None:
        self._handle = handle
        if self.reason:
            self._cancel()

    def _cancel(self) -> None:
        if self._handle is not None:
            self._handle.cancel_goal_async()


class _Refusals:
    """What the driver publishes on goal_refusals."""

    def __init__(self, session: Session):
        self._session = session
        self._received: list = []
        session.node.create_subscription(GoalRefused, "goal_refusals", self._received.append,
                                         QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL))

    def reason(self, goal_id: bytes) -> str:
        own = self._session.wait(lambda: next((r for r in self._received if bytes(r.goal_id.uuid) == goal_id), None), 2.0)
        return own.message if own else "without a reason on goal_refusals"


def send_goal(session: Session, options: argparse.Namespace) -> int:
    client, goal = _Server(session, options).connect()
    if client is None:
        print(fields.show(goal))
        return 0
    refusals = _Refusals(session)
    display = FeedbackDisplay(options.quiet)
    canceling = _Canceling(session, display)
    handle = canceling.wait(client.send_goal_async(goal, feedback_callback=display))
    if not handle.accepted:
        raise Problem(f"refused: {refusals.reason(bytes(handle.goal_id.uuid))}")
    canceling.accepted(handle)
    answer = canceling.wait(handle.get_result_async())
    display.clear()
    sys.stdout.write(f"{fields.show(answer.result)}\n")  # in one piece: its reader may close the pipe after the first line
    if canceling.reason:
        return canceling.reason.exit_code
    return 0 if answer.status == GoalStatus.STATUS_SUCCEEDED else 1
