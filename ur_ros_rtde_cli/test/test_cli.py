"""`ur` as its user types it."""

import csv
import os
import signal
import subprocess
import time

import pytest
import yaml
from rclpy.action import ActionServer
from rclpy.task import Future
from support import HOME, PATIENCE, Client, Process, Simulator, node, program, wait_for

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


def slow_motion():
    away = [HOME[0] - 2.0, *HOME[1:]]
    return [program("ur_ros_rtde_cli", "ur"), "call", "move_j", goal(joint_positions=away, speed=0.2)]


@pytest.fixture
def at_home(running):
    code, output = ur("call", "move_j", goal(joint_positions=HOME, speed=2.0, acceleration=5.0))
    assert code == 0, output
    return running


def wait_until_moving(simulator):
    wait_for(lambda: not simulator.state()["at_rest"], 20.0, "the arm to move")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_cancels_the_goal_and_shows_where_the_arm_stands(at_home, number):
    process = Process(slow_motion())
    wait_until_moving(at_home)
    process.signal(number)
    assert process.wait(20.0) == 128 + number, process.output()
    assert at_home.state()["at_rest"]
    assert "error_code: 4" in process.output() and "Traceback" not in process.output()


def test_timeout_cancels_the_goal(at_home):
    process = Process(["timeout", "6", *slow_motion()])
    wait_until_moving(at_home)
    assert process.wait(30.0) == 124, process.output()
    assert at_home.state()["at_rest"]
    assert "error_code: 4" in process.output(), process.output()


def test_the_arm_stops_when_nobody_reads_the_output_any_more(at_home, tmp_path):
    errors = tmp_path / "errors"
    with errors.open("w") as file:
        process = subprocess.Popen(slow_motion(), stdout=subprocess.PIPE, stderr=file)
    wait_until_moving(at_home)
    process.stdout.close()
    assert process.wait(PATIENCE * 20.0) == 128 + signal.SIGPIPE, errors.read_text()
    assert at_home.state()["at_rest"]
    assert errors.read_text().splitlines() == ["canceling (SIGPIPE), again to go without the result"]


def test_the_result_can_be_piped_into_head(at_home):
    turned = goal(joint_positions=[HOME[0] + 0.1, *HOME[1:]], speed=1)
    process = Process(["bash", "-c", 'set -o pipefail; "$@" | head -1', "bash", *slow_motion()[:-1], turned])
    assert process.wait(30.0) == 0, process.output()
    assert process.lines == ["success: true"]
    assert at_home.state()["at_rest"]


@pytest.fixture
def stubborn():
    """The goals of a server of move_j that neither cancels nor ends them, in the namespace of that name."""
    client = Client("stubborn", name="stubborn_server")
    goals = []
    end = Future()

    async def execute(handle):
        goals.append(handle)
        await end
        handle.abort()
        return MoveJ.Result()

    server = client.in_executor(lambda: ActionServer(client.node, MoveJ, "move_j", execute))
    yield goals
    client.in_executor(lambda: end.set_result(True) or True)
    server.destroy()
    client.close()


def test_a_second_signal_ends_the_wait_for_the_result(stubborn):
    process = Process([*slow_motion()[:2], "--namespace", "stubborn", *slow_motion()[2:]])
    wait_for(lambda: stubborn, 20.0, "the goal")
    process.signal(signal.SIGTERM)
    begin = time.monotonic()
    process.wait_for_output("canceling (SIGTERM)")
    time.sleep(1.1)  # what comes earlier belongs to the first one
    process.signal(signal.SIGTERM)
    assert process.wait(10.0) == 128 + signal.SIGTERM, process.output()
    assert time.monotonic() - begin < 8.0, "it has waited for its limit of 10 s"


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
