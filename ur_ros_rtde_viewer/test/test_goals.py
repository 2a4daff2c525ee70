"""Goals of the page, without ROS: what is offered, sent and canceled, and how goals end."""

import logging
import os
import signal
import threading
import time
from types import SimpleNamespace
from unittest.mock import MagicMock

import pytest
import rclpy
from rclpy.clock import ClockType
from ur_ros_rtde_cli import interruptions
from ur_ros_rtde_cli.driver_watch import CHECK_PERIOD, LOSS_TIME, loss
from ur_ros_rtde_viewer.control import goals as goals_module
from ur_ros_rtde_viewer.control.control_node import ControlNode, create_steady_timer
from ur_ros_rtde_viewer.control.goals import CANCEL_TIMEOUT, DISCOVERY_TIMEOUT, Goals, Phase, end_all
from ur_ros_rtde_viewer.control.stop import Stopper

from ur_ros_rtde_msgs.action import MoveJ

BACKGROUND = True
BRAKING_TIMEOUT = 30.0  # s, of the driver


@pytest.mark.parametrize("namespace", ["", "left", "cell/left"])
def test_only_actions_of_the_driver_are_offered(control, namespace):
    names = ["move_j", "dashboard/stop", "arm/move_j", "arm/dashboard/stop", "dashboard/arm/stop", "move_group/plan"]
    prefix = f"/{namespace}/" if namespace else "/"
    topics = [f"{action}/_action/feedback" for action in (*(prefix + name for name in names), "/other/move_j")]
    control.node.get_topic_names_and_types.return_value = [(topic, ["p/action/A_FeedbackMessage"]) for topic in topics]
    assert Goals(control, namespace).served() == {"move_j": "p/action/A", "dashboard/stop": "p/action/A"}


def test_after_stop_a_goal_that_is_not_accepted_yet_is_canceled(control):
    server, changes = MagicMock(), []
    goals = Goals(control, "")
    goals.client = lambda name, action: server
    goal = goals.send("move_j", MoveJ, MoveJ.Goal(), lambda sent: changes.append(sent.phase))
    goals.cancel_unaccepted()
    (on_response,), _ = server.send_goal_async.return_value.add_done_callback.call_args
    response = MagicMock()
    on_response(response)
    response.result.return_value.cancel_goal_async.assert_called_once()
    assert goal.phase == Phase.CANCELING and changes == [Phase.CANCELING]


def test_a_tab_that_is_closed_after_the_node_changes_nothing():
    context = rclpy.Context()
    rclpy.init(context=context)
    node = ControlNode(context)
    node.start()
    node.close()
    node.post(lambda: pytest.fail("it was called"))
    context.try_shutdown()


def test_posted_functions_are_called_in_their_order():
    context = rclpy.Context()
    rclpy.init(context=context)
    node, called, ended = ControlNode(context), [], threading.Event()
    for number in range(5):
        node.post(lambda number=number: called.append(number))
    node.post(lambda: 1 / 0)
    node.post(lambda: called.append("after a failure"))
    node.post(ended.set)
    node.start()
    assert ended.wait(20.0) and called == [0, 1, 2, 3, 4, "after a failure"]
    node.close()
    context.try_shutdown()


@pytest.fixture
def clock(monkeypatch):
    now = [1000.0]
    monkeypatch.setattr(goals_module.time, "monotonic", lambda: now[0])
    return now


def serve(control, *identifiers):
    control.node.get_publishers_info_by_topic.return_value = [SimpleNamespace(endpoint_gid=list(number)) for number in identifiers]


def accepted_goal(goals, on_change):
    """Returns a running goal, and the callback of its result."""
    server, response = MagicMock(), MagicMock()
    goals.client = lambda name, action: server
    goal = goals.send("move_j", MoveJ, MoveJ.Goal(), on_change)
    server.send_goal_async.return_value.add_done_callback.call_args.args[0](response)
    return goal, response.result().get_result_async().add_done_callback.call_args.args[0]


@pytest.mark.parametrize("others", [[], [b"restarted"]])
@pytest.mark.parametrize("canceled", [True, False])
def test_a_goal_ends_with_its_driver(control, clock, others, canceled):
    serve(control, b"driver")
    goals, changes = Goals(control, ""), []
    goal, on_result = accepted_goal(goals, lambda sent: changes.append((sent.phase, sent.message)))
    if canceled:
        goals.cancel(goal)
    check = control.node.create_timer.call_args.args[1]
    check()
    serve(control, *others)
    clock[0] += CHECK_PERIOD
    check()
    clock[0] += 0.9 * LOSS_TIME
    check()
    assert not goal.has_ended
    clock[0] += 0.2 * LOSS_TIME
    check()
    assert goal.ended.is_set() and changes[-1] == (Phase.FAILED, loss(goal.action))
    count = len(changes)
    on_result(MagicMock())
    check()
    assert len(changes) == count and goal.phase == Phase.FAILED


