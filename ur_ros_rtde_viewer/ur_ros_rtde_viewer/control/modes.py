"""Modes that outlast the goal that starts them: each ends with the browser tab that has started it."""

from typing import Any, Dict, Hashable, Optional, Set, Tuple

from rclpy.qos import DurabilityPolicy, QoSProfile

from ur_ros_rtde_msgs.action import Stop, Trigger
from ur_ros_rtde_msgs.msg import ActiveModes

from .control_node import ControlNode
from .goals import Goals, Phase, SentGoal

# The mode on active_modes and the action that ends it, by the action that starts it.
STARTS = {"force_mode_start": ("force_mode", "force_mode_stop"), "freedrive_start": ("freedrive", "freedrive_stop"),
          "teach_mode_start": ("teach_mode", "end_teach_mode")}


class Modes:
    """The modes of one robot."""

    def __init__(self, control: ControlNode, goals: Goals):
        self._control, self._goals = control, goals
        self._active: Tuple[str, ...] = ()
        self._tabs: Dict[str, Optional[Hashable]] = {}  # that have started a mode, by the action that starts it
        self._ended: Set[str] = set()  # modes that were seen to end since they were started
        control.node.create_subscription(ActiveModes, goals.full_name("active_modes"), self._on_active_modes,
                                         QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))

    def _on_active_modes(self, message: Any) -> None:
        """Forgets the modes that have ended: another client may start them next."""
        ended = set(self._active) - set(message.names)
        self._active = tuple(message.names)
        self._ended |= ended
        self._tabs = {start: tab for start, tab in self._tabs.items() if STARTS[start][0] not in ended}

    def note(self, start: str, tab: Optional[Hashable]) -> None:
        """Notes that a goal of `tab` has succeeded. None: its mode outlasts all tabs. Called in the thread of the node."""
        if start in STARTS:
            self._tabs[start] = tab
            self._ended.discard(STARTS[start][0])

    def end(self, tab: Hashable) -> None:
        """Ends the modes that `tab` has started. Can be called in any thread."""
        self._control.post(lambda: self._end_all(tab))

    def _end_all(self, tab: Hashable) -> None:
        for start in [start for start, owner in self._tabs.items() if owner == tab]:
            del self._tabs[start]
            self._end(*STARTS[start])

    def _end(self, mode: str, action: str) -> None:
        """Sends `stop` if the driver does not serve the action that ends the mode, or rejects it, as during a motion."""

        def check(goal: SentGoal) -> None:
            if goal.phase in (Phase.REJECTED, Phase.FAILED) and mode not in self._ended:
                self._goals.send("stop", Stop, Stop.Goal(), lambda _goal: None)

        self._goals.send(action, Trigger, Trigger.Goal(), check)
