"""`ur call`: goals, their feedback and their result."""

import contextlib
import json
import os
import pathlib
import re
import signal
import subprocess
import time

import pytest
import yaml
from programs import Process, find_program, start_node
from rclpy.action import ActionServer, CancelResponse
from rclpy.task import Future
from ros_client import Client
from support import FEW_PLUGINS, HOME, TIMEOUT_FACTOR, wait_for
from ur_program import DISCOVERY, EMPTY_DOMAIN, goal, output_on_terminal, slow_motion, ur, wait_until_moving
from ur_ros_rtde_cli.driver_watch import CANCEL_TIMEOUT

from ur_ros_rtde_msgs.action import ExecuteTrajectory, MoveJ


def test_sends_a_goal_and_prints_its_result(running):
    turned = [HOME[0] + 0.3, *HOME[1:]]
    code, output = ur("call", "move_j", "--quiet", goal(joint_positions=turned, speed=1))
    assert code == 0, output
    result = yaml.safe_load(output)
    assert result["success"] and result["final_state"]["joint_positions"] == pytest.approx(turned, abs=0.005)


def test_a_rejected_goal_exits_with_2_and_the_reason(running):
    code, output = ur("call", "move_j", goal(joint_positions=[0.0, 1.0]))
    assert code == 2 and "joint_positions has 2 values" in output, output


@pytest.mark.parametrize("text, mentions", [
    ("{jointpositions: [0]}", ["no field jointpositions; did you mean joint_positions?", "joint_positions, speed, acceleration"]),
    ("{speed: fast}", ["speed is 'fast'", "expected a number"]),
    ("{speed: [", ["not YAML: line "]),
    ("7", ["expected a mapping"]),
    ("{joint_positions: 1.0}", ["joint_positions is 1.0", "expected a list of numbers"]),
])
def test_an_invalid_field_is_reported_without_a_server(text, mentions):
    code, output = ur("call", "move_j", text, domain=EMPTY_DOMAIN)
    assert code == 2 and all(part in output for part in mentions), output


def test_checks_a_goal_of_a_shared_type(running):
    code, output = ur("call", "set_standard_digital_output", "{pim: 1}")
    assert code == 2 and "there is no field pim; did you mean pin?" in output, output


@pytest.mark.parametrize("number", ["nan", ".nan", "inf", "-.inf"])
def test_nan_and_infinity_are_sent_and_rejected_by_the_driver(running, number):
    code, output = ur("call", "move_j", f"{{joint_positions: {HOME}, speed: {number}}}")
    assert code == 2 and "rejected: speed is" in output, output


def test_suggests_similar_names(running):
    code, output = ur("call", "movej", "--wait", DISCOVERY)
    hint, error = output.splitlines()
    assert code == 2 and hint.startswith("no plugin is named movej; did you mean move_j "), output
    assert error.startswith("no server of /movej; did you mean move_j "), output


def test_a_name_without_a_similar_one_is_answered_at_once(running):
    code, output = ur("call", "qqq", "--wait", DISCOVERY)
    hint, error = output.splitlines()
    assert code == 2 and hint.startswith("no plugin is named qqq; `ur plugins` lists them. Waiting "), output
    assert re.fullmatch(r"no server of /qqq\. The driver serves \d+ actions; `ur plugins` lists the installed ones", error), output


def test_reads_a_goal_from_a_file(running, tmp_path):
    file = tmp_path / "goal.yaml"
    file.write_text(f"# both ways\njoint_positions: {HOME}\nspeed: 1e0\n")
    code, output = ur("call", "move_j", "--file", str(file))
    assert code == 0, output
    code, output = ur("call", "move_j", "--file", str(file), "{}")
    assert code == 2 and "not both" in output, output
    file.write_text(f"joint_positions: {HOME}\n\nspeed: fast\n")
    code, output = ur("call", "move_j", "--file", str(file))
    assert code == 2 and f"{file}:3: speed is 'fast': expected a number" in output, output


def feedback_lines(output):
    """Returns time, percentage and joints of each line."""
    found = (re.match(r" *(\d+\.\d) s  +(\d+) %  joints ((?: *-?\d+\.\d+){6}) rad", line) for line in output.splitlines())
    return [(float(match.group(1)), int(match.group(2)), [*map(float, match.group(3).split())]) for match in found if match]


def slow_trajectory():
    points = [HOME, [HOME[0] + 0.4, *HOME[1:]]]
    limits = {name: [value] * 6 for name, value in (("max_velocity", 0.1), ("max_acceleration", 1.0))}
    return goal(waypoints=[{"positions": point} for point in points], **limits)


def test_shows_feedback_once_per_second_without_a_terminal(at_home):
    code, output = ur("call", "execute_trajectory", slow_trajectory())
    assert code == 0, output
    lines = feedback_lines(output)
    times, progress, joints = zip(*lines)
    assert len(lines) >= 3 and all(after - before >= 0.9 for before, after in zip(times, times[1:])), output
    assert list(progress) == sorted(progress) and progress[0] < progress[-1]
    assert HOME[0] - 0.01 < joints[0][0] < joints[-1][0] < HOME[0] + 0.41 and joints[0][1:] == pytest.approx(HOME[1:], abs=0.01)


