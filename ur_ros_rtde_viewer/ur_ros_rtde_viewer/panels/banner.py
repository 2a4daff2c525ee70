"""Banners over the scene: what stops the robot, or why nothing is shown, and whether the positions are fake."""

from typing import Any, List, Optional, Tuple

from ..page.banner_area import BannerArea
from ..state.robot_state import RobotState

RED, AMBER = "#c62828", "#b26a00"


def banners(state: RobotState, name: str, topic: str, has_model: bool, error: str = "") -> List[Tuple[str, str]]:
    """Returns colors and texts. `error`: why the model cannot be shown."""
    first = _most_important(state, name, topic, has_model, error)
    found = [] if first is None else [first]
    if state.is_stopped and state.joints is not None and state.is_silent:  # the stop may have ended since
        found.append(_silence(state, name, topic))
    if state.joint_states_are_fake:  # also while the robot is stopped
        found.append((AMBER, f"{name}: {topic} has fake positions (digital twin). The blue ghost shows the robot."))
    return found


def _most_important(state: RobotState, name: str, topic: str, has_model: bool, error: str) -> Optional[Tuple[str, str]]:
    if state.is_stopped:
        title = state.safety_mode.replace("_", " ")
        return RED, f"{name}: {title}: {state.driver.message if state.driver is not None else ''}"
    if state.joints is None and state.other_drivers:
        return AMBER, (f"{name}: no messages on {topic}, but there is a driver in {' and '.join(state.other_drivers)}. Start the viewer "
                       f"with its namespace: --namespace {state.other_drivers[0]}")
    if state.joints is None:
        return AMBER, (f"{name}: no messages on {topic}. Start the driver (`ros2 launch ur_ros_rtde driver.launch.py` or `./ur demo "
                       "--keep-running`) with the same ROS_DOMAIN_ID and namespace.")
    if state.is_silent:
        return _silence(state, name, topic)
    if state.active_modes:
        return AMBER, f"{name}: {' and '.join(state.active_modes).replace('_', ' ')} active: forces move the arm. STOP ends it."
    if not has_model:
        return AMBER, f"{name}: {error or 'the driver reports no model. State the model: --model ur10e'}"
    if state.driver is not None and state.driver.name == "STOPPED":
        return AMBER, f"{name}: {state.driver.message}"
    return None


def _silence(state: RobotState, name: str, topic: str) -> Tuple[str, str]:
    cause = state.driver.message if state.driver is not None and state.driver.name != "READY" else ""
    return AMBER, f"{name}: no messages on {topic} for {state.age:.0f} s. {cause or 'The driver has ended or has lost the robot.'}"


class Banner:
    """`scene` is the RobotScene, which knows whether the model was found."""

    def __init__(self, area: BannerArea, name: str, topic: str, scene: Any):
        self._area, self._name, self._topic, self._scene = area, name, topic, scene
        self.shown: List[Tuple[str, str]] = []

    def update(self, state: RobotState) -> None:
        shown = banners(state, self._name, self._topic, self._scene.arm is not None, self._scene.error)
        if shown != self.shown:
            self.shown = shown
            self._area.show(self._name, shown)

    def close(self) -> None:
        pass
