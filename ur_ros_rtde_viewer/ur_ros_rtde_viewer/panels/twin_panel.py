"""Digital twin: sliders set the joints that joint_states shows, while the robot is untouched and its real joints are the ghost."""

import math
from typing import Any, Callable, Optional

from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool
from ur_ros_rtde_description.models import JOINTS

from ..ros.robot_topics import RobotTopics
from ..ros.service_call import ServiceCaller
from ..state.robot_state import RobotState
from .banner import SILENT

INTRODUCTION = ("Sets the positions in `joint_states` for the programs that read them. The robot does not move. The real positions stay "
                "visible as a blue ghost.")
SWITCH = "publish_fake_joint_states"


class TwinPanel:
    def __init__(self, tab: Any, gui: Any, topics: RobotTopics, services: ServiceCaller, node: Any, post: Callable[..., None]):
        self._topics, self._services = topics, services
        self._publisher = node.create_publisher(JointState, topics.name_of("fake_joint_states"), 10)
        self._on = False
        with tab:
            gui.add_markdown(INTRODUCTION)
            self._switch = gui.add_checkbox("Digital twin", False)
            self._message = gui.add_markdown("")
            self._sliders = [gui.add_slider(f"{joint.removesuffix('_joint')}, rad", -2.0 * math.pi, 2.0 * math.pi, 0.01, 0.0, disabled=True)
                             for joint in JOINTS]
        self._switch.on_update(lambda event: post(lambda: self.switch(self._switch.value)) if event.client_id is not None else None)
        for slider in self._sliders:
            slider.on_update(lambda event: post(self.publish) if event.client_id is not None else None)

    @property
    def is_on(self) -> bool:
        return self._on

    def switch(self, on: bool) -> None:
        """Starts or ends the mode. It takes effect when the driver has answered."""
        self._services.call(SetBool, SWITCH, lambda response, reason: self._switched(on, response, reason), data=on)

    def _switched(self, on: bool, response: Optional[Any], reason: str) -> None:
        if response is None or not response.success:
            self._show(self._on, reason if response is None else response.message)
            return
        self._show(on, "")
        joints = self._topics.state.joints
        if on and joints is not None:
            for slider, position in zip(self._sliders, joints.positions):
                slider.value = float(position)

    def _show(self, on: bool, message: str) -> None:
        self._on = on
        self._switch.value = on
        self._message.content = message
        for slider in self._sliders:
            slider.disabled = not on
        self._topics.show_actual_joints(on)

    def publish(self) -> None:
        """Sends the positions of the sliders."""
        if self._on:
            positions = [float(slider.value) for slider in self._sliders]
            self._publisher.publish(JointState(name=list(self._topics.joint_names), position=positions))

    def update(self, state: RobotState) -> None:
        if self._on and state.age > SILENT:
            self._show(False, "The digital twin has ended, because the driver has ended.")

    def close(self) -> None:
        if self._on:
            self.switch(False)