def test_json_has_all_feedback_and_the_result(at_home):
    code, output = ur("call", "execute_trajectory", "--json", slow_trajectory())
    *feedback, end = map(json.loads, output.splitlines())
    assert code == 0 and end["status"] == "succeeded" and end["result"]["success"] is True, output
    assert len(feedback) > 20 and all(set(line) == {"feedback"} for line in feedback)
    assert set(feedback[0]["feedback"]) == set(ExecuteTrajectory.Feedback().get_fields_and_field_types())


def test_json_of_a_rejected_goal_has_the_reason(running):
    command = [find_program("ur_ros_rtde_cli", "ur"), "call", "move_j", "--json", f"{{joint_positions: {HOME}, speed: .nan}}"]
    process = subprocess.run(command, capture_output=True, text=True)
    reason = json.loads(process.stdout)["rejected"]
    assert process.returncode == 2 and "speed is" in reason and reason in process.stderr


def test_shows_feedback_in_one_line_on_a_terminal(at_home):
    turned = [HOME[0] + 0.2, *HOME[1:]]
    code, text = output_on_terminal(["call", "move_j", goal(joint_positions=turned, speed=0.5)])
    assert code == 0
    feedback, _, result = text.rpartition("\r\x1b[K")
    lines = feedback.split("\r\x1b[K")
    assert len(lines) > 3 and "\n" not in feedback and all(len(line) < 100 for line in lines), text
    assert re.fullmatch(r"\[#+\.+\] +\d+\.\d s +\d+ %  joints .*", lines[-2]), lines[-2]
    assert result.startswith("success: true")


def test_accepts_nested_fields_and_arrays_of_messages(running):
    code, output = ur("call", "move_l", "{pose: {position: {z: 9}, orientation: {w: 1}}}")
    assert code == 2 and "reach" in output, output


def test_shows_the_fields_of_a_goal_without_a_server():
    code, output = ur("call", "move_j", "--show", "{acceleration: 2}", domain=EMPTY_DOMAIN)
    assert code == 0 and yaml.safe_load(output) == {"joint_positions": [], "speed": 0.5, "acceleration": 2.0}, output
    assert "# Speed of the leading joint. Unit: rad/s. Range: above 0, at most 3.14.\nspeed: 0.5\n" in output


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_cancels_the_goal_and_prints_the_final_state(at_home, number):
    process = Process(slow_motion())
    wait_until_moving(at_home)
    process.signal(number)
    assert process.wait(20.0) == 128 + number, process.output()
    assert at_home.state()["at_rest"]
    assert "error_code: 4" in process.output() and "Traceback" not in process.output()


def test_timeout_cancels_the_goal(at_home):
    process = Process(["timeout", "15", *slow_motion(speed=0.05)])
    wait_until_moving(at_home)
    assert process.wait(30.0) == 124, process.output()
    assert at_home.state()["at_rest"]
    assert "error_code: 4" in process.output(), process.output()


def test_a_closed_output_cancels_the_goal(at_home, tmp_path):
    errors = tmp_path / "errors"
    with errors.open("w") as file:
        process = subprocess.Popen(slow_motion(), stdout=subprocess.PIPE, stderr=file)
    wait_until_moving(at_home)
    process.stdout.close()
    assert process.wait(TIMEOUT_FACTOR * 20.0) == 128 + signal.SIGPIPE, errors.read_text()
    assert at_home.state()["at_rest"]
    assert errors.read_text().splitlines() == ["canceling (SIGPIPE), interrupt again to quit without the result"]


@pytest.mark.parametrize("closed", [(2,), (1,), (0, 1, 2)])
def test_a_goal_is_sent_although_the_standard_streams_are_closed(at_home, closed):
    process = subprocess.Popen(slow_motion())
    wait_until_moving(at_home)
    stop = [find_program("ur_ros_rtde_cli", "ur"), "call", "stop"]
    assert subprocess.run(stop, preexec_fn=lambda: [os.close(number) for number in closed]).returncode == 0
    assert at_home.state()["at_rest"]
    assert process.wait(TIMEOUT_FACTOR * 20.0) == 1


def test_the_result_can_be_piped_to_head(at_home):
    turned = goal(joint_positions=[HOME[0] + 0.1, *HOME[1:]], speed=1)
    process = Process(["bash", "-c", 'set -o pipefail; "$@" | head -1', "bash", *slow_motion()[:-1], turned])
    assert process.wait(30.0) == 0, process.output()
    assert process.lines == ["success: true"]
    assert at_home.state()["at_rest"]


def test_a_reader_of_json_that_ends_cancels_the_goal(at_home):
    command = [part for part in slow_motion() if part != "--quiet"]
    process = Process(["bash", "-c", 'set -o pipefail; "$@" --json | head -1', "bash", *command])
    process.wait_for_output("canceling (SIGPIPE)")
    assert process.wait(TIMEOUT_FACTOR * 20.0) == 128 + signal.SIGPIPE, process.output()
    assert at_home.state()["at_rest"]
    assert any(line.startswith('{"feedback"') for line in process.lines), process.output()


