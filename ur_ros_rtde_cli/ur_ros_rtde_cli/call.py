"""Sends a goal, shows its progress and prints its result.

The goal is YAML; fields that are not named have their defaults. Ctrl-C, SIGTERM, SIGHUP and a closed output cancel the goal: the
arm decelerates, then the result comes, and the exit code is 128 plus the number of the signal.

    ur call move_j "{joint_positions: [0, -1.57, 1.57, -1.57, -1.57, 0], speed: 0.5}"
    ur call dashboard/robot_mode
    ur call move_j --show        the fields of the goal
"""

import argparse
import contextlib
import importlib
import sys
import time
from typing import Any, Dict, Optional

from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from rclpy.action.graph import get_action_names_and_types
from rclpy.qos import DurabilityPolicy, QoSProfile
from ur_ros_rtde_msgs.msg import GoalRefused

from . import fields
from .problem import Problem
from .session import Interrupted, Session, session


CANCEL_LIMIT = 10.0  # s, for the result after the goal was canceled


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("action", help="its name: move_l, dashboard/power_on")
    parser.add_argument("goal", nargs="?", default="{}", help="YAML (default: {})")
    parser.add_argument("--wait", type=float, default=5.0, metavar="S", help="for the action server (default: 5 s)")
    parser.add_argument("--show", action="store_true", help="show the fields of the goal with their defaults, and send nothing")
    parser.add_argument("--quiet", action="store_true", help="no progress")


def _actions(use: Session) -> Dict[str, str]:
    return {name: types[0] for name, types in get_action_names_and_types(use.node)}


def _resolve(use: Session, name: str, limit: float) -> "tuple[str, Any]":
    """The full name and the class of the action, once a server has it."""
    namespace = use.node.get_namespace().rstrip("/")
    full = name if name.startswith("/") else f"{namespace}/{name}"
    kind = use.wait(lambda: _actions(use).get(full), limit)
    if kind is None:
        known = sorted(_actions(use))
        raise Problem(f"nobody serves the action {full}" + (f"; there are: {', '.join(known)}" if known else
                      ": no node with actions was found. Does command_server run, in this ROS_DOMAIN_ID?"))
    package, _, short = kind.partition("/action/")
    try:
        return full, getattr(importlib.import_module(f"{package}.action"), short)
    except (ImportError, AttributeError):
        raise Problem(f"{full} has the type {kind}, which is not installed here; source the workspace that has it")


def _say(text: str) -> None:
    """To stderr, which may be closed."""
    with contextlib.suppress(OSError):
        sys.stderr.write(text)
        sys.stderr.flush()


class _Progress:
    """One line that follows the feedback; nothing where nobody looks."""

    def __init__(self, quiet: bool):
        self._on = not quiet and sys.stderr.isatty()
        self._begin = time.monotonic()

    def __call__(self, message: Any) -> None:
        if not self._on:
            return
        feedback = message.feedback
        motion = getattr(feedback, "motion", None)
        text = str(getattr(feedback, "state", "") or getattr(feedback, "output", ""))
        if motion is not None:
            filled = round(30 * min(max(motion.progress, 0.0), 1.0))
            text = f"[{'#' * filled}{'.' * (30 - filled)}] {100 * motion.progress:3.0f} % {text}"
        _say(f"\r\x1b[K{time.monotonic() - self._begin:6.1f} s  {text[:90]}")

    def end(self) -> None:
        if self._on:
            _say("\r\x1b[K")


def _refusal(use: Session, refusals: list, goal_id: bytes) -> str:
    mine = use.wait(lambda: next((r for r in refusals if bytes(r.goal_id.uuid) == goal_id), None), 2.0)
    return mine.message if mine else "without a reason on goal_refusals"


class _Canceling:
    """The first interruption after the goal was sent cancels it, and its result is still waited for. A second one, or a result
    that does not come in time, ends the program: the driver stops the arm when it finds the client gone."""

    def __init__(self, use: Session, progress: _Progress):
        self._use, self._progress = use, progress
        self._handle: Any = None
        self.reason: Optional[Interrupted] = None

    def wait(self, future: Any) -> Any:
        while True:
            try:
                if self._use.wait(future.done, CANCEL_LIMIT if self.reason else None):
                    return future.result()
            except Interrupted as interrupted:
                if self.reason:
                    raise
                self.reason = interrupted
                self._progress.end()
                _say(f"canceling ({interrupted}), again to go without the result\n")
                self._cancel()
            else:
                _say(f"no result within {CANCEL_LIMIT:g} s after the goal was canceled\n")
                raise self.reason

    def accepted(self, handle: Any) -> None:
        self._handle = handle
        if self.reason:
            self._cancel()

    def _cancel(self) -> None:
        if self._handle is not None:
            self._handle.cancel_goal_async()


def run(options: argparse.Namespace) -> int:
    with session(options.namespace) as use:
        name, action = _resolve(use, options.action, options.wait)
        goal = fields.read(options.goal, action.Goal())
        if options.show:
            print(fields.show(goal))
            return 0
        latched = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        refusals: list = []
        use.node.create_subscription(GoalRefused, "goal_refusals", refusals.append, latched)
        client = ActionClient(use.node, action, name)
        if not use.wait(client.server_is_ready, options.wait):
            raise Problem(f"the server of {name} does not answer")
        progress = _Progress(options.quiet)
        canceling = _Canceling(use, progress)
        handle = canceling.wait(client.send_goal_async(goal, feedback_callback=progress))
        if not handle.accepted:
            raise Problem(f"refused: {_refusal(use, refusals, bytes(handle.goal_id.uuid))}")
        canceling.accepted(handle)
        answer = canceling.wait(handle.get_result_async())
        progress.end()
        sys.stdout.write(f"{fields.show(answer.result)}\n")  # at once: its reader may want the first line only
        if canceling.reason:
            return canceling.reason.exit_code
        return 0 if answer.status == GoalStatus.STATUS_SUCCEEDED else 1