def test_a_driver_that_is_missing_for_a_moment_keeps_its_goals(control, clock):
    goals = Goals(control, "")
    serve(control, b"driver", b"another")
    goal, _ = accepted_goal(goals, lambda sent: None)
    check = control.node.create_timer.call_args.args[1]
    for identifiers in ([], [b"driver"], [], [b"driver"]):
        serve(control, *identifiers)
        check()
        clock[0] += 0.8 * LOSS_TIME
    assert goal.phase == Phase.RUNNING


def test_the_end_waits_for_all_goals_together_as_long_as_the_arm_may_brake(control, clock, caplog):
    robots = [Goals(control, name) for name in ("left", "right")]
    for goals in robots:
        goal, _ = accepted_goal(goals, lambda sent: None)
        goal.ended.wait = lambda timeout: clock.__setitem__(0, clock[0] + timeout)
    accepted_goal(robots[0], lambda sent: None)[0].change(Phase.SUCCEEDED)
    begin = clock[0]
    with caplog.at_level(logging.INFO):
        end_all(robots, lambda: False)
    assert clock[0] - begin == pytest.approx(CANCEL_TIMEOUT) and CANCEL_TIMEOUT > BRAKING_TIMEOUT
    assert "waiting up to 35 s for the end of /left/move_j and /right/move_j" in caplog.text
    assert "/left/move_j and /right/move_j may still be running" in caplog.text


def test_the_end_does_not_wait_without_goals(control, caplog):
    goals = Goals(control, "")
    accepted_goal(goals, lambda sent: None)[0].change(Phase.SUCCEEDED)
    with caplog.at_level(logging.INFO):
        end_all([goals], lambda: pytest.fail("it has waited"))
    assert not caplog.text


def test_a_second_signal_ends_the_wait(control, monkeypatch):
    monkeypatch.setattr(interruptions, "SECOND_SIGNAL_AFTER", 0.0)
    goals = Goals(control, "")
    goal, _ = accepted_goal(goals, lambda sent: None)
    interruption = interruptions.PendingInterruption()
    try:
        os.kill(os.getpid(), signal.SIGINT)
        assert interruption.take() is not None and not interruption.is_pending
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
        begin = time.monotonic()
        end_all([goals], lambda: interruption.is_pending)
        assert 0.2 < time.monotonic() - begin < 0.5 * CANCEL_TIMEOUT and goal.phase == Phase.CANCELING
    finally:
        interruption.restore_handlers()


def fail(_sent):
    raise RuntimeError("Cannot assign to 'content' on a removed GuiMarkdownHandle.")


def test_a_cancel_is_sent_and_repeated_although_it_cannot_be_shown(control, caplog):
    server, response, goals = MagicMock(), MagicMock(), Goals(control, "")
    goals.client = lambda name, action: server
    goal = goals.send("move_j", MoveJ, MoveJ.Goal(), fail)
    server.send_goal_async.return_value.add_done_callback.call_args.args[0](response)
    goals.cancel(goal)
    goals.cancel(goal)
    assert goal.phase == Phase.CANCELING and response.result().cancel_goal_async.call_count == 2
    assert "removed GuiMarkdownHandle" in caplog.text


def test_stop_cancels_the_goals_after_one_that_cannot_be_shown(control):
    goals = Goals(control, "")
    goals.client = MagicMock()
    sent = [goals.send("move_j", MoveJ, MoveJ.Goal(), on_change) for on_change in (fail, fail, lambda sent: None)]
    goals.cancel_unaccepted()
    assert [goal.phase for goal in sent] == [Phase.CANCELING] * 3


def clocks_of_timers(control):
    return [call.kwargs["clock"].clock_type for call in control.node.create_timer.call_args_list]


def test_the_timeout_of_the_discovery_does_not_follow_the_system_clock(control, clock):
    goals = Goals(control, "")
    goals.client = MagicMock()
    goals.client.return_value.server_is_ready.return_value = False
    goal = goals.send("move_j", MoveJ, MoveJ.Goal(), lambda sent: None)
    check = control.node.create_timer.call_args.args[1]
    for elapsed in (0.9, 1.1):
        clock[0] = 1000.0 + elapsed * DISCOVERY_TIMEOUT
        assert goal.phase == Phase.SENT
        check()
    assert goal.phase == Phase.REJECTED and clocks_of_timers(control) == [ClockType.STEADY_TIME] * 2


def test_the_timeouts_of_stop_do_not_follow_the_system_clock(control):
    Stopper(control, MagicMock()).press(lambda outcome, text: None)
    assert clocks_of_timers(control) == [ClockType.STEADY_TIME]


def test_a_steady_timer_calls_back():
    context = rclpy.Context()
    rclpy.init(context=context)
    node, called = ControlNode(context), threading.Event()
    timer = create_steady_timer(node.node, 0.01, called.set)
    node.start()
    assert called.wait(20.0) and timer.clock.clock_type == ClockType.STEADY_TIME
    node.close()
    context.try_shutdown()