@pytest.fixture(scope="module")
def driver_without_robot():
    """A driver in the namespace left. It rejects all goals."""
    driver = start_node("driver", "127.255.255.254", FEW_PLUGINS, namespace="left")
    yield
    driver.stop()


@pytest.mark.parametrize("name", ["left/move_j", "/left/move_j"])
def test_the_name_may_contain_the_namespace_of_the_driver(driver_without_robot, name):
    code, output = ur("call", name, "--wait", DISCOVERY)
    assert code == 2 and output.startswith("rejected: ") and "no reason was received" not in output, output


@pytest.mark.parametrize("name", ["left/move_j", "/left/move_j"])
def test_the_fields_of_a_name_with_a_namespace_are_checked_without_a_server(name):
    code, output = ur("call", name, "{speed: fast}", domain=EMPTY_DOMAIN)
    assert code == 2 and "speed is 'fast'" in output, output


@pytest.mark.parametrize("name, status, text", [
    ("/my-robot/move_j", 2, '"my-robot" is no namespace'),
    ("left/move_j", 1, f"no server of /left/move_j. No driver answers: start it, or check ROS_DOMAIN_ID ({EMPTY_DOMAIN})"),
])
def test_a_wrong_namespace_in_the_name_is_reported(name, status, text):
    code, output = ur("call", name, "--wait", "0.5", domain=EMPTY_DOMAIN)
    assert code == status and text in output, output


@pytest.mark.parametrize("domain", ["abc", "500", "-1"])
def test_an_impossible_domain_is_reported(domain):
    code, output = ur("state", domain=domain)
    assert code == 2 and output == f'ROS_DOMAIN_ID is "{domain}": it must be a number from 0 to 232', output


class UnresponsiveServer:
    """A move_j server that neither cancels nor finishes goals."""

    def __init__(self):
        self.goals = []
        self._client = Client("unresponsive", name="unresponsive_server")
        self._server = self._client.call_in_executor(lambda: ActionServer(
            self._client.node, MoveJ, "move_j", self._execute, cancel_callback=self._accept_cancel))

    async def _execute(self, handle):
        self.goals.append(handle)
        await Future()

    def _accept_cancel(self, _):
        return CancelResponse.REJECT

    def call(self):
        """Returns a running `ur call` whose goal this server has."""
        process = Process([*slow_motion()[:2], "--namespace", "unresponsive", *slow_motion()[2:]])
        wait_for(lambda: self.goals, 20.0, "the goal")
        return process

    def close(self):
        self._server.destroy()
        self._client.close()


@pytest.fixture
def unresponsive_server():
    server = UnresponsiveServer()
    yield server
    server.close()


@pytest.mark.parametrize("restarted", [False, True])
def test_the_end_of_the_driver_ends_the_call(restarted):
    server = UnresponsiveServer()
    process = server.call()
    server.close()
    with contextlib.closing(UnresponsiveServer()) if restarted else contextlib.nullcontext():
        assert process.wait(20.0) == 1, process.output()
    assert process.output().startswith("the driver has ended or is out of reach while /unresponsive/move_j was running"), process.output()


def test_a_second_signal_exits_without_the_result(unresponsive_server):
    process = unresponsive_server.call()
    process.signal(signal.SIGTERM)
    begin = time.monotonic()
    process.wait_for_output("canceling (SIGTERM)")
    time.sleep(1.1)  # an earlier signal counts as the first one
    process.signal(signal.SIGTERM)
    assert process.wait(10.0) == 128 + signal.SIGTERM, process.output()
    assert time.monotonic() - begin < TIMEOUT_FACTOR * 8.0, "the program waited for the result"


class BrakingServer(UnresponsiveServer):
    """A move_j server whose canceled goals end with brake()."""

    async def _execute(self, handle):
        self.goals.append(handle)
        self._standstill = Future()
        await self._standstill
        handle.canceled()
        return MoveJ.Result(message="canceled at standstill")

    def _accept_cancel(self, _):
        return CancelResponse.ACCEPT

    def brake(self, duration):
        time.sleep(duration)
        self._client.call_in_executor(lambda: self._standstill.set_result(True) or True)


def test_a_canceled_goal_may_brake_for_longer_than_ten_seconds():
    with contextlib.closing(BrakingServer()) as server:
        process = server.call()
        process.interrupt()
        process.wait_for_output("canceling (SIGINT)")
        server.brake(11.0)
        assert process.wait(10.0) == 128 + signal.SIGINT, process.output()
        assert "canceled at standstill" in process.output()


def test_the_wait_for_a_canceled_goal_is_longer_than_the_driver_brakes():
    source = pathlib.Path(__file__).resolve().parents[2] / "ur_ros_rtde" / "src" / "goals" / "command_goal.cpp"
    braking = re.search(r"std::chrono::seconds braking_timeout\{(\d+)\};", source.read_text())
    assert CANCEL_TIMEOUT >= int(braking[1]) + 5.0
