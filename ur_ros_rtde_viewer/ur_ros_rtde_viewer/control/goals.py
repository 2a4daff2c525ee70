"""Sends goals of any action, and reports feedback, rejections and results."""

import logging
import threading
import time
from dataclasses import dataclass, field
from enum import Enum
from typing import Any, Callable, Dict, Iterable, List, Optional

from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from rclpy.qos import DurabilityPolicy, QoSProfile
from ur_ros_rtde_cli import actions
from ur_ros_rtde_cli.driver_watch import CANCEL_TIMEOUT, CHECK_PERIOD, DriverWatch, loss

from ur_ros_rtde_msgs.msg import GoalRejected

from .control_node import ControlNode, create_steady_timer

logger = logging.getLogger(__name__)

DISCOVERY_TIMEOUT = 3.0  # s, for the server of an action
END_CHECK_PERIOD = 0.1  # s
REASON_TIMEOUT = 2.0  # s, for the reason of a rejection
POLL_PERIOD = 0.02  # s, of the conditions above: changes of the ROS graph do not wake the executor
DASHBOARD = "dashboard/"  # prefix of the actions of dashboard_server


class Phase(Enum):
    SENT = "sent"
    RUNNING = "running"
    CANCELING = "canceling"
    SUCCEEDED = "succeeded"
    CANCELED = "canceled"
    FAILED = "failed"
    REJECTED = "rejected"


ENDED = (Phase.SUCCEEDED, Phase.CANCELED, Phase.FAILED, Phase.REJECTED)
_PHASES = {GoalStatus.STATUS_SUCCEEDED: Phase.SUCCEEDED, GoalStatus.STATUS_CANCELED: Phase.CANCELED}


@dataclass(eq=False)
class SentGoal:
    """State of one goal. Written in the thread of the node, which calls `on_change` after each change."""

    action: str  # full name, "/move_j"
    on_change: Callable[["SentGoal"], None]
    stop_count: int = 0  # that of Goals when the user asked for the goal
    phase: Phase = Phase.SENT
    message: str = ""  # of the result or the rejection
    feedback: Any = None
    result: Any = None
    handle: Any = None
    driver: Optional[DriverWatch] = None  # to which the goal was sent
    ended: threading.Event = field(default_factory=threading.Event)

    @property
    def progress(self) -> Optional[float]:
        """Fraction of the motion that is complete. None if the action does not report it."""
        motion = getattr(self.feedback, "motion", None)
        return None if motion is None else float(motion.progress)

    @property
    def has_ended(self) -> bool:
        return self.phase in ENDED

    def change(self, phase: Phase, message: str = "") -> None:
        if self.has_ended:  # a result that arrives after the loss of the driver
            return
        self.phase, self.message = phase, message or self.message
        if phase in ENDED:
            self.ended.set()
        self.notify()

    def notify(self) -> None:
        """Calls `on_change`. Its failure must not affect this goal or others: the elements of a closed tab cannot be changed."""
        try:
            self.on_change(self)
        except Exception:
            logger.exception("a change of a goal of %s cannot be shown", self.action)


