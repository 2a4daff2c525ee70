"""The viewer with a simulator and the driver, and with messages of a test; without a browser."""

import pathlib
import time
from types import SimpleNamespace
from unittest.mock import MagicMock

import numpy as np
import pytest
from programs import Simulator, start_node
from ros_client import Client
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool
from support import HOME, JOINTS, TIMEOUT_FACTOR, own_address
from ur_ros_rtde_cli.driver_watch import loss
from ur_ros_rtde_viewer.control.form_panel import FormPanel
from ur_ros_rtde_viewer.control.goals import Phase
from ur_ros_rtde_viewer.control.recording_panel import RecordingPanel
from ur_ros_rtde_viewer.panels.banner import AMBER, RED, Banner
from ur_ros_rtde_viewer.panels.replay_panel import ReplayPanel
from ur_ros_rtde_viewer.panels.state_panel import StatePanel
from ur_ros_rtde_viewer.playback.motion import read_csv
from ur_ros_rtde_viewer.program import parse
from ur_ros_rtde_viewer.ros.active_goal import ActiveGoalTopic
from ur_ros_rtde_viewer.ros.nodes import Nodes
from ur_ros_rtde_viewer.state.robot_state import ActiveGoal
from ur_ros_rtde_viewer.viewer import Viewer

from ur_ros_rtde_msgs.action import MoveJ

RIGHT = "right"  # a namespace without a driver: the test publishes its topics


@pytest.fixture(scope="module")
def simulator():
    started = Simulator(own_address(), "--surface", "z=-0.3")
    yield started
    started.stop()


@pytest.fixture(scope="module")
def driver(simulator):
    started = start_node("driver", simulator.address)
    yield started
    started.stop()


@pytest.fixture(scope="module")
def client():
    created = Client()
    yield created
    created.close()


@pytest.fixture(scope="module")
def viewer(server, driver, tmp_path_factory):
    recordings = str(tmp_path_factory.mktemp("recordings"))
    options = parse(["--control", "--robot", "", "--robot", f"{RIGHT},model=ur5e,y=-1", "--recordings", recordings])
    nodes = Nodes()
    created = Viewer(server, nodes, options)
    yield created
    created.close()
    nodes.close()


@pytest.fixture
def robot(viewer):
    return viewer.robots[0]


def panel(robot, kind):
    return next(panel for panel in robot.panels if isinstance(panel, kind))


def update_until(viewer, condition, what, limit=40.0):
    """Runs the loop of the viewer until the condition holds."""
    end = time.monotonic() + TIMEOUT_FACTOR * limit
    while not condition():
        assert time.monotonic() < end, f"timeout after {limit} s waiting for {what}"
        viewer.step()


def near(shown, expected):
    return shown is not None and np.allclose(shown.positions, expected, atol=0.005)


def test_shows_the_reported_model_at_the_position_of_the_robot(viewer, robot):
    update_until(viewer, lambda: 'name="ur10e"' in robot.scene.urdf, "the model that the driver reports")
    update_until(viewer, lambda: near(robot.scene.arm, HOME), "the arm to show the position")
    update_until(viewer, lambda: robot.state.is_current, "the pose of the TCP")
    update_until(viewer, lambda: len(robot.scene._surfaces) == 1, "the surface of the simulated world")


def test_follows_a_motion_with_its_goal_and_the_trail(viewer, robot, client):
    update_until(viewer, lambda: robot.state.driver is not None and robot.state.driver.name == "READY", "the driver to be ready")
    before = len(robot.scene.tcp.trail.points)
    goal = client.send(MoveJ, "move_j", joint_positions=[HOME[0] + 1.0, *HOME[1:]], speed=0.3)
    assert goal.accepted
    update_until(viewer, lambda: robot.state.goal is not None and 0.0 < robot.state.goal.progress < 1.0, "the progress of the goal")
    assert robot.state.goal.action == "move_j"
    update_until(viewer, goal.is_finished, "the end of the motion")
    update_until(viewer, lambda: near(robot.scene.arm, [HOME[0] + 1.0, *HOME[1:]]), "the arm at the target")
    assert len(robot.scene.tcp.trail.points) > before + 10
    update_until(viewer, lambda: robot.state.goal is None, "the end of the goal")


