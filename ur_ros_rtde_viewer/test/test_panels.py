"""The panels, without ROS: texts, banners, plots, replay."""

from unittest.mock import MagicMock

import numpy as np
import pytest
from ur_ros_rtde_viewer.panels.banner import AMBER, RED, banners
from ur_ros_rtde_viewer.panels.plots_panel import DURATION, PLOTS, SAMPLE_PERIOD, PlotsPanel
from ur_ros_rtde_viewer.panels.replay_panel import NO_FILE, ReplayPanel
from ur_ros_rtde_viewer.panels.state_panel import StatePanel, arm_rows, roll_pitch_yaw, signal_rows, state_rows
from ur_ros_rtde_viewer.state.history import History
from ur_ros_rtde_viewer.state.robot_state import MAX_REJECTIONS, ActiveGoal, DriverStatus, Joints, Pose, Rejection, RobotState, Signals
from viser import UploadedFile


def moving(stamp=0.0, position=0.0):
    return RobotState(joints=Joints(stamp, np.full(6, position), np.full(6, 0.1), np.zeros(6)), age=0.0)


def banner(state, has_model=True, error=""):
    """Returns color and text of the only banner, None if there is none."""
    found = banners(state, "left", "/left/joint_states", has_model, error)
    assert len(found) <= 1
    return found[0] if found else None


def test_a_ready_robot_has_no_banner():
    state = moving()
    state.safety_mode, state.driver = "NORMAL", DriverStatus("READY", 0, "")
    assert banner(state) is None


@pytest.mark.parametrize("mode", ["PROTECTIVE_STOP", "ROBOT_EMERGENCY_STOP", "VIOLATION", "FAULT"])
def test_a_safety_stop_has_a_red_banner_with_cause_and_remedy(mode):
    state = moving()
    state.safety_mode, state.driver = mode, DriverStatus("STOPPED", 7, "call make_ready")
    color, text = banner(state)
    assert color == RED and mode.replace("_", " ") in text and "call make_ready" in text


def test_a_missing_driver_a_silent_one_and_an_unknown_model_are_explained():
    color, text = banner(RobotState())
    assert color == AMBER and "/left/joint_states" in text and "ROS_DOMAIN_ID" in text
    color, text = banner(RobotState(other_drivers=("/", "/right")))
    assert color == AMBER and text == ("left: no messages on /left/joint_states, but there is a driver in / and /right. Start the viewer "
                                       "with its namespace: --namespace /")
    silent = moving()
    silent.age = 4.0
    assert "for 4 s" in banner(silent)[1]
    unknown = moving()
    assert "reports no model" in banner(unknown, has_model=False)[1] and "--model" in banner(unknown, has_model=False)[1]
    assert banner(unknown, has_model=False, error='model is "ur99"') == (AMBER, 'left: model is "ur99"')


def test_a_safety_stop_of_a_silent_robot_may_have_ended():
    state = moving()
    state.safety_mode, state.age = "PROTECTIVE_STOP", 4.0
    (first, _), (second, text) = banners(state, "left", "/left/joint_states", True, "")
    assert (first, second) == (RED, AMBER) and "no messages on /left/joint_states for 4 s" in text


def test_a_stopped_driver_shows_its_message():
    state = moving()
    state.driver = DriverStatus("STOPPED", 10, "press play on the pendant")
    assert banner(state) == (AMBER, "left: press play on the pendant")


def test_the_banner_of_the_digital_twin_is_shown_beside_every_other_one():
    state = moving()
    state.joint_states_are_fake = True
    fake = (AMBER, "left: /left/joint_states has fake positions (digital twin). The blue ghost shows the robot.")
    assert banner(state) == fake
    state.driver = DriverStatus("STOPPED", 7, "call make_ready")
    assert banners(state, "left", "/left/joint_states", True) == [(AMBER, "left: call make_ready"), fake]
    state.safety_mode = "PROTECTIVE_STOP"
    assert banners(state, "left", "/left/joint_states", True) == [(RED, "left: PROTECTIVE STOP: call make_ready"), fake]


def test_an_active_mode_has_a_banner_and_a_row():
    state = moving()
    state.active_modes = ("freedrive",)
    assert banner(state) == (AMBER, "left: freedrive active: forces move the arm. STOP ends it.")
    assert dict(state_rows(state))["Active modes"] == "freedrive"


def test_the_arm_is_shown_in_numbers():
    state = moving(position=0.5)
    state.tcp_pose, state.wrench = Pose(np.array((0.1, -0.2, 0.3)), np.array((0.0, 1.0, 0.0, 0.0))), np.arange(6.0)
    rows = {title: text.split() for title, text in arm_rows(state)}
    assert rows["Elbow"] == ["0.5000", "rad", "28.6°"] and len(rows) == 10
    assert rows["TCP in base"] == ["0.1000", "-0.2000", "0.3000", "m"]
    assert rows["Roll, pitch, yaw"] == ["180.0", "0.0", "0.0", "°"]
    assert rows["Force, TCP frame"] == ["0.0", "1.0", "2.0", "N"] and rows["Torque, TCP frame"][-2:] == ["N", "m"]
    assert arm_rows(RobotState()) == []


def test_inputs_and_outputs_are_shown_by_pin():
    state = moving()
    assert signal_rows(state) == []
    state.signals = Signals(tuple(pin in (2, 9, 17) for pin in range(18)), (False,) * 18, (0.004, 5.0), (0.0, 0.012))
    rows = {title: text.split() for title, text in signal_rows(state)}
    assert rows["Digital inputs on"] == ["2,", "9,", "tool", "1"] and rows["Digital outputs on"] == ["all", "off"]
    assert rows["Analog inputs, A or V"] == ["0.0040", "5.0000"] and rows["Analog outputs, A or V"] == ["0.0000", "0.0120"]


