"""Follows the goal that moves the arm: which action, its progress and its duration."""

import importlib
import time
from typing import Any, Dict, Optional

from rclpy.qos import QoSProfile
from ur_ros_rtde_cli.actions import FEEDBACK_TOPIC, FEEDBACK_TYPE

from ..state.robot_state import ActiveGoal
from .nodes import Nodes

SILENCE = 0.5  # s without feedback, after which a goal with feedback has ended; it is published at 20 Hz


class ActiveGoalTopic:
    """The name of the goal comes once a second from /diagnostics; progress comes from the feedback of its action.

    Subscriptions are kept for the next goal of the action, because each new one costs memory that is not released.
    """

    def __init__(self, nodes: Nodes, prefix: str):
        self._node, self._prefix = nodes.node, prefix
        self._action = ""
        self._subscriptions: Dict[str, Any] = {}  # by action
        self._heard: Optional[float] = None
        self.goal: Optional[ActiveGoal] = None

    def on_holder(self, holder: str) -> None:
        """`holder` is the entry of /diagnostics: "/left/move_j, goal 51b26db5", or empty."""
        action = holder.partition(",")[0].removeprefix(self._prefix)
        if action == self._action:
            return
        self._end()
        if action:
            self._action, self.goal = action, ActiveGoal(action, 0.0, 0.0)
            self._subscribe(action)

    def update(self) -> None:
        """Ends a goal whose feedback has ended, up to a second before /diagnostics reports it."""
        if self._heard is not None and time.monotonic() - self._heard > SILENCE:
            self.goal = None

    def _subscribe(self, action: str) -> None:
        topic = f"{self._prefix}{action}{FEEDBACK_TOPIC}"
        types = None if action in self._subscriptions else dict(self._node.get_topic_names_and_types()).get(topic)
        kind = _feedback_type(types[0]) if types else None
        if kind is not None:
            self._subscriptions[action] = self._node.create_subscription(
                kind, topic, lambda message: self._on_feedback(action, message), QoSProfile(depth=1))

    def _on_feedback(self, action: str, message: Any) -> None:
        motion = getattr(message.feedback, "motion", None)
        if action != self._action or motion is None:
            return
        self._heard = time.monotonic()
        self.goal = ActiveGoal(self._action, motion.progress, motion.elapsed.sec + 1e-9 * motion.elapsed.nanosec)

    def _end(self) -> None:
        self._action, self._heard, self.goal = "", None, None


def _feedback_type(name: str) -> Any:
    """Returns the message class of "ur_ros_rtde_msgs/action/MoveJ_FeedbackMessage", None if its package is not in this workspace."""
    package, _, kind = name.split("/")
    try:
        module = importlib.import_module(f"{package}.action")
    except ImportError:
        return None
    return getattr(module, kind.removesuffix(FEEDBACK_TYPE)).Impl.FeedbackMessage