def test_the_speed_slider_follows_the_robot_and_sets_its_speed(viewer, robot, simulator):
    slider = panel(robot, StatePanel).speed_slider
    element = slider._element
    assert not element.disabled
    simulator.control("speed_slider", fraction=0.7)
    update_until(viewer, lambda: element.visible and element.value == 70, "the position of the slider of the pendant")
    element.value = 40
    slider._changed()  # as after a change in the page
    update_until(viewer, lambda: simulator.state()["speed_slider"] == pytest.approx(0.4), "the speed of the page")
    update_until(viewer, lambda: not slider.is_held, "the end of the change")
    assert element.value == 40 and slider.message.content == ""
    for percent in (0, 100):
        simulator.control("speed_slider", fraction=percent / 100)
        update_until(viewer, lambda percent=percent: element.value == percent, "the slider to follow again")


def test_shows_a_rejection(viewer, robot, client):
    assert not client.send(MoveJ, "move_j", joint_positions=[0.0, 1.0]).accepted
    update_until(viewer, lambda: robot.state.rejections, "the rejection")
    assert "joint_positions has 2 values" in robot.state.rejections[-1].message


def test_a_protective_stop_has_a_red_banner_and_ends(viewer, robot, simulator):
    simulator.control("protective_stop", reason="a test")
    banner = panel(robot, Banner)
    update_until(viewer, lambda: [color for color, _ in banner.shown] == [RED], "the banner")
    assert "PROTECTIVE STOP" in banner.shown[0][1] and banner._area._element.visible
    update_until(viewer, simulator.unlock_protective_stop, "the end of the unlock delay")
    simulator.control("power", to="running")
    update_until(viewer, lambda: robot.state.safety_mode == "NORMAL" and RED not in dict(banner.shown),
                 "the end of the red banner")


def test_the_digital_twin_moves_while_the_robot_stays(viewer, robot, simulator):
    twin, shown = viewer.control._robots[0].twin, []
    real = simulator.state()["actual"]["position"]
    twin.begin("tab", lambda *text: shown.append(text))
    update_until(viewer, lambda: shown == [(True, "")], "the digital twin")
    twin.begin("other tab", lambda *text: shown.append(text))
    assert shown.pop() == (False, "The digital twin is on in another tab of the browser.")
    twin.publish("other tab", [0.0] * 6)
    twin.publish("tab", [real[0] - 0.7, *real[1:]])
    update_until(viewer, lambda: near(robot.scene.arm, [real[0] - 0.7, *real[1:]]), "the fake position")
    update_until(viewer, lambda: near(robot.scene.ghost, real), "the real position as the ghost")
    assert "/joint_states has fake positions" in panel(robot, Banner).shown[0][1]
    assert simulator.state()["actual"]["position"] == pytest.approx(real, abs=1e-3)
    twin.end("other tab")
    twin.end("tab")
    assert shown.pop() == (False, "")
    update_until(viewer, lambda: near(robot.scene.arm, real) and not robot.state.joint_states_are_fake, "the end of the digital twin")


def test_the_digital_twin_ends_if_another_program_ends_it(viewer, robot, client):
    twin, shown = viewer.control._robots[0].twin, []
    twin.begin("tab", lambda *text: shown.append(text))
    update_until(viewer, lambda: shown and robot.state.joint_states_are_fake, "the digital twin")
    viewer.step()
    assert client.call(SetBool, "publish_fake_joint_states", data=False).success
    update_until(viewer, lambda: len(shown) == 2, "the end of the digital twin")
    assert shown[1] == (False, "The digital twin has ended: the driver or another program has ended it.")


@pytest.mark.parametrize("start, mode", [("freedrive_start", "freedrive"), ("force_mode_start", "force_mode")])
def test_a_mode_ends_with_the_tab_that_has_started_it(viewer, robot, server, client, start, mode):
    control = viewer.control._robots[0]
    update_until(viewer, lambda: start in control.action_types, "the actions of the driver")
    tabs = [FormPanel(server.gui, server.gui.add_folder("commands"), control) for _ in range(2)]
    for tab in tabs:
        tab._action.value = start
    if start == "force_mode_start":
        tabs[0]._inputs["compliant",].value = "false, false, true, false, false, false"
    tabs[0]._send(control.goals.stop_count)
    update_until(viewer, lambda: robot.state.active_modes == (mode,), "the mode")
    tabs[1].close()
    for _ in range(30):
        viewer.step()
    assert robot.state.active_modes == (mode,)
    tabs[0].close()
    update_until(viewer, lambda: robot.state.active_modes == (), "the end of the mode")