@pytest.mark.parametrize("wxyz, degrees", [((0.5**0.5, 0, 0, 0.5**0.5), (0, 0, 90)), ((0.5**0.5, 0, 0.5**0.5, 0), (0, 90, 0)),
                                           ((0.5, 0.5, 0.5, 0.5), (90, 0, 90))])
def test_orientations_are_shown_as_angles_about_fixed_axes(wxyz, degrees):
    angles = np.degrees(roll_pitch_yaw(wxyz))
    assert angles[1] == pytest.approx(degrees[1], abs=1e-5) and (degrees[1] == 90 or angles == pytest.approx(degrees, abs=1e-5))


def test_the_state_names_modes_driver_and_goal():
    state = moving()
    state.robot_mode, state.safety_mode, state.program_running, state.speed_scaling = "RUNNING", "NORMAL", True, 0.5
    state.driver, state.goal = DriverStatus("STOPPED", 10, "press play"), ActiveGoal("move_j", 0.25, 1.5)
    assert dict(state_rows(state)) == {"Robot mode": "RUNNING", "Safety mode": "NORMAL", "Program": "running", "Speed scaling": "50 %",
                                       "Driver": "STOPPED", "Cause and remedy": "press play", "Goal": "move_j, 1.5 s"}
    assert dict(state_rows(RobotState()))["Robot mode"] == "unknown"


def test_the_state_panel_shows_progress_and_rejections_without_interpreting_them(server):
    panel = StatePanel(server.gui.add_folder("state"), server.gui, lambda function: function())
    state = moving()
    state.goal = ActiveGoal("move_j", 0.25, 1.5)
    state.rejections.append(Rejection(0.0, "/move_l", "speed is <b>9</b>"))
    panel.update(state)
    assert panel._progress.visible and panel._progress.value == 25
    assert "&lt;b&gt;9" in panel._rejections.content and "<b>" not in panel._rejections.content
    state.goal = None
    panel.update(state)
    assert not panel._progress.visible


def test_rejections_are_bounded():
    state = RobotState()
    for index in range(3 * MAX_REJECTIONS):
        state.rejections.append(Rejection(index, "/move_l", ""))
    assert len(state.rejections) == MAX_REJECTIONS


def test_the_history_keeps_the_newest_rows_in_order():
    history = History(2, 4)
    for index in range(10):
        history.add(np.array((index, 10.0 * index)))
    assert len(history) == 4 and history.rows(100.0)[:, 0].tolist() == [6, 7, 8, 9]
    assert history.rows(1.5)[:, 1].tolist() == [80, 90]
    history.clear()
    assert len(history.rows(1.0)) == 0


@pytest.fixture
def plots(server):
    return PlotsPanel(server.gui.add_folder("plots"), server)


def feed(panel, begin, end, period=0.004):
    for stamp in np.arange(begin, end, period):
        panel.update(moving(float(stamp), float(stamp)))


def test_plots_keep_the_last_30_s_of_a_day(plots):
    end = 86400.0
    feed(plots, end - 2.0 * DURATION, end, 0.03)
    time, *values = plots.data
    assert len(values) == 15 and len(time) <= DURATION / SAMPLE_PERIOD + 1
    assert time[-1] == 0.0 and -DURATION <= time[0] <= -DURATION + 1.0 and values[0][-1] == pytest.approx(end, abs=0.1)


def test_plots_begin_again_when_the_clock_does(plots):
    feed(plots, 100.0, 101.0)
    feed(plots, 5.0, 5.5)
    assert plots.data[1].max() < 6.0


def test_a_paused_plot_keeps_its_curves_and_collects_on(plots, monkeypatch):
    monkeypatch.setattr(plots._server, "get_clients", lambda: {0: None})
    feed(plots, 0.0, 1.0)
    plots._drawn = -np.inf
    plots.update(moving(1.0, 1.0))
    shown = plots._plots[0].data[1].copy()
    plots._pause.value = True
    feed(plots, 1.1, 2.0)
    plots._drawn = -np.inf
    plots.update(moving(2.1, 2.1))
    assert plots.paused and np.array_equal(plots._plots[0].data[1], shown) and plots.data[1][-1] > 2.0
    plots._pause.value = False
    plots.update(moving(2.2, 2.2))
    assert plots._plots[0].data[1][-1] == pytest.approx(2.2) and len(plots._plots) == len(PLOTS)


@pytest.fixture
def replay(server):
    created = ReplayPanel(server.gui.add_folder("replay"), server.gui, MagicMock(), lambda function: function())
    yield created
    created.close()


def test_a_recording_that_fails_for_an_unknown_reason_is_reported(replay, caplog):
    replay.replay("run.csv", lambda ended: 1 / 0)
    replay.close()  # waits for the reader
    assert replay.message.content == "The recording cannot be shown: ZeroDivisionError: division by zero"
    assert "ZeroDivisionError" in caplog.text
    replay.player.load.side_effect = ValueError("no such joint")
    replay._show(MagicMock())
    assert replay.message.content == "The recording cannot be shown: ValueError: no such joint"


def test_the_content_of_an_upload_is_not_kept(replay):
    replay._upload._impl.value = UploadedFile("run.csv", b"a,b")
    replay._replay_upload()
    assert replay._upload.value is NO_FILE
    with pytest.raises(TypeError):  # otherwise, the public setter can be used
        replay._upload.value = UploadedFile("", b"")
    replay._replay_upload()  # of an upload that arrived together with the first one
    replay.close()
    assert "run.csv has no columns" in replay.message.content
