"""The examples do what they say."""

import os

import pytest
from support import HOME, Client, Process, Simulator, node, program, wait_for

from ur_ros_rtde_msgs.action import MoveJ


@pytest.fixture(scope="module")
def running():
    simulator = Simulator(os.environ.get("UR_TEST_ADDRESS", "127.0.1.200"))
    driver = node("driver", simulator.address)
    client = Client()
    try:
        wait_for(lambda: client.send(MoveJ, "move_j", joint_positions=HOME).accepted, 30.0, "the driver to take a motion")
        yield simulator
    finally:
        client.close()
        driver.end()
        simulator.end()


@pytest.mark.parametrize("name, limit, text", [
    ("t01_send_a_goal.py", 60.0, "done, error_code 0"),
    ("t02_read_the_state.py", 60.0, "force along the tool"),
    ("t03_cancel_a_goal.py", 60.0, "canceled: "),
])
def test_the_example_does_what_it_says(running, name, limit, text):
    example = Process([program("ur_ros_rtde_tutorials", name)])
    assert example.wait(limit) == 0, example.output()
    assert text in example.output()
