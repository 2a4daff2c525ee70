"""One robot in the scene: the arm, its target as a ghost, the TCP, its trail and the force on it."""

from typing import Optional, Sequence

import viser
from ur_ros_rtde_description.options import read_options
from ur_ros_rtde_description.urdf import make_urdf

from ..arguments import RobotOptions
from ..state.robot_state import RobotState
from .arm import Arm
from .surfaces import Surface, Surfaces
from .tool_center_point import ToolCenterPoint
from .urdf import read_description

GHOST_COLOR, GHOST_OPACITY = (70, 150, 255), 0.3
STOPPED_COLOR = (220, 40, 40)
SAME_POSITION = 2e-3  # rad; a ghost that is this close to the arm is hidden


def urdf_of(robot: RobotOptions, model: str) -> str:
    """Returns the URDF of a robot with its mounting pose, calibration and tool. Raises DescriptionError if there is none."""
    return make_urdf(read_options(model, kinematics_params_file=robot.kinematics_params_file, xyz=robot.xyz, rpy=robot.rpy,
                                  tool=robot.tool, tool_length=robot.tool_length))


class RobotScene:
    """Has no arm until the model is known. `arm`, `ghost` and `tcp` are None, and `urdf` is empty until then. `error` is the reason why
    the reported model cannot be shown.

    `index`: of the robot in the scene. Namespaces may contain each other, so they are no names of nodes.

    Nodes: <root> is base_link's pose in the scene, <root>/arm and <root>/ghost the arms, <root>/base the frame of the controller.
    """

    def __init__(self, scene: viser.SceneApi, options: RobotOptions, index: int = 0):
        self._scene, self._options = scene, options
        self.root = f"/robot_{index}"
        self.urdf = self.error = ""
        self.arm: Optional[Arm] = None
        self.ghost: Optional[Arm] = None
        self.tcp: Optional[ToolCenterPoint] = None
        self._surfaces: Optional[Surfaces] = None
        self._stopped = False
        if options.model:
            self.set_model(options.model)

    def set_model(self, model: str) -> None:
        """Builds the arm. Raises DescriptionError if there is no such model, or if calibration or tool do not fit."""
        self.remove()
        urdf = urdf_of(self._options, model)
        description = read_description(urdf)
        self.arm = Arm(self._scene, f"{self.root}/arm", description)
        self.arm.set_visible(False)  # until its positions are known
        self.ghost = Arm(self._scene, f"{self.root}/ghost", description, GHOST_OPACITY, GHOST_COLOR)
        self.ghost.set_visible(False)
        base = self.arm.link_path("base")
        self.tcp, self._surfaces = ToolCenterPoint(self._scene, base), Surfaces(self._scene, base)
        self.urdf, self.error, self._stopped = urdf, "", False

    def update(self, state: RobotState) -> None:
        if self.arm is None or self.ghost is None or self.tcp is None:
            return
        if state.joints is not None:
            self.arm.set_positions(state.joints.positions)
            self.arm.set_visible(True)
        self._update_ghost(self.ghost, state)
        self.tcp.update(state)
        if state.is_stopped != self._stopped:
            self._stopped = state.is_stopped
            self.arm.set_color(STOPPED_COLOR if self._stopped else None)

    def _update_ghost(self, ghost: Arm, state: RobotState) -> None:
        """Shows the target, or the real joints while fake joint states are shown, where they differ from the arm."""
        shown, other = state.joints, state.actual_joints or state.target_joints
        if shown is None or other is None or not abs(shown.positions - other.positions).max() > SAME_POSITION:
            ghost.set_visible(False)
            return
        ghost.set_positions(other.positions)
        ghost.set_visible(True)

    def show_surfaces(self, surfaces: Sequence[Surface]) -> None:
        """Shows the surfaces of a simulated world, in the base frame of the controller."""
        if self._surfaces is not None:
            self._surfaces.show(surfaces)

    def remove(self) -> None:
        for part in (self._surfaces, self.tcp, self.ghost, self.arm):
            if part is not None:
                part.remove()
        self.arm = self.ghost = self.tcp = self._surfaces = None
        self.urdf = ""
