"""A target pose that is dragged in the scene: inverse kinematics, preview of the path, and execution. For one browser tab."""

import xml.etree.ElementTree as xml
from typing import Any, Callable, List, Optional

import numpy as np
from ur_ros_rtde_description.models import JOINTS
from ur_ros_rtde_description.tree import link_poses

from ..page.sliders import within_limits
from ..scene.arm import Arm
from ..scene.urdf import read_description
from .goal_view import GoalView, escaped
from .robot_control import RobotControl
from .target_pose import Motion, Plan, Planner, PoseTarget

GHOST_COLOR, GHOST_OPACITY = (60, 180, 90), 0.35
PATH_COLOR = (60, 180, 90)
GIZMO_SCALE = 0.25  # m
NO_TARGET = "*Execute* needs a target: show it."
NO_PLAN = "*Execute* needs a motion: drag the target."


class TargetPanel:
    """Callbacks of the page and of the control node are called in other threads; `post` calls a function in that of the viewer's loop,
    where all of this happens: STOP does not wait for a preview that is drawn."""

    def __init__(self, client: Any, container: Any, robot: RobotControl, post: Callable[[Callable[[], None]], None]):
        self._client, self._robot, self._post = client, robot, post
        self._gizmo: Any = None
        self._arm: Optional[Arm] = None
        self._path: Any = None
        self._plan: Optional[Plan] = None
        self._planner: Optional[Planner] = None
        self._goal: Optional[GoalView] = None
        self._closed = False
        gui = client.gui
        with container:
            gui.add_markdown("Show the target and drag it in the scene. The green arm shows where the motion ends.")
            self._shown = gui.add_checkbox("Show the target", False)
            self._motion = gui.add_dropdown("Motion", tuple(motion.value for motion in Motion))
            self._speed = gui.add_slider("Speed [% of the default]", 10, 200, 10, 100)
            self._preview = gui.add_slider("Preview [%]", 0, 100, 1, 100, disabled=True)
            self._execute = gui.add_button("Execute", color="green", disabled=True)
            self._text = gui.add_markdown(NO_TARGET)
            self._goals_folder = gui.add_folder("Goal", visible=False)
        self._shown.on_update(lambda _event: self._in_loop(self._show_or_hide))
        self._motion.on_update(lambda _event: self._in_loop(self._solve))
        self._preview.on_update(lambda _event: self._in_loop(self._show_preview))
        self._execute.on_click(self._clicked)

    def _in_loop(self, function: Callable[[], None]) -> None:
        """Calls a function in the thread of the viewer's loop, unless the tab is gone, and with it all elements."""
        self._post(lambda: None if self._closed else function())

    async def _clicked(self, _event: Any) -> None:
        """Runs in the event loop of viser, in the order of the messages: STOP after a click ends its goal, even if it is sent later."""
        stop_count = self._robot.goals.stop_count
        self._in_loop(lambda: self._send(stop_count))

    def close(self) -> None:
        self._closed = True
        if (goal := self._goal) is not None:  # at once: the loop may be drawing
            goal.close()
        self._post(self._end)

    def _end(self) -> None:
        if self._planner is not None:
            self._planner.abandon()
        if self._goal is not None:
            self._goal.close()

    # --- Target ----------------------------------------------------------------------------------------------------

    def _tcp(self) -> Optional[PoseTarget]:
        pose = self._robot.tcp_pose
        return None if pose is None else PoseTarget(pose.position, pose.wxyz)

    def _show_or_hide(self) -> None:
        if self._shown.value:
            self._show()
        else:
            self._hide()

    def _show(self) -> None:
        """Places the target at the TCP."""
        self._hide()
        scene, tcp = self._robot.view.scene, self._tcp()
        if scene.arm is None or tcp is None or self._robot.joint_positions is None:
            self._say_missing_state()
            return
        self._urdf = xml.fromstring(scene.urdf)
        self._base = scene.arm.link_path("base")
        self._arm = Arm(self._client.scene, f"{scene.root}/preview", read_description(scene.urdf), GHOST_OPACITY, GHOST_COLOR)
        self._arm.set_visible(False)
        self._gizmo = self._client.scene.add_transform_controls(f"{self._base}/target", scale=GIZMO_SCALE, position=tcp.position,
                                                                wxyz=tcp.wxyz, depth_test=False)
        self._gizmo.on_update(lambda event: self._in_loop(self._solve) if event.phase == "end" else None)
        self._say(NO_PLAN)

    def _hide(self) -> None:
        self._forget_plan()
        self._say(NO_TARGET)
        for part in (self._arm, self._gizmo):
            if part is not None:
                part.remove()
        self._arm = self._gizmo = None

    def _say(self, text: str) -> None:
        self._text.content = text

    def _say_missing_state(self) -> None:
        self._say(f"*Execute* needs the state of the robot: {escaped(self._robot.silence or 'it is not received yet')}.")

    # --- Plan ------------------------------------------------------------------------------------------------------

    def _forget_plan(self) -> None:
        if self._planner is not None:
            self._planner.abandon()
        self._plan = self._planner = None
        self._execute.disabled = self._preview.disabled = True
        if self._path is not None:
            self._path.remove()
            self._path = None
        if self._arm is not None:
            self._arm.set_visible(False)

    def _solve(self) -> None:
        """Plans the motion to the target."""
        self._forget_plan()
        joints, tcp = self._robot.joint_positions, self._tcp()
        if self._gizmo is None:
            return
        if joints is None or tcp is None:
            self._say_missing_state()
            return
        self._say("Planning")
        target = PoseTarget(np.array(self._gizmo.position), np.array(self._gizmo.wxyz))
        planner = self._planner = Planner(self._robot.goals, Motion(self._motion.value), joints, tcp, target,
                                          lambda plan, reason: self._in_loop(lambda: self._on_plan(planner, plan, reason, joints, tcp)))
        planner.start()

    def _on_plan(self, planner: Planner, plan: Optional[Plan], reason: str, joints: np.ndarray, tcp: PoseTarget) -> None:
        if planner is not self._planner:  # another target was set in the meantime
            return
        if plan is None:
            self._say(f"{escaped(reason)}")
            return
        self._plan = plan
        self._draw_path(plan, joints, tcp)
        self._execute.disabled = self._preview.disabled = False
        turns = np.abs(plan.joint_path[-1] - plan.joint_path[0])
        largest = int(turns.argmax())
        self._say(f"Reachable. Largest rotation: {escaped(JOINTS[largest])}, {turns[largest]:.2f} rad")
        self._preview.value = 100
        self._show_preview()

    def _draw_path(self, plan: Plan, joints: np.ndarray, tcp: PoseTarget) -> None:
        """Draws the path of the TCP. The TCP in the flange is that of the current pose."""
        offset = np.linalg.inv(self._flange(joints)) @ np.append(tcp.position, 1.0)
        points = np.array([(self._flange(positions) @ offset)[:3] for positions in plan.joint_path], np.float32)
        self._path = self._client.scene.add_line_segments(f"{self._base}/target_path", np.stack([points[:-1], points[1:]], axis=1),
                                                          PATH_COLOR, line_width=4.0)

    def _flange(self, positions: np.ndarray) -> np.ndarray:
        """Returns the pose of tool0 in base as a 4x4 matrix."""
        poses = link_poses(self._urdf, dict(zip(JOINTS, positions)))
        return np.linalg.inv(poses["base"]) @ poses["tool0"]

    def _show_preview(self) -> None:
        if self._plan is None or self._arm is None:
            return
        path: List[np.ndarray] = list(self._plan.joint_path)
        place = 0.01 * self._preview.value * (len(path) - 1)
        index = min(int(place), len(path) - 2)
        self._arm.set_positions(path[index] + (place - index) * (path[index + 1] - path[index]))
        self._arm.set_visible(True)

    # --- Execution -------------------------------------------------------------------------------------------------

    def _send(self, stop_count: int) -> None:
        plan, joints = self._plan, self._robot.joint_positions
        if plan is None:
            return
        if joints is None:
            self._forget_plan()
            self._say_missing_state()
            return
        if not plan.starts_at(joints):
            self._solve()
            self._say("The arm has moved since the preview. Look at the new preview, then execute it.")
            return
        if self._goal is not None:
            if not self._goal.has_ended:
                self._say("The last motion still runs: cancel it, or wait for its end")
                return
            self._goal.remove()
        self._execute.disabled = True
        self._goals_folder.visible = True
        self._goal = GoalView(self._client.gui, self._goals_folder, self._robot.goals, plan.name, plan.action,
                              plan.goal(0.01 * within_limits(self._speed)), stop_count, lambda _goal: self._in_loop(self._on_end))

    def _on_end(self) -> None:
        self._forget_plan()
        self._say(NO_PLAN)
