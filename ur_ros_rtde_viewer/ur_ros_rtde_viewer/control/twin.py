"""Digital twin of one robot: a tab of the browser sets the joints that joint_states shows, while the robot is untouched."""

from typing import Any, Callable, Hashable, Optional, Sequence

from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool

from ..state.robot_state import RobotState

SWITCH = "publish_fake_joint_states"
Show = Callable[[bool, str], None]  # whether the mode is on, and why it is not


class Twin:
    """Belongs to one tab of the browser at a time, and ends with it. Called in the thread of the viewer's loop."""

    def __init__(self, view: Any, node: Any):
        self._topics, self._services = view.topics, view.services
        self._publisher = node.create_publisher(JointState, view.topics.name_of("fake_joint_states"), 10)
        self._owner: Optional[Hashable] = None
        self._show: Show = lambda _on, _message: None
        self._confirmed = False  # by the topic joint_states_are_fake

    def begin(self, tab: Hashable, show: Show) -> None:
        """Starts the mode. It takes effect when the driver has answered."""
        if self._owner not in (None, tab):
            show(False, "The digital twin is on in another tab of the browser.")
            return
        self._owner, self._show, self._confirmed = tab, show, False
        self._services.call(SetBool, SWITCH, self._answered, data=True)

    def _answered(self, response: Optional[Any], reason: str) -> None:
        if response is not None and response.success:
            self._show(self._owner is not None, "")
        else:
            self._forget(reason if response is None else response.message)

    def end(self, tab: Hashable) -> None:
        """Ends the mode if it belongs to this tab."""
        if self._owner is not None and self._owner == tab:
            self._services.call(SetBool, SWITCH, lambda _response, _reason: None, data=False)
            self._forget("")

    def _forget(self, message: str) -> None:
        self._owner = None
        self._show(False, message)

    def publish(self, tab: Hashable, positions: Sequence[float]) -> None:
        if self._owner == tab:
            self._publisher.publish(JointState(name=list(self._topics.joint_names), position=positions))

    def update(self, state: RobotState) -> None:
        """Notices that another program has ended the mode, or that the driver was started anew. While the robot is silent, the driver
        keeps the mode, so the tab keeps it as well."""
        if self._owner is None:
            return
        if self._confirmed and not state.joint_states_are_fake:
            self._forget("The digital twin has ended: the driver or another program has ended it.")
        self._confirmed |= state.joint_states_are_fake

    def close(self) -> None:
        if self._owner is not None:
            self.end(self._owner)
