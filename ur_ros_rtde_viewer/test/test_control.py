"""The control side without a browser: forms of all actions, and no way to a motion without --control."""

import contextlib
import importlib
import threading
from types import SimpleNamespace
from unittest.mock import MagicMock

import numpy as np
import pytest
from action_msgs.msg import GoalStatus
from ros_client import Client
from running_viewer import RunningViewer, until
from ur_ros_rtde_cli import interface_files
from ur_ros_rtde_cli.fields import FieldError
from ur_ros_rtde_viewer.control import action_forms, form_panel
from ur_ros_rtde_viewer.control.action_forms import Kind, Source
from ur_ros_rtde_viewer.control.form_panel import FormPanel
from ur_ros_rtde_viewer.control.goals import Goals, Phase
from ur_ros_rtde_viewer.control.modes import Modes
from ur_ros_rtde_viewer.control.recording_panel import RecordingPanel
from ur_ros_rtde_viewer.control.target_panel import TargetPanel
from ur_ros_rtde_viewer.control.twin import Twin
from ur_ros_rtde_viewer.page.sliders import within_limits
from ur_ros_rtde_viewer.state.robot_state import RobotState
from viser import GuiFolderHandle

from ur_ros_rtde_msgs.action import ExecuteTrajectory, ForceMode, Freedrive, MoveJ, MoveL, MoveLRelative
from ur_ros_rtde_msgs.srv import StartRecording, StopRecording

BACKGROUND = True
VIEWER_NODES = ("ur_viewer", "ur_viewer_topics")


def installed_actions():
    for prefix in interface_files.prefixes():
        for file in sorted(interface_files.pathlib.Path(prefix, "share").glob("ur_ros_rtde*/action/*.action")):
            yield pytest.param(file.parents[1].name, file.stem, id=file.stem)


def form(action):
    return action_forms.describe("move", action)


def read(action, path, text):
    described = form(action)
    return described.read({**described.defaults(), path: text})


@pytest.mark.parametrize("package, name", installed_actions())
def test_each_installed_action_has_a_form(package, name):
    action = getattr(importlib.import_module(f"{package}.action"), name)
    described = form(action)
    assert described.description
    outermost = {field.path[0] for field in described.fields}
    assert outermost == set(action.Goal.get_fields_and_field_types()) - {"structure_needs_at_least_one_member"}
    assert described.read(described.defaults()) is not None


def test_units_ranges_and_defaults_are_those_of_the_action_file():
    speed = next(field for field in form(MoveJ).fields if field.path == ("speed",))
    assert (speed.label, speed.default, speed.limits) == ("speed [rad/s]", "0.5", "Unit: rad/s. Range: above 0, at most 3.14.")


def test_constants_are_choices():
    frame = next(field for field in form(MoveLRelative).fields if field.path == ("frame",))
    assert (frame.kind, frame.choices, frame.default) == (Kind.CHOICE, ("BASE", "TOOL"), "BASE")
    assert read(MoveLRelative, ("frame",), "TOOL").frame == MoveLRelative.Goal.TOOL


def test_targets_begin_with_the_state_of_the_arm():
    assert [field.source for field in form(MoveJ).fields] == [Source.JOINT_POSITIONS, Source.NONE, Source.NONE]
    assert [field.source for field in form(MoveL).fields][:2] == [Source.TCP_POSITION, Source.TCP_ORIENTATION]


@pytest.mark.parametrize("action, path, text, expected", [
    (MoveJ, ("speed",), "fast", "speed is 'fast': expected a number. Unit: rad/s. Range: above 0, at most 3.14."),
    (MoveJ, ("speed",), "", "speed is empty: expected a number such as 0.5. Unit: rad/s."),
    (MoveJ, ("speed",), "{", "speed is not YAML"),
    (MoveJ, ("joint_positions",), "0, 1, x", "joint_positions[2] is 'x': expected a number. Order: shoulder_pan"),
    (MoveL, ("pose", "position"), "1, 2", "pose.position has 2 values: expected 3 numbers, x, y, z. Unit: m."),
    (MoveL, ("pose", "position"), "1, 2, up", "pose.position.z is 'up': expected a number"),
    (ForceMode, ("compliant",), "true", "compliant has 1 values: expected a list of 6 boolean values"),
    (ExecuteTrajectory, ("waypoints",), "- positions: [0, x]", "waypoints[0].positions[1] is 'x': expected a number"),
    (ExecuteTrajectory, ("waypoints",), "- position: []", "there is no field waypoints[0].position; did you mean positions?"),
])
def test_an_error_names_field_value_limit_and_remedy(action, path, text, expected):
    with pytest.raises(FieldError) as error:
        read(action, path, text)
    assert expected in str(error.value)


def test_brackets_are_optional():
    for text in ("0, 1, 2, 3, 4, 5", "[0, 1, 2, 3, 4, 5]"):
        assert list(read(MoveJ, ("joint_positions",), text).joint_positions) == [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]
    assert list(read(MoveJ, ("joint_positions",), "").joint_positions) == []