def test_records_and_replays(viewer, robot):
    recording, replay = panel(robot, RecordingPanel), panel(robot, ReplayPanel)
    recording.toggle()
    update_until(viewer, lambda: recording.is_recording, "the start of the recording")
    file = pathlib.Path(recording._file)
    update_until(viewer, lambda: file.is_file() and file.stat().st_size > 10000, "rows in the file")
    recording.toggle()
    update_until(viewer, lambda: not recording.is_recording, "the end of the recording")
    update_until(viewer, lambda: replay.player.playing, "the replay")
    assert recording._download.visible
    assert replay.player.arm.positions == pytest.approx(robot.scene.arm.positions, abs=0.01)
    replay.replay("wrong.csv", lambda ended: read_csv("wrong.csv", b"a,b\n", ended))
    update_until(viewer, lambda: "wrong.csv has no columns actual_q_0" in replay.message.content, "the reason")
    replay.player.remove()


def test_a_second_robot_is_independent_and_has_a_prefix(viewer, client):
    right = viewer.robots[1]
    assert panel(right, Banner).shown[0][0] == AMBER and right.scene.arm.positions != pytest.approx(np.zeros(6))
    publisher = client.node.create_publisher(JointState, f"/{RIGHT}/joint_states", 10)
    positions = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]
    message = JointState(name=[f"right_{joint}" for joint in reversed(JOINTS)], position=positions[::-1])

    def shown():
        publisher.publish(message)
        return near(right.scene.arm, positions)

    update_until(viewer, shown, "the joints in another order and with a prefix")
    assert right.topics.joint_names[2] == "right_elbow_joint"
    shown_before = right.scene.arm.positions
    publisher.publish(JointState(name=["a"], position=[1.0]))
    publisher.publish(JointState(name=JOINTS, position=[]))
    viewer.step()
    assert right.scene.arm.positions == pytest.approx(shown_before)


def test_a_viewer_with_the_wrong_namespace_names_the_driver(server, driver):
    nodes = Nodes()
    viewer = Viewer(server, nodes, parse(["--namespace", "nope"]))
    try:
        banner = panel(viewer.robots[0], Banner)
        update_until(viewer, lambda: banner.shown and "there is a driver in /. " in banner.shown[0][1], "the banner")
    finally:
        viewer.close()
        nodes.close()


def test_posted_functions_run_in_the_loop_and_a_failing_one_is_logged(viewer, caplog):
    called = []
    viewer.post(lambda: 1 / 0)
    viewer.post(lambda: called.append(True))
    viewer.step()
    assert called and "ZeroDivisionError" in caplog.text


def test_an_error_of_a_panel_is_logged_once_and_the_page_goes_on(viewer, robot, caplog, monkeypatch):
    monkeypatch.setattr(robot, "update", lambda: [].remove("panel"))
    for _ in range(3):
        viewer.step()
    assert caplog.text.count("\nValueError: ") == 1


def test_a_goal_of_a_package_that_is_not_in_this_workspace_has_no_progress(viewer):
    nodes = SimpleNamespace(node=MagicMock())
    nodes.node.get_topic_names_and_types.return_value = [("/wag/_action/feedback", ["my_commands/action/Wag_FeedbackMessage"])]
    topic = ActiveGoalTopic(nodes, "/")
    topic.on_holder("/wag, goal 51b26db5")
    assert topic.goal == ActiveGoal("wag", 0.0, 0.0)
    nodes.node.create_subscription.assert_not_called()


def test_a_restart_of_the_driver_after_a_crash_is_shown_and_survived(viewer, robot, simulator, driver):
    positions = [HOME[0] - 1.0, *HOME[1:]]
    goal = viewer.control._robots[0].goals.send("move_j", MoveJ, MoveJ.Goal(joint_positions=positions, speed=0.05), lambda _goal: None)
    update_until(viewer, lambda: goal.phase == Phase.RUNNING, "the motion")
    driver.kill()
    banner = panel(robot, Banner)
    update_until(viewer, lambda: banner.shown and "no messages on /joint_states for" in banner.shown[0][1], "the banner")
    restarted = start_node("driver", simulator.address)
    try:
        update_until(viewer, lambda: robot.state.age < 0.5 and not banner.shown, "the state of the restarted driver")
        update_until(viewer, lambda: goal.has_ended, "the end of the goal")
        assert (goal.phase, goal.message) == (Phase.FAILED, loss("/move_j"))
    finally:
        restarted.stop()