class Goals:
    """The action clients of one robot. An action client is kept: destroying it would end its goals with CLIENT_LOST."""

    def __init__(self, control: ControlNode, namespace: str):
        self._control = control
        self._namespace = namespace
        self._clients: Dict[str, ActionClient] = {}
        self._reasons: Dict[bytes, str] = {}
        self._open: List[SentGoal] = []  # without a result
        self.stop_count = 0  # how often STOP was pressed
        self._open_lock = threading.Lock()  # goals are sent by the threads of the page
        control.node.create_subscription(GoalRejected, self.full_name("goal_rejections"), self._on_rejection,
                                         QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL))
        create_steady_timer(control.node, CHECK_PERIOD, self._check_drivers)

    def full_name(self, name: str) -> str:
        return f"/{self._namespace}/{name}" if self._namespace else f"/{name}"

    def served(self) -> Dict[str, str]:
        """Returns the types of the robot's actions by their name in its namespace: {"move_j": "ur_ros_rtde_msgs/action/MoveJ"}.

        Namespaces within that of the robot belong to others, except that of dashboard_server.
        """
        prefix = self.full_name("")
        names = {name[len(prefix):]: kind for name, kind in actions.served(self._control.node).items() if name.startswith(prefix)}
        return {name: kind for name, kind in names.items() if "/" not in name.removeprefix(DASHBOARD)}

    def client(self, name: str, action: Any) -> ActionClient:
        """Must be called in the thread of the node."""
        if name not in self._clients:
            self._clients[name] = ActionClient(self._control.node, action, self.full_name(name))
        return self._clients[name]

    def send(self, name: str, action: Any, goal: Any, on_change: Callable[[SentGoal], None],
             stop_count: Optional[int] = None) -> SentGoal:
        """Sends a goal, unless STOP was pressed since `stop_count` was read, by default now. A callback of the page reads it in the event
        loop of viser, in which STOP runs as well. `on_change` is called in the thread of the node."""
        sent = SentGoal(self.full_name(name), on_change, self.stop_count if stop_count is None else stop_count)
        with self._open_lock:
            self._open = [goal for goal in self._open if not goal.has_ended] + [sent]
        self._control.post(lambda: self._send_when_ready(name, action, goal, sent))
        return sent

    def cancel(self, sent: SentGoal) -> None:
        self._control.post(lambda: self._cancel(sent))

    def cancel_all(self) -> List[SentGoal]:
        """Returns the goals that have not ended yet."""
        canceled = [sent for sent in self._open if not sent.has_ended]
        for sent in canceled:
            self.cancel(sent)
        return canceled

    def cancel_unaccepted(self) -> None:
        """Cancels the goals that wait for their server or its response, or that are still on their way to send(): after STOP, none of
        them may start."""
        self.stop_count += 1
        self._control.post(lambda: [self._cancel(sent) for sent in self._open if sent.handle is None])

    def _send_when_ready(self, name: str, action: Any, goal: Any, sent: SentGoal) -> None:
        client = self.client(name, action)
        self._when(client.server_is_ready, DISCOVERY_TIMEOUT,
                   lambda: self._send(client, goal, sent),
                   lambda: self._give_up(sent))

    def _give_up(self, sent: SentGoal) -> None:
        sent.change(Phase.REJECTED, f"no server of {sent.action} within {DISCOVERY_TIMEOUT:g} s. Does the driver run with this "
                                   "ROS_DOMAIN_ID?")

    def _send(self, client: ActionClient, goal: Any, sent: SentGoal) -> None:
        if sent.stop_count != self.stop_count:
            sent.change(Phase.CANCELED, "not sent, because STOP was pressed")
            return
        if sent.phase != Phase.SENT:  # canceled before it was sent
            sent.change(Phase.CANCELED, "canceled before the goal was sent")
            return

        def on_feedback(message: Any) -> None:
            if not sent.has_ended:
                sent.feedback = message.feedback
                sent.notify()

        sent.driver = DriverWatch(self._control.node, client, sent.action)
        client.send_goal_async(goal, feedback_callback=on_feedback).add_done_callback(
            lambda future: self._on_response(future.result(), sent))

    def _check_drivers(self) -> None:
        """Ends the goals that have lost their driver, and cancels them: it may only be out of reach."""
        for sent in self._open:
            if not sent.has_ended and sent.driver is not None and sent.driver.is_gone():
                self._cancel(sent)
                sent.change(Phase.FAILED, loss(sent.action))

    def _on_response(self, handle: Any, sent: SentGoal) -> None:
        if sent.has_ended:
            handle.cancel_goal_async()
            return
        if not handle.accepted:
            identifier = bytes(handle.goal_id.uuid)
            self._when(lambda: identifier in self._reasons, REASON_TIMEOUT,
                       lambda: sent.change(Phase.REJECTED, self._reasons.pop(identifier)),
                       lambda: sent.change(Phase.REJECTED, "no reason was received on goal_rejections"))
            return
        sent.handle = handle
        if sent.driver is not None:
            sent.driver.remember()
        handle.get_result_async().add_done_callback(lambda future: self._on_result(future.result(), sent))
        if sent.phase == Phase.CANCELING:
            handle.cancel_goal_async()
        else:
            sent.change(Phase.RUNNING)

    @staticmethod
    def _on_result(response: Any, sent: SentGoal) -> None:
        sent.result = response.result
        sent.change(_PHASES.get(response.status, Phase.FAILED), getattr(response.result, "message", ""))

    @staticmethod
    def _cancel(sent: SentGoal) -> None:
        """Sends a request in each call: an earlier one may have been lost or rejected."""
        if sent.has_ended:
            return
        if sent.handle is not None:
            sent.handle.cancel_goal_async()
        if sent.phase != Phase.CANCELING:
            sent.change(Phase.CANCELING)

    def _on_rejection(self, message: GoalRejected) -> None:
        self._reasons[bytes(message.goal_id.uuid)] = message.message
        while len(self._reasons) > 100:  # rejections of other clients
            del self._reasons[next(iter(self._reasons))]

    def _when(self, condition: Callable[[], bool], limit: float, then: Callable[[], None], otherwise: Callable[[], None]) -> None:
        """Calls `then` as soon as `condition` holds, or `otherwise` after `limit` s."""
        if condition():
            then()
            return
        end = time.monotonic() + limit

        def check() -> None:
            holds = condition()
            if holds or time.monotonic() >= end:
                self._control.node.destroy_timer(timer)
                (then if holds else otherwise)()

        timer = create_steady_timer(self._control.node, POLL_PERIOD, check)


def end_all(robots: Iterable[Goals], is_interrupted: Callable[[], bool]) -> None:
    """Cancels all goals and waits for their results, so that the arms are at rest when the program exits. Returns early if
    `is_interrupted()`, which is called every END_CHECK_PERIOD."""
    waiting = [sent for goals in robots for sent in goals.cancel_all()]
    if waiting:
        logger.info("waiting up to %g s for the end of %s; a second signal ends the viewer at once", CANCEL_TIMEOUT, _names(waiting))
    deadline = time.monotonic() + CANCEL_TIMEOUT
    while waiting and not is_interrupted() and (remaining := deadline - time.monotonic()) > 0.0:
        waiting[0].ended.wait(min(END_CHECK_PERIOD, remaining))
        waiting = [sent for sent in waiting if not sent.ended.is_set()]
    if waiting:
        logger.warning("%s may still be running: the driver ends the goals of a viewer that has ended", _names(waiting))


def _names(goals: Iterable[SentGoal]) -> str:
    return " and ".join(sorted({sent.action for sent in goals}))