def test_two_threads_that_change_the_action_leave_one_form(server, monkeypatch):
    robot = SimpleNamespace(action_types={}, current=lambda source: None)
    panel = FormPanel(server.gui, server.gui.add_folder("commands"), robot)
    robot.action_types = {"move_j": "MoveJ", "move_l": "MoveL"}
    together = threading.Barrier(2)

    def load(name, _kind):
        with contextlib.suppress(threading.BrokenBarrierError):
            together.wait(0.5)  # s; both threads come here if they do not wait for each other
        return {"move_j": MoveJ, "move_l": MoveL}[name]

    monkeypatch.setattr(form_panel.actions, "load", load)
    threads = [threading.Thread(target=panel.update_actions),
               threading.Thread(target=lambda: setattr(panel._action, "value", "move_l"))]  # as the user does
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    folders = [child.label for child in panel._container._children.values() if isinstance(child, GuiFolderHandle)]
    assert folders == ["Goals", panel._action.value] and panel._form.name == panel._action.value


@pytest.fixture
def modes(control):
    """The modes of a robot, of which freedrive is active, and what was sent to the robot: the name and the callback of each goal."""
    created = Modes(control, goals := MagicMock())
    sent = []
    goals.send = lambda name, action, goal, on_change: sent.append((name, on_change))
    (_, _, report, _), _ = control.node.create_subscription.call_args
    created.note("freedrive_start", "tab")
    report(SimpleNamespace(names=["freedrive"]))
    return created, sent, report


@pytest.mark.parametrize("phase, expected", [(Phase.SUCCEEDED, []), (Phase.REJECTED, ["stop"]), (Phase.FAILED, ["stop"])])
def test_a_mode_ends_with_the_tab_that_has_started_it(modes, phase, expected):
    created, sent, _ = modes
    created.note("move_j", "tab")
    created.end("other tab")
    assert sent == []
    created.end("tab")
    (name, on_change), = sent
    on_change(SimpleNamespace(phase=Phase.RUNNING))
    on_change(SimpleNamespace(phase=phase))
    created.end("tab")
    assert name == "freedrive_stop" and [name for name, _ in sent[1:]] == expected


def test_a_mode_that_outlasts_its_tab_is_not_ended(modes):
    created, sent, _ = modes
    created.note("freedrive_start", None)  # started again
    created.end("tab")
    assert sent == []


def test_a_mode_that_has_ended_is_not_ended_again(modes):
    created, sent, report = modes
    report(SimpleNamespace(names=[]))
    report(SimpleNamespace(names=["freedrive"]))  # of another client
    created.end("tab")
    assert sent == []


@pytest.mark.parametrize("outlives", [False, True])
def test_a_mode_that_starts_while_its_tab_is_closed_ends(server, outlives):
    robot = MagicMock(action_types={"freedrive_start": "ur_ros_rtde_msgs/action/Freedrive"}, current=lambda source: None)
    panel = FormPanel(server.gui, server.gui.add_folder("commands"), robot)
    panel._send(0)
    panel.close()
    robot.modes.end.reset_mock()
    panel._on_end("freedrive_start", Freedrive.Goal(outlives_client=outlives), SimpleNamespace(phase=Phase.SUCCEEDED))
    robot.modes.note.assert_called_once_with("freedrive_start", None if outlives else panel)
    robot.modes.end.assert_called_once_with(panel)


def test_a_mode_ends_with_a_tab_whose_connection_was_lost_before_the_result(server, control):
    actions = {name: MagicMock() for name in ("freedrive_start", "freedrive_stop")}
    goals = Goals(control, "")
    goals.client = lambda name, action: actions[name]
    robot = MagicMock(action_types={"freedrive_start": "ur_ros_rtde_msgs/action/Freedrive"}, current=lambda source: None,
                      goals=goals, modes=Modes(control, goals))
    container = server.gui.add_folder("commands")
    panel = FormPanel(server.gui, container, robot)
    panel._send(0)
    container.remove()  # viser removes the elements first
    accepted = MagicMock()
    with contextlib.suppress(RuntimeError):
        actions["freedrive_start"].send_goal_async.return_value.add_done_callback.call_args.args[0](accepted)
    on_result = accepted.result().get_result_async.return_value.add_done_callback.call_args.args[0]
    with contextlib.suppress(RuntimeError):
        on_result(MagicMock(result=lambda: SimpleNamespace(status=GoalStatus.STATUS_SUCCEEDED, result=SimpleNamespace(message=""))))
    panel.close()
    actions["freedrive_stop"].send_goal_async.assert_called_once()


