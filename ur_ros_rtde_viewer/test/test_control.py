"""The control side without a browser: forms of all actions, and no way to a motion without --control."""

import contextlib
import importlib
import threading
from types import SimpleNamespace
from unittest.mock import MagicMock

import pytest
from running_viewer import RunningViewer, until
from support import Client
from ur_ros_rtde_cli import interface_files
from ur_ros_rtde_cli.fields import FieldError
from ur_ros_rtde_viewer.control import action_forms, form_panel
from ur_ros_rtde_viewer.control.action_forms import Kind, Source
from ur_ros_rtde_viewer.control.form_panel import FormPanel
from ur_ros_rtde_viewer.control.goals import Goals, Phase
from ur_ros_rtde_viewer.control.twin import Twin
from ur_ros_rtde_viewer.page.sliders import within_limits
from ur_ros_rtde_viewer.state.robot_state import RobotState
from viser import GuiFolderHandle

from ur_ros_rtde_msgs.action import ExecuteTrajectory, ForceMode, MoveJ, MoveL, MoveLRelative

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


def test_after_stop_a_goal_that_is_not_accepted_yet_is_canceled():
    node, server, changes = MagicMock(), MagicMock(), []
    node.post = lambda function: function()
    goals = Goals(node, "")
    goals.client = lambda name, action: server
    goal = goals.send("move_j", MoveJ, MoveJ.Goal(), lambda sent: changes.append(sent.phase))
    goals.cancel_unaccepted()
    (on_response,), _ = server.send_goal_async.return_value.add_done_callback.call_args
    response = MagicMock()
    on_response(response)
    response.result.return_value.cancel_goal_async.assert_called_once()
    assert goal.phase == Phase.CANCELING and changes == [Phase.CANCELING]


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
