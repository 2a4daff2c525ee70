"""Sends one goal and waits for its result."""

import argparse
import os
import textwrap
from typing import Any, List, Optional, Tuple

from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from rclpy.qos import DurabilityPolicy, QoSProfile

from ur_ros_rtde_msgs.msg import GoalRejected

from . import actions, fields, interface_files
from .driver_watch import CANCEL_TIMEOUT, DriverWatch, loss
from .errors import CliError, OperationFailed
from .feedback import write
from .goal_output import JsonOutput, TextOutput
from .interruptions import Interrupted
from .namespaces import other_drivers
from .session import GRAPH_POLL_PERIOD, Session

COMMENT_WIDTH = 100  # characters


def _read_goal(options: argparse.Namespace) -> fields.Document:
    return fields.Document.of_file(options.file) if options.file is not None else fields.Document(options.goal or "{}")


def _documented(goal: Any, kind: str) -> str:
    """Returns a goal in YAML, with units and ranges of its fields as comments."""
    documented = interface_files.fields(kind)
    lines: List[str] = []
    for line in fields.to_yaml(goal).splitlines():
        field = documented.get(line.partition(":")[0])
        lines += textwrap.wrap(field.comment if field else "", COMMENT_WIDTH, initial_indent="# ", subsequent_indent="# ")
        lines.append(line)
    return "\n".join(lines)


def _server_not_found(session: Session, name: str, requested: str) -> CliError:
    elsewhere = other_drivers(session.node)
    if elsewhere:
        return CliError(f"no server of {name}{elsewhere}")
    served = actions.served(session.node)
    namespaces = sorted(full[:-len(requested)].rstrip("/") or "/" for full in served if full.endswith(f"/{requested}"))
    if namespaces:
        return CliError(f"no server of {name}, but of this action in {' and '.join(namespaces)}: give --namespace")
    known = {full.lstrip("/") for full in served} | set(actions.plugin_names())
    hint = "" if requested in known else actions.suggestion(requested, known)
    if not served:
        return OperationFailed(f"no server of {name}{hint or '.'} No driver answers: start it, or check ROS_DOMAIN_ID "
                               f"({os.environ.get('ROS_DOMAIN_ID', '0')})")
    return CliError(f"no server of {name}{hint or f'. The driver serves {len(served)} actions; `ur plugins` lists the installed ones'}")


class _ActionConnection:
    """Connects to the server of one action. The goal is checked as soon as the type of the action is known."""

    def __init__(self, session: Session, options: argparse.Namespace):
        self._session, self._options = session, options
        self.name = f"{session.node.get_namespace().rstrip('/')}/{options.action}"
        self._document = _read_goal(options)
        self.kind = ""  # of the goal, once it is known

    def connect(self) -> Tuple[Optional[ActionClient], Any]:
        """Returns the client and the goal. With --show, the client is None and a server is needed only for unknown types."""
        expected = self._served_type() or actions.type_of_plugin(self._options.action)
        if expected is not None:
            action, goal = self._load_and_fill(expected)
            if self._options.show:
                return None, goal
        else:
            self._suggest_names()
        kind = self._session.wait(self._served_type, self._options.wait, GRAPH_POLL_PERIOD)
        if kind is None:
            raise _server_not_found(self._session, self.name, self._options.action)
        if kind != expected:
            action, goal = self._load_and_fill(kind)
        if self._options.show:
            return None, goal
        # A client that is created while announcements of the server are still arriving would be discovered only in part.
        client = ActionClient(self._session.node, action, self.name)
        if not self._session.wait(client.server_is_ready, self._options.wait, GRAPH_POLL_PERIOD):
            raise OperationFailed(f"the server of {self.name} does not respond")
        return client, goal

    def _served_type(self) -> Optional[str]:
        return actions.served(self._session.node).get(self.name)

    def _load_and_fill(self, kind: str) -> Tuple[Any, Any]:
        action, self.kind = actions.load(self.name, kind), kind
        return action, self._document.fill(action.Goal())

    def _suggest_names(self) -> None:
        requested, plugins = self._options.action, actions.plugin_names()
        hint = actions.suggestion(requested, plugins) or "; `ur plugins` lists them."
        if requested not in plugins and self._served_type() is None:
            write(f"no plugin is named {requested}{hint} Waiting {self._options.wait:g} s for a server\n")


class _CancelOnInterruption:
    """Cancels the goal at the first interruption and continues to wait for the result. Raises OperationFailed without the driver.

    A second interruption, or a result that does not arrive in time, ends the program. The driver then stops the arm because
    the client has disappeared.
    """

    def __init__(self, session: Session, driver: DriverWatch, output: Any):
        self._session, self._driver, self._output = session, driver, output
        self._handle: Any = None
        self.reason: Optional[Interrupted] = None

    def wait(self, future: Any) -> Any:
        while True:
            try:
                if self._session.wait(lambda: self._is_done(future), CANCEL_TIMEOUT if self.reason else None):
                    return future.result()
            except Interrupted as interrupted:
                if self.reason:
                    raise
                self.reason = interrupted
                self._output.clear()
                write(f"canceling ({interrupted}), interrupt again to quit without the result\n")
                self._cancel()
            except OperationFailed as lost:
                self._output.clear()
                if self.reason is None:
                    raise
                write(f"{lost}\n")
                raise self.reason from None
            else:
                assert self.reason is not None  # before an interruption, there is no limit
                write(f"no result within {CANCEL_TIMEOUT:g} s after the goal was canceled\n")
                raise self.reason

    def _is_done(self, future: Any) -> bool:
        if not future.done() and self._driver.is_gone():
            raise OperationFailed(loss(self._driver.name))
        return bool(future.done())

    def accepted(self, handle: Any) -> None:
        self._handle = handle
        self._driver.remember()
        if self.reason:
            self._cancel()

    def _cancel(self) -> None:
        if self._handle is not None:
            self._handle.cancel_goal_async()


class _Rejections:
    """Receives the reasons of rejected goals on the topic goal_rejections."""

    def __init__(self, session: Session):
        self._session = session
        self._received: list = []
        session.node.create_subscription(GoalRejected, "goal_rejections", self._received.append,
                                         QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL))

    def reason(self, goal_id: bytes) -> str:
        own = self._session.wait(lambda: next((r for r in self._received if bytes(r.goal_id.uuid) == goal_id), None), 2.0)
        return own.message if own else "no reason was received on goal_rejections"


def send_goal(session: Session, options: argparse.Namespace) -> int:
    connection = _ActionConnection(session, options)
    client, goal = connection.connect()
    if client is None:
        print(_documented(goal, connection.kind))
        return 0
    rejections = _Rejections(session)
    output = (JsonOutput if options.json else TextOutput)(options.quiet)
    canceling = _CancelOnInterruption(session, DriverWatch(session.node, client, connection.name), output)
    handle = canceling.wait(client.send_goal_async(goal, feedback_callback=output.feedback))
    if not handle.accepted:
        reason = rejections.reason(bytes(handle.goal_id.uuid))
        output.rejected(reason)
        raise CliError(f"rejected: {reason}")
    canceling.accepted(handle)
    response = canceling.wait(handle.get_result_async())
    output.clear()
    output.result(response)
    if canceling.reason:
        return canceling.reason.exit_code
    return 0 if response.status == GoalStatus.STATUS_SUCCEEDED else 1
