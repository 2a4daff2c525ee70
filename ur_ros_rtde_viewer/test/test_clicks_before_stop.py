"""Clicks that precede STOP start nothing after it, without ROS: their goals may be sent later, in other threads."""

import asyncio
import inspect
from types import SimpleNamespace
from unittest.mock import MagicMock

import numpy as np
import pytest
from ur_ros_rtde_viewer.control import goals as goals_module
from ur_ros_rtde_viewer.control.form_panel import FormPanel
from ur_ros_rtde_viewer.control.goals import Goals, Phase
from ur_ros_rtde_viewer.control.robot_control import RobotControl
from ur_ros_rtde_viewer.control.target_panel import TargetPanel
from ur_ros_rtde_viewer.state.robot_state import Joints, RobotState

from ur_ros_rtde_msgs.action import MoveJ

BACKGROUND = True


@pytest.fixture
def robot(control, monkeypatch):
    """A RobotControl whose actions do not answer."""
    monkeypatch.setattr(goals_module, "ActionClient", lambda node, action, name: MagicMock())
    state = RobotState(joints=Joints(0.0, *np.zeros((3, 6))), age=0.0, pose_age=0.0)
    created = RobotControl(control, MagicMock(state=state), MagicMock(), lambda: None)
    created.action_types = {"move_j": "ur_ros_rtde_msgs/action/MoveJ"}
    return created


def sent_goals(robot):
    return robot.goals.client("move_j", MoveJ).send_goal_async.call_args_list


class Page:
    """Calls callbacks as viser does: coroutines in its event loop, in the order of the messages, and functions in other threads."""

    def __init__(self, server):
        self._loop, self._executor = server._event_loop, server._thread_executor

    def click(self, button):
        """Returns the calls of the callbacks, each of which has begun if it is a coroutine."""
        calls = [asyncio.run_coroutine_threadsafe(callback(MagicMock()), self._loop) if inspect.iscoroutinefunction(callback)
                 else self._executor.submit(callback, MagicMock()) for callback in button._impl.update_cb]
        asyncio.run_coroutine_threadsafe(asyncio.sleep(0), self._loop).result(20.0)
        return calls

    def stop(self, robot):
        async def stop():
            robot.stop(lambda outcome, text: None)

        asyncio.run_coroutine_threadsafe(stop(), self._loop).result(20.0)


def wait_for(calls):
    for call in calls:
        call.result(20.0)


@pytest.fixture
def form(server, robot):
    panel = FormPanel(server.gui, server.gui.add_folder("commands"), robot)
    panel._use_current_position()
    return panel


@pytest.mark.parametrize("stops", [False, True])
def test_a_form_that_is_still_read_when_stop_is_pressed_sends_nothing(server, robot, form, stops):
    page = Page(server)
    with form._lock:  # another callback has it
        calls = page.click(form._send_button)
        if stops:
            page.stop(robot)
    wait_for(calls)
    assert len(sent_goals(robot)) == (0 if stops else 1)
    goal = form._goals[0]._goal
    assert (goal.phase, goal.message) == ((Phase.CANCELED, "not sent, because STOP was pressed") if stops else (Phase.SENT, ""))


@pytest.mark.parametrize("stops", [False, True])
def test_execute_that_waits_for_the_loop_when_stop_is_pressed_sends_nothing(server, robot, stops):
    page, posted = Page(server), []
    panel = TargetPanel(SimpleNamespace(gui=server.gui, scene=MagicMock()), server.gui.add_folder("target"), robot, posted.append)
    panel._plan = MagicMock(action=MoveJ, goal=lambda fraction: MoveJ.Goal())
    panel._plan.name = "move_j"
    wait_for(page.click(panel._execute))
    if stops:
        page.stop(robot)
    for function in posted[:]:
        function()
    assert len(sent_goals(robot)) == (0 if stops else 1)


def test_a_click_after_stop_sends_its_goal(server, robot, form):
    page = Page(server)
    page.stop(robot)
    wait_for(page.click(form._send_button))
    assert len(sent_goals(robot)) == 1


def test_stop_is_counted_before_anything_else(robot):
    counts = []
    robot.jog.stop = lambda: counts.append(robot.goals.stop_count)
    robot.stop(lambda outcome, text: None)
    assert counts == [1]


def test_a_goal_that_waits_for_its_server_is_not_sent_after_stop(control):
    goals, changes = Goals(control, ""), []
    goals.client = MagicMock()
    goals.client.return_value.server_is_ready.return_value = False
    goals.send("move_j", MoveJ, MoveJ.Goal(), lambda sent: changes.append(sent.phase))
    goals.cancel_unaccepted()
    goals.client.return_value.server_is_ready.return_value = True
    control.node.create_timer.call_args.args[1]()
    assert changes == [Phase.CANCELING, Phase.CANCELED] and not goals.client.return_value.send_goal_async.called
