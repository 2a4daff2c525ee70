"""Runs the examples."""

import os
import signal
import subprocess

import pytest
from support import HOME, TIMEOUT_FACTOR, Client, Process, Simulator, find_program, start_node, wait_for

from ur_ros_rtde_msgs.action import MoveJ


@pytest.fixture(scope="module")
def running():
    simulator = Simulator(os.environ.get("UR_TEST_ADDRESS", "127.0.1.200"))
    driver = start_node("driver", simulator.address)
    client = Client()
    try:
        wait_for(lambda: client.send(MoveJ, "move_j", joint_positions=HOME).accepted, 30.0, "the driver to accept a motion")
        yield simulator
    finally:
        client.close()
        driver.stop()
        simulator.stop()


@pytest.mark.parametrize("name, limit, text", [
    ("t01_send_a_goal.py", 60.0, "done, error_code 0"),
    ("t02_read_the_state.py", 60.0, "force along the tool"),
    ("t03_cancel_a_goal.py", 60.0, "canceled: "),
])
def test_the_example_succeeds(running, name, limit, text):
    example = Process([find_program("ur_ros_rtde_tutorials", name)])
    assert example.wait(limit) == 0, example.output()
    assert text in example.output()


@pytest.mark.parametrize("name", ["t01_send_a_goal.py", "t03_cancel_a_goal.py"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_cancels_the_goal_of_the_example(running, name, number):
    example = Process([find_program("ur_ros_rtde_tutorials", name)])
    wait_for(lambda: not running.is_at_rest(), 20.0, "the arm to move")
    example.signal(number)
    assert example.wait(20.0) == 128 + number, example.output()
    assert running.is_at_rest()
    assert "Traceback" not in example.output()


def test_a_closed_output_cancels_the_goal_of_the_example(running, tmp_path):
    errors = tmp_path / "errors"
    with errors.open("w") as file:
        example = subprocess.Popen([find_program("ur_ros_rtde_tutorials", "t01_send_a_goal.py")], stdout=subprocess.PIPE, stderr=file)
    wait_for(lambda: not running.is_at_rest(), 20.0, "the arm to move")
    example.stdout.close()
    assert example.wait(TIMEOUT_FACTOR * 20.0) == 128 + signal.SIGPIPE, errors.read_text()
    assert running.is_at_rest()
    assert errors.read_text() == ""
