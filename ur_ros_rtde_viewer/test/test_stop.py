"""STOP when the driver does not answer: the robot program is stopped through dashboard_server."""

import pytest
from arm_state import AT_REST, home_plus
from robot_fixtures import addresses, client, make_ready, simulator  # noqa: F401
from running_viewer import RunningViewer, until
from support import HOME, start_node

from ur_ros_rtde_msgs.action import MoveJ

MEASURES_TIME = True


@pytest.fixture
def running():
    viewer = RunningViewer("--control")
    yield viewer
    viewer.close()


@pytest.fixture(scope="module")
def nodes(simulator):  # noqa: F811
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


def is_moving(simulator):  # noqa: F811
    return max(map(abs, simulator.state()["actual"]["velocity"])) > AT_REST


def test_without_a_driver_stop_names_the_remedy(running):
    text = press(running)
    until(lambda: "STOP failed" in text(), "the failure")
    assert "neither command_server nor dashboard_server answers. Use the emergency stop button" in text()


def ready_to_stop(running, client):
    make_ready(client)
    stopper = running.viewer.control._robots[0]._stopper
    until(lambda: stopper._stop.server_is_ready() and stopper._dashboard.server_is_ready(), "the actions")


def test_a_driver_that_does_not_answer_is_stopped_through_the_dashboard(running, nodes, simulator, client):  # noqa: F811
    ready_to_stop(running, client)
    assert client.send(MoveJ, "move_j", joint_positions=home_plus(3.0), speed=0.1).accepted
    until(lambda: is_moving(simulator), "the arm to move")
    nodes["command_server"].pause()
    text = press(running)
    until(lambda: "The robot program was stopped." in text(), "the end of the robot program")
    until(lambda: not is_moving(simulator), "the arm to stop")
    assert simulator.state()["actual"]["position"][0] < HOME[0] + 2.5
    nodes["command_server"].resume()


def test_a_driver_that_is_silent_after_it_has_accepted_the_stop_is_stopped_through_the_dashboard(running, nodes, simulator, client):  # noqa: F811
    ready_to_stop(running, client)
    assert client.send(MoveJ, "move_j", joint_positions=home_plus(3.0), speed=2.0, acceleration=15.0).accepted
    until(lambda: simulator.state()["actual"]["velocity"][0] > 1.9, "the speed from which the arm stops in 1 s")
    text = press(running)
    until(lambda: "The arm decelerates." in text(), "the acceptance of the stop")
    nodes["command_server"].pause()
    assert is_moving(simulator)
    until(lambda: "The robot program was stopped." in text(), "the end of the robot program")
    until(lambda: not is_moving(simulator), "the arm to stop")
    nodes["command_server"].resume()
