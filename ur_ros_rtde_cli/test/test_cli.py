"""`ur` as its user types it."""

import csv
import os
import time

import pytest
import yaml
from support import HOME, Client, Process, Simulator, node, program, wait_for

from ur_ros_rtde_msgs.action import MoveJ


@pytest.fixture(scope="module")
def running():
    simulator = Simulator(os.environ.get("UR_TEST_ADDRESS", "127.0.1.200"))
    driver = node("driver", simulator.address, "ur_type:=ur10e")
    client = Client()
    try:
        wait_for(lambda: client.send(MoveJ, "move_j", joint_positions=HOME).accepted, 30.0, "the driver to take a motion")
        yield simulator
    finally:
        client.close()
        driver.end()
        simulator.end()


def ur(*arguments, limit=60.0):
    """Return code and output."""
    process = Process([program("ur_ros_rtde_cli", "ur"), *arguments])
    return process.wait(limit), process.output()


def goal(**fields):
    return yaml.safe_dump(fields, default_flow_style=True, width=1000).strip()


def test_a_goal_is_sent_and_its_result_printed(running):
    turned = [HOME[0] + 0.3, *HOME[1:]]
    code, output = ur("call", "move_j", goal(joint_positions=turned, speed=1))
    assert code == 0, output
    result = yaml.safe_load(output)
    assert result["success"] and result["final_state"]["joint_positions"] == pytest.approx(turned, abs=0.005)


def test_a_refused_goal_ends_with_2_and_the_reason(running):
    code, output = ur("call", "move_j", goal(joint_positions=[0.0, 1.0]))
    assert code == 2 and "joint_positions has 2 values" in output, output


@pytest.mark.parametrize("text, mentions", [
    ("{jointpositions: [0]}", ["jointpositions", "joint_positions, speed, acceleration"]),
    ("{speed: fast}", ["speed is 'fast'", "double"]),
    ("{speed: [", ["not YAML"]),
    ("7", ["mapping"]),
    ("{joint_positions: 1.0}", ["joint_positions is 1.0", "a list"]),
])
def test_a_goal_that_cannot_be_meant_names_its_field(running, text, mentions):
    code, output = ur("call", "move_j", text)
    assert code == 2 and all(part in output for part in mentions), output


def test_an_action_nobody_serves_is_named_with_those_there_are(running):
    code, output = ur("call", "move_x", "--wait", "10")
    assert code == 2 and "/move_x" in output and "/move_l" in output, output


def test_nested_fields_and_arrays_of_messages_can_be_given(running):
    code, output = ur("call", "move_l", "{pose: {position: {z: 9}, orientation: {w: 1}}}")
    assert code == 2 and "reach" in output, output


def test_the_fields_of_a_goal_are_shown_without_sending_it(running):
    code, output = ur("call", "move_j", "--show")
    assert code == 0 and yaml.safe_load(output)["speed"] == 0.5, output


def test_ctrl_c_cancels_the_goal_and_shows_where_the_arm_stands(running):
    away = [HOME[0] - 2.0, *HOME[1:]]
    process = Process([program("ur_ros_rtde_cli", "ur"), "call", "move_j", goal(joint_positions=away, speed=0.3)])
    wait_for(lambda: not running.state()["at_rest"], 20.0, "the arm to move")
    process.interrupt()
    assert process.wait(20.0) == 1, process.output()
    assert "error_code: 4" in process.output()
    assert running.state()["at_rest"]


def test_the_state_is_shown(running):
    code, output = ur("state")
    assert code == 0 and "elbow_joint" in output and "tcp position" in output, output


def test_no_driver_is_said_after_the_wait():
    process = Process([program("ur_ros_rtde_cli", "ur"), "state", "--wait", "0.5", "--namespace", "nobody"])
    assert process.wait(20.0) == 2 and "Does robot_state_receiver run" in process.output()


def test_plugins_are_listed_with_package_and_description():
    code, output = ur("plugins", "move_l")
    assert code == 0 and ["move_l", "ur_ros_rtde", "Moves"] in [line.split()[:3] for line in output.splitlines()], output


def test_a_recording_has_the_rows_it_says(running, tmp_path):
    file = tmp_path / "run.csv"
    code, output = ur("record", str(file), "timestamp", "actual_q", "--time", "1")
    assert code == 0, output
    rows = list(csv.reader(file.open()))
    assert f"{len(rows) - 1} rows" in output and len(rows) > 100 and len(rows[0]) == 7
    code, output = ur("record", str(file), "--time", "1")
    assert code == 2 and str(file) in output, output


@pytest.mark.parametrize("command", ["call", "state", "plugins", "record"])
def test_every_command_explains_itself(command):
    begin = time.monotonic()
    code, output = ur(command, "--help")
    assert code == 0 and "usage: ur" in output and time.monotonic() - begin < 30.0
