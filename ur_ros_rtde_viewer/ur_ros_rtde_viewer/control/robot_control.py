"""What the controls of all browser tabs share for one robot."""

import math
import time
from typing import Any, Callable, Dict, Optional

import numpy as np
from rcl_interfaces.srv import GetParameters

from ..state.robot_state import Pose, RobotState
from . import action_forms
from .action_forms import Source
from .control_node import ControlNode
from .goals import Goals
from .jog import Jog
from .modes import Modes
from .stop import Report, Stopper
from .twin import Twin

ACTIONS_PERIOD = 1.0  # s, between looks at the ROS graph


class RobotControl:
    """`view` is the RobotView, whose newest state is read, and `view_node` its node in the viewer's loop. `on_actions`
    is called when the driver serves other actions than before."""

    def __init__(self, control: ControlNode, view: Any, view_node: Any, on_actions: Callable[[], None]):
        self.view = view
        self.goals = Goals(control, view.options.namespace)
        self.modes = Modes(control, self.goals)
        self.jog = Jog(control, self.goals)
        self.twin = Twin(view, view_node)
        self.action_types: Dict[str, str] = {}
        self._on_actions, self._looked_at = on_actions, -float("inf")
        self._stopper = Stopper(control, self.goals)

    def update(self, state: RobotState) -> None:
        self.twin.update(state)
        now = time.monotonic()
        if now - self._looked_at < ACTIONS_PERIOD:
            return
        self._looked_at = now
        found = self.goals.served()
        if found != self.action_types:
            self.action_types = found
            self._on_actions()
            self.view.services.call(GetParameters, "command_server/get_parameters", self._on_parameters, names=["stream_timeout"])

    def _on_parameters(self, response: Optional[Any], _reason: str) -> None:
        if response is not None and response.values and response.values[0].double_value > 0.0:  # 0.0: unknown there
            self.jog.set_stream_timeout(response.values[0].double_value)

    def close(self) -> None:
        self.twin.close()

    def stop(self, report: Report) -> None:
        self.goals.cancel_unaccepted()  # first: goals of earlier clicks may be on their way
        self.jog.stop()
        self._stopper.press(report)

    @property
    def last_joint_positions(self) -> Optional[np.ndarray]:
        """Positions of the real arm, rad, also while fake joint states are shown. They may be old. None if none were received."""
        joints = self.view.state.actual_joints or self.view.state.joints
        return None if joints is None else joints.positions

    @property
    def joint_positions(self) -> Optional[np.ndarray]:
        """Current positions of the real arm, rad. None if `silence` says why there are none."""
        return self.last_joint_positions if self.view.state.is_current else None

    @property
    def tcp_pose(self) -> Optional[Pose]:
        """Current pose of the TCP in base. None if there is none."""
        return self.view.state.tcp_pose if self.view.state.is_current else None

    @property
    def silence(self) -> str:
        """Why there is no current state. Empty if there is one."""
        state = self.view.state
        if state.is_current:
            return ""
        age, topic = (state.age, "joint_states") if state.is_silent else (state.pose_age, "tcp_pose")
        return f"no messages on {self.view.topics.name_of(topic)}" + (f" for {age:.0f} s" if math.isfinite(age) else "")

    def current(self, source: Source) -> Optional[str]:
        """Returns the text of an input that begins with the state of the arm. None if there is no current state."""
        joints, pose = self.joint_positions, self.tcp_pose
        if source == Source.JOINT_POSITIONS and joints is not None:
            return action_forms.numbers_text(joints)
        if source == Source.TCP_POSITION and pose is not None:
            return action_forms.numbers_text(pose.position)
        if source == Source.TCP_ORIENTATION and pose is not None:
            return action_forms.numbers_text(np.roll(pose.wxyz, -1))
        return None
