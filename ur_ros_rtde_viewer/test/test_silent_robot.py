"""A robot whose joint states do not arrive anymore, without ROS: nothing begins with its last position."""

from types import SimpleNamespace
from unittest.mock import MagicMock

import numpy as np
import pytest
from ur_ros_rtde_viewer.control import goals as goals_module
from ur_ros_rtde_viewer.control.action_forms import Source
from ur_ros_rtde_viewer.control.form_panel import FormPanel
from ur_ros_rtde_viewer.control.robot_control import RobotControl
from ur_ros_rtde_viewer.control.target_panel import TargetPanel
from ur_ros_rtde_viewer.state.robot_state import Joints, Pose, RobotState

from ur_ros_rtde_msgs.action import MoveJ

BACKGROUND = True
SILENCE = r"no messages on /joint\_states for 4 s"
FAKE = r"no messages on /tcp\_pose for 4 s"  # the digital twin of a silent robot publishes joint states


@pytest.fixture
def robot(control, monkeypatch):
    monkeypatch.setattr(goals_module, "ActionClient", lambda node, action, name: MagicMock())
    pose = Pose(np.zeros(3), np.array((1.0, 0.0, 0.0, 0.0)))
    state = RobotState(joints=Joints(0.0, *np.zeros((3, 6))), tcp_pose=pose, age=0.0, pose_age=0.0)
    view = MagicMock(state=state)
    view.topics.name_of = lambda name: f"/{name}"
    created = RobotControl(control, view, MagicMock(), lambda: None)
    created.action_types = {"move_j": "ur_ros_rtde_msgs/action/MoveJ"}
    return created


@pytest.fixture
def target(server, robot):
    client = SimpleNamespace(gui=server.gui, scene=MagicMock())
    panel = TargetPanel(client, server.gui.add_folder("target"), robot, lambda function: function())
    panel._gizmo = SimpleNamespace(position=np.zeros(3), wxyz=np.array((1.0, 0.0, 0.0, 0.0)))
    return panel


def sent_goals(robot, action="move_j"):
    return robot.goals.client(action, MoveJ).send_goal_async.call_args_list


@pytest.mark.parametrize("age, pose_age, reason", [(0.5, 0.5, None), (4.0, 4.0, SILENCE), (0.0, 4.0, FAKE)])
def test_a_preview_is_executed_only_while_the_position_is_known(robot, target, age, pose_age, reason):
    target._plan = MagicMock(action=MoveJ, goal=lambda fraction: MoveJ.Goal())
    target._plan.name = "move_j"
    target._execute.disabled = False
    robot.view.state.age, robot.view.state.pose_age = age, pose_age
    target._send(robot.goals.stop_count)
    assert target._execute.disabled and len(sent_goals(robot)) == (0 if reason else 1)
    assert reason is None or reason in target._text.content


def test_no_preview_begins_at_an_old_position(robot, target):
    robot.view.state.age = 4.0
    target._solve()
    assert not sent_goals(robot, "get_inverse_kinematics") and SILENCE in target._text.content
    robot.view.state.age = 0.0
    target._solve()
    assert len(sent_goals(robot, "get_inverse_kinematics")) == 1 and target._text.content == "Planning"


def test_a_target_is_not_shown_at_an_old_position(robot, target):
    robot.view.state.age = 4.0
    target._gizmo = None
    target._show()
    assert target._gizmo is None and SILENCE in target._text.content


def test_a_form_does_not_use_an_old_position(server, robot):
    panel = FormPanel(server.gui, server.gui.add_folder("commands"), robot)
    positions = panel._inputs["joint_positions",]
    assert positions.value == ", ".join(["0.0000"] * 6) and panel._error.content == ""
    robot.view.state.joints = Joints(1.0, *np.ones((3, 6)))
    robot.view.state.age = 4.0
    click(panel)
    assert positions.value == ", ".join(["0.0000"] * 6) and SILENCE in panel._error.content
    assert all(robot.current(source) is None for source in Source)
    robot.view.state.age = 0.0
    click(panel)
    assert positions.value == ", ".join(["1.0000"] * 6) and panel._error.content == ""


def click(panel):
    for callback in panel._position_button._impl.update_cb:
        callback(None)