@pytest.fixture
def target(server):
    """A TargetPanel with a target, and the functions that it has posted."""
    posted = []
    robot = MagicMock(joint_positions=np.zeros(6))
    panel = TargetPanel(SimpleNamespace(gui=server.gui, scene=MagicMock()), server.gui.add_folder("target"), robot, posted.append)
    panel._gizmo = SimpleNamespace(position=np.zeros(3), wxyz=np.array((1.0, 0.0, 0.0, 0.0)))
    robot.tcp_pose = SimpleNamespace(position=np.zeros(3), wxyz=np.array((1.0, 0.0, 0.0, 0.0)))
    return panel, robot.goals, posted


def run(posted):
    while posted:
        posted.pop(0)()


def test_the_plan_of_an_older_target_is_not_shown(target):
    panel, goals, posted = target
    panel._motion.value = panel._motion.options[1]
    assert len(posted) == 1 and not goals.send.called  # in the thread of the page
    run(posted)
    old_plan = goals.send.call_args.args[3]
    old_plan(SimpleNamespace(has_ended=True, phase=Phase.FAILED, message="out of reach"))
    panel._solve()  # before the loop runs what was posted
    run(posted)
    assert panel._text.content == "Planning"
    goals.send.call_args.args[3](SimpleNamespace(has_ended=True, phase=Phase.FAILED, message="near a singularity"))
    run(posted)
    assert "near a singularity" in panel._text.content


def test_a_target_panel_that_is_closed_sends_nothing(target):
    panel, goals, posted = target
    panel._plan = MagicMock()
    panel._in_loop(lambda: panel._send(0))
    panel.close()
    run(posted)
    assert not goals.send.called


@pytest.mark.parametrize("accepted", [True, False])
def test_a_recording_that_starts_while_the_viewer_ends_is_stopped(server, tmp_path, accepted):
    services = MagicMock()
    panel = RecordingPanel(server.gui.add_folder("record"), server, services, MagicMock(), tmp_path, lambda function: function())
    panel.toggle()
    (kind, _, answer), _ = services.call.call_args
    assert kind is StartRecording
    services.call.reset_mock()
    panel.close()
    answer(SimpleNamespace(success=accepted, message=""), "")
    assert [call.args[0] for call in services.call.call_args_list] == ([StopRecording] if accepted else [])


def test_the_digital_twin_of_a_silent_robot_ends_with_its_tab():
    view, shown = MagicMock(), []
    twin = Twin(view, MagicMock())
    twin.begin("tab", lambda on, message: shown.append((on, message)))
    twin._answered(SimpleNamespace(success=True), "")
    twin.update(RobotState(joint_states_are_fake=True, age=0.0))
    twin.update(RobotState(joint_states_are_fake=True, age=5.0))  # the connection to the robot was lost
    assert shown == [(True, "")]
    twin.end("tab")
    assert view.services.call.call_args.kwargs == {"data": False} and shown[-1] == (False, "")


def test_a_number_beside_a_slider_is_limited(server):
    slider = server.gui.add_slider("Speed [m/s]", 0.01, 0.25, 0.01, 0.05)
    for typed, used in ((2.5, 0.25), (-0.1, 0.01), (0.1, 0.1)):
        assert within_limits(SimpleNamespace(value=typed, min=slider.min, max=slider.max)) == used


@pytest.fixture
def observer():
    created = Client(name="observer")
    yield created.node
    created.close()


def endpoints(node, names):
    """Returns the publishers and the clients of services and actions of these nodes, as another node sees them."""
    found = {"publishers": node.get_publisher_names_and_types_by_node, "clients": node.get_client_names_and_types_by_node}
    if not set(names) <= set(node.get_node_names()):
        return {kind: set() for kind in found}  # not yet discovered
    return {kind: {topic for name in names for topic, _ in query(name, "/")} for kind, query in found.items()}


def test_without_control_the_page_changes_nothing(observer):
    running = RunningViewer()
    try:
        until(lambda: "ur_viewer" in observer.get_node_names() and "/diagnostics" in
              {topic for topic, _ in observer.get_subscriber_names_and_types_by_node("ur_viewer", "/")}, "the endpoints")
        found = endpoints(observer, VIEWER_NODES)
        assert found == {"publishers": found["publishers"] & {"/rosout", "/parameter_events"}, "clients": set()}
        assert "ur_viewer_control" not in observer.get_node_names() and running.viewer.control is None
    finally:
        running.close()


def test_with_control_the_same_look_finds_what_moves_the_arm(observer):
    running = RunningViewer("--control")
    try:
        until(lambda: "ur_viewer_control" in observer.get_node_names(), "the node of the commands")
        until(lambda: "/twist" in endpoints(observer, ["ur_viewer_control"])["publishers"], "the topic of the jog buttons")
        until(lambda: "/stop/_action/send_goal" in endpoints(observer, ["ur_viewer_control"])["clients"], "the action client of STOP")
        assert "/twist" not in endpoints(observer, VIEWER_NODES)["publishers"]
    finally:
        running.close()
