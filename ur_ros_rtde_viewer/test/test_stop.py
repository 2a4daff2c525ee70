"""STOP: by the driver, and through dashboard_server if the driver does not answer in time."""

import time
from types import SimpleNamespace

import pytest
from arm_state import home_plus
from programs import start_node
from robot_fixtures import make_ready
from running_viewer import RunningViewer, is_moving, until
from ur_ros_rtde_viewer.control import stop
from ur_ros_rtde_viewer.control.control import Control
from ur_ros_rtde_viewer.control.stop import ACCEPTANCE_TIMEOUT, SILENCE_TIMEOUT, Outcome

from ur_ros_rtde_msgs.action import MoveJ

MEASURES_TIME = True
DELAY_OF_THE_HOST = 0.3  # s
THROUGH_THE_DASHBOARD = ("The robot program is being stopped", "The robot program was stopped")


@pytest.fixture
def running():
    viewer = RunningViewer("--control")
    yield viewer
    viewer.close()


@pytest.fixture(scope="module")
def nodes(simulator):
    """The three nodes as processes. Without the watchdog, only STOP can stop the arm."""
    started = {name: start_node(name, simulator.address, *parameters)
               for name, parameters in {"robot_state_receiver": (), "command_server": ("watchdog_frequency:=0.0",),
                                        "dashboard_server": ()}.items()}
    yield started
    for node in started.values():
        node.resume()
        node.stop()
        print(node.output())


def press(running):
    """Presses STOP. Returns a function that returns the text below the button."""
    control = running.viewer.control
    control.stop()
    return lambda: control._stop_text.content


def time_until_fallback(text):
    """Returns the time in s until the program is being stopped through dashboard_server."""
    begin = time.monotonic()
    until(lambda: any(phase in text() for phase in THROUGH_THE_DASHBOARD), "the fallback to dashboard_server")
    return time.monotonic() - begin


def test_without_a_driver_stop_names_the_remedy(running):
    text = press(running)
    until(lambda: "STOP failed" in text(), "the failure")
    assert "neither command_server nor dashboard_server answers. Use the emergency stop button" in text()


def ready_to_stop(running, client):
    make_ready(client)
    stopper = running.viewer.control._robots[0]._stopper
    until(lambda: stopper._stop.server_is_ready() and stopper._dashboard.server_is_ready(), "the actions")


def test_a_driver_that_does_not_answer_is_stopped_through_the_dashboard(running, nodes, simulator, client):
    ready_to_stop(running, client)
    assert client.send(MoveJ, "move_j", joint_positions=home_plus(3.0), speed=0.1).accepted
    until(lambda: is_moving(simulator), "the arm to move")
    nodes["command_server"].pause()
    before = simulator.state()["actual"]["position"][0]
    text = press(running)
    assert time_until_fallback(text) == pytest.approx(ACCEPTANCE_TIMEOUT, abs=DELAY_OF_THE_HOST)
    until(lambda: "The robot program was stopped." in text(), "the end of the robot program")
    until(lambda: not is_moving(simulator), "the arm to stop")
    assert simulator.state()["actual"]["position"][0] - before < 0.1 * 2.0  # 2 s at the speed of the motion
    nodes["command_server"].resume()


def test_a_driver_that_is_silent_after_it_has_accepted_the_stop_is_stopped_through_the_dashboard(running, nodes, simulator, client):
    ready_to_stop(running, client)
    assert client.send(MoveJ, "move_j", joint_positions=home_plus(3.0), speed=2.0, acceleration=15.0).accepted
    until(lambda: simulator.state()["actual"]["velocity"][0] > 1.9, "the speed from which the arm stops in 1 s")
    text = press(running)
    until(lambda: "The arm decelerates." in text(), "the acceptance of the stop")
    nodes["command_server"].pause()
    assert is_moving(simulator)
    assert time_until_fallback(text) == pytest.approx(SILENCE_TIMEOUT, abs=DELAY_OF_THE_HOST)
    until(lambda: "The robot program was stopped." in text(), "the end of the robot program")
    until(lambda: not is_moving(simulator), "the arm to stop")
    nodes["command_server"].resume()


def test_a_stop_that_takes_a_second_is_left_to_the_driver(running, nodes, simulator, client):
    ready_to_stop(running, client)
    assert client.send(MoveJ, "move_j", joint_positions=home_plus(-3.0), speed=2.0, acceleration=15.0).accepted
    until(lambda: simulator.state()["actual"]["velocity"][0] < -1.9, "the speed from which the arm stops in 1 s")
    text = press(running)
    until(lambda: any(end in text() for end in ("At rest after", *THROUGH_THE_DASHBOARD)), "the end of the motion")
    assert "At rest after" in text()


def test_an_answer_that_waits_for_a_late_viewer_is_no_silence_of_the_driver(running, nodes, simulator, client):
    ready_to_stop(running, client)
    text = press(running)
    running.viewer.control._robots[0]._stopper._control.post(lambda: time.sleep(2.0 * ACCEPTANCE_TIMEOUT))  # occupies the thread
    until(lambda: any(end in text() for end in ("At rest after", *THROUGH_THE_DASHBOARD)), "the end of the stop")
    assert "At rest after" in text()


def seconds_to_rest(text):
    return float(text().partition("At rest after ")[2].split()[0])


def test_the_time_of_a_held_button_counts_from_its_first_press(running, nodes, simulator, client, monkeypatch):
    monkeypatch.setattr(stop, "REPEAT_GAP", 30.0)  # however slow the host is
    ready_to_stop(running, client)
    assert client.send(MoveJ, "move_j", joint_positions=home_plus(3.0), speed=2.0, acceleration=15.0).accepted
    until(lambda: simulator.state()["actual"]["velocity"][0] > 1.9, "the speed from which the arm stops in 1 s")
    text = press(running)
    until(lambda: simulator.state()["actual"]["velocity"][0] < 1.0, "the middle of the deceleration")
    press(running)
    until(lambda: "At rest after" in text(), "the standstill")
    assert seconds_to_rest(text) > 0.8
    shown, ended = text(), nodes["command_server"].output().count("/stop: goal")
    press(running)
    until(lambda: nodes["command_server"].output().count("/stop: goal") > ended, "the end of the stop")
    assert text() == shown


def test_the_success_of_one_robot_does_not_hide_the_failure_of_another():
    control = object.__new__(Control)
    control._outcomes, control._stop_text = {}, SimpleNamespace(content="")
    control._show_outcome("left: ", Outcome.FAILED, "no answer")
    control._show_outcome("right: ", Outcome.STOPPED, "0.2 s")
    assert "left: STOP failed: no answer" in control._stop_text.content and "right: Stopped. 0.2 s" in control._stop_text.content
