"""Tests of the program `ur` on the simulator."""

import contextlib
import csv
import fcntl
import json
import os
import pty
import re
import signal
import struct
import subprocess
import sys
import termios
import time

import pytest
import yaml
from rclpy.action import ActionServer
from rclpy.task import Future
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool
from support import HOME, TIMEOUT_FACTOR, Client, Process, Simulator, find_program, start_node, wait_for
from ur_ros_rtde_cli import print_state, view
from ur_ros_rtde_cli.errors import CliError
from ur_ros_rtde_cli.main import CHECKOUT_COMMANDS, CHECKOUT_VARIABLE, COMMANDS

from ur_ros_rtde_msgs.action import ExecuteTrajectory, MoveJ

DISCOVERY = str(4.0 * TIMEOUT_FACTOR)  # s, time limit for the discovery of all actions
EMPTY_DOMAIN = "102"  # an unused domain: tests use domains below 102


@pytest.fixture(scope="module")
def running():
    simulator = Simulator(os.environ.get("UR_TEST_ADDRESS", "127.0.1.200"))
    driver = start_node("driver", simulator.address, "ur_type:=ur10e")
    client = Client()
    try:
        wait_for(lambda: client.send(MoveJ, "move_j", joint_positions=HOME).accepted, 30.0, "the driver to accept a motion")
        yield simulator
    finally:
        client.close()
        driver.stop()
        simulator.stop()


def ur(*arguments, limit=60.0, domain=None):
    """Returns the exit code and the output."""
    process = Process([find_program("ur_ros_rtde_cli", "ur"), *arguments], {} if domain is None else {"ROS_DOMAIN_ID": domain})
    return process.wait(limit), process.output()


def goal(**fields):
    return yaml.safe_dump(fields, default_flow_style=True, width=1000).strip()


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


def test_names_the_namespaces_that_have_the_action(running):
    code, output = ur("call", "move_j", "{joint_positions: [0, 0, 0, 0, 0, 0]}", "--namespace", "nope", "--wait", DISCOVERY)
    assert code == 2 and "no server of /nope/move_j, but of this action in /: give --namespace" in output, output


def test_shows_the_version():
    code, output = ur("--version")
    assert code == 0 and re.match(r"ur_ros_rtde \d+\.\d+\.\d+", output), output


def test_lists_the_available_actions_if_no_name_is_similar(running):
    code, output = ur("call", "qqq", "--wait", DISCOVERY)
    assert code == 2 and "/move_l" in output and "/dashboard/power_on" in output, output


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


def output_on_terminal(arguments, lines=40, until=None):
    """Returns exit code and output of `ur` on a terminal of 100 columns. SIGINT ends it when it has printed `until`."""
    terminal, end = pty.openpty()
    fcntl.ioctl(end, termios.TIOCSWINSZ, struct.pack("HHHH", lines, 100, 0, 0))
    # Not the environment of the process: pytest imports readline, which sets LINES and COLUMNS there.
    process = subprocess.Popen([find_program("ur_ros_rtde_cli", "ur"), *arguments], stdout=end, stderr=end, env=dict(os.environ))
    os.close(end)
    shown = b""
    with contextlib.suppress(OSError):  # EIO: the other side of the terminal is closed
        while True:
            shown += os.read(terminal, 65536)
            if until is not None and until in shown:
                process.send_signal(signal.SIGINT)
                until = None
    os.close(terminal)
    return process.wait(TIMEOUT_FACTOR * 20.0), shown.decode()


def test_shows_feedback_in_one_line_on_a_terminal(at_home):
    turned = [HOME[0] + 0.2, *HOME[1:]]
    code, text = output_on_terminal(["call", "move_j", goal(joint_positions=turned, speed=0.5)])
    assert code == 0
    feedback, _, result = text.rpartition("\r\x1b[K")
    lines = feedback.split("\r\x1b[K")
    assert len(lines) > 3 and "\n" not in feedback and all(len(line) < 100 for line in lines), text
    assert re.fullmatch(r"\[#+\.+\] +\d+\.\d s +\d+ %  joints .*", lines[-2]), lines[-2]
    assert result.startswith("success: true")


def test_watches_the_state_on_the_whole_screen(running):
    code, text = output_on_terminal(["state", "--watch"], lines=12, until=b"\x1b[Hrobot_mode")
    assert code == 0
    assert text.startswith("\x1b[?1049h") and text.rstrip().endswith("\x1b[?1049l"), "the screen is not restored"
    assert "elbow_joint" in text and "Ctrl-C" in text
    frames = text.split("\x1b[H")[1:]
    assert all(frame.count("\n") < 12 for frame in frames), frames[0]


def test_accepts_nested_fields_and_arrays_of_messages(running):
    code, output = ur("call", "move_l", "{pose: {position: {z: 9}, orientation: {w: 1}}}")
    assert code == 2 and "reach" in output, output


def test_shows_the_fields_of_a_goal_without_a_server():
    code, output = ur("call", "move_j", "--show", "{acceleration: 2}", domain=EMPTY_DOMAIN)
    assert code == 0 and yaml.safe_load(output) == {"joint_positions": [], "speed": 0.5, "acceleration": 2.0}, output


def slow_motion():
    away = [HOME[0] - 2.0, *HOME[1:]]
    return [find_program("ur_ros_rtde_cli", "ur"), "call", "move_j", "--quiet", goal(joint_positions=away, speed=0.2)]


@pytest.fixture
def at_home(running):
    code, output = ur("call", "move_j", goal(joint_positions=HOME, speed=3.0, acceleration=15.0))
    assert code == 0, output
    return running


def wait_until_moving(simulator):
    wait_for(lambda: not simulator.state()["at_rest"], 20.0, "the arm to move")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_cancels_the_goal_and_prints_the_final_state(at_home, number):
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


def test_a_closed_output_cancels_the_goal(at_home, tmp_path):
    errors = tmp_path / "errors"
    with errors.open("w") as file:
        process = subprocess.Popen(slow_motion(), stdout=subprocess.PIPE, stderr=file)
    wait_until_moving(at_home)
    process.stdout.close()
    assert process.wait(TIMEOUT_FACTOR * 20.0) == 128 + signal.SIGPIPE, errors.read_text()
    assert at_home.state()["at_rest"]
    assert errors.read_text().splitlines() == ["canceling (SIGPIPE), interrupt again to quit without the result"]


def test_the_result_can_be_piped_to_head(at_home):
    turned = goal(joint_positions=[HOME[0] + 0.1, *HOME[1:]], speed=1)
    process = Process(["bash", "-c", 'set -o pipefail; "$@" | head -1', "bash", *slow_motion()[:-1], turned])
    assert process.wait(30.0) == 0, process.output()
    assert process.lines == ["success: true"]
    assert at_home.state()["at_rest"]


@pytest.fixture
def unresponsive_server():
    """A move_j server that neither cancels nor finishes goals. Returns the goals that it has received."""
    client = Client("unresponsive", name="unresponsive_server")
    goals = []
    end = Future()

    async def execute(handle):
        goals.append(handle)
        await end
        handle.abort()
        return MoveJ.Result()

    server = client.call_in_executor(lambda: ActionServer(client.node, MoveJ, "move_j", execute))
    yield goals
    client.call_in_executor(lambda: end.set_result(True) or True)
    server.destroy()
    client.close()


def test_a_second_signal_exits_without_the_result(unresponsive_server):
    process = Process([*slow_motion()[:2], "--namespace", "unresponsive", *slow_motion()[2:]])
    wait_for(lambda: unresponsive_server, 20.0, "the goal")
    process.signal(signal.SIGTERM)
    begin = time.monotonic()
    process.wait_for_output("canceling (SIGTERM)")
    time.sleep(1.1)  # an earlier signal counts as the first one
    process.signal(signal.SIGTERM)
    assert process.wait(10.0) == 128 + signal.SIGTERM, process.output()
    assert time.monotonic() - begin < 8.0, "the program waited for its limit of 10 s"


def test_shows_the_state(running):
    code, output = ur("state")
    assert code == 0 and "elbow_joint" in output and "tcp position" in output, output


def test_the_state_names_fake_joint_positions():
    joints = JointState(name=["left_shoulder_lift_joint", "left_elbow_joint"], position=[1.0, 2.0], velocity=[0.0, 0.0])
    warning, *rows = print_state.state_lines({"joint_states": joints, "joint_states_are_fake": Bool(data=True)})
    assert warning == "joint_states has fake positions (digital twin); the robot's are on actual_joint_states:"
    assert len(rows) == 2 and len({row.index(" rad ") for row in rows}) == 1, rows
    assert len(list(print_state.state_lines({"joint_states": joints, "joint_states_are_fake": Bool()}))) == 2


def test_a_missing_driver_is_reported_after_the_wait():
    process = Process([find_program("ur_ros_rtde_cli", "ur"), "state", "--wait", "0.5", "--namespace", "nobody"])
    assert process.wait(20.0) == 2 and "Does robot_state_receiver run" in process.output()


def test_lists_plugins_with_package_and_description():
    code, output = ur("plugins", "move_l")
    assert code == 0 and ["move_l", "ur_ros_rtde_commands", "Moves"] in [line.split()[:3] for line in output.splitlines()], output


@pytest.fixture
def own_plugin(tmp_path, monkeypatch):
    """A package with the plugin `wag` in a separate prefix. Returns its share folder."""
    share = tmp_path / "share" / "my_commands"
    index = tmp_path / "share" / "ament_index" / "resource_index"
    for resource, content in (("packages", ""), ("ur_ros_rtde__pluginlib__plugin", "share/my_commands/plugins.xml\n"),
                              ("rosidl_interfaces", "action/Wag.action\naction/Wag.idl\n")):
        (index / resource).mkdir(parents=True)
        (index / resource / "my_commands").write_text(content)
    (share / "action").mkdir(parents=True)
    (share / "package.xml").write_text("<package><description>What it is about.</description></package>")
    (share / "plugins.xml").write_text('<library path="x"><class name="wag" type="x::Wag"/></library>')
    (share / "action" / "Wag.action").write_text("# Turns wrist 3\n# and back. Then more.\n\nfloat64 angle   # rad\n---\n---\n")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path), prepend=os.pathsep)
    return share


def listed_description():
    code, output = ur("plugins", "wag")
    assert code == 0, output
    return " ".join(output.split()[2:])


def test_a_missing_description_is_taken_from_the_action_file_or_the_package(own_plugin):
    assert listed_description() == "Turns wrist 3 and back"
    (own_plugin / "action" / "Wag.action").write_text("float64 angle\n---\n---\n")
    assert listed_description() == "What it is about"


def test_a_description_in_plugins_xml_has_priority(own_plugin):
    (own_plugin / "plugins.xml").write_text(
        '<library path="x"><class name="wag" type="x::Wag"><description>Wags</description></class></library>')
    assert listed_description() == "Wags"


def test_the_fields_of_an_action_with_another_name_are_known_without_a_driver(own_plugin):
    (own_plugin / "plugins.xml").write_text(
        '<library path="x"><class name="wag" type="x::Wag" action="ur_ros_rtde_msgs/action/DashboardText"/></library>')
    assert ur("call", "wag", "--show", domain=EMPTY_DOMAIN) == (0, "{text: ''}")


def test_record_reports_the_number_of_rows(running, tmp_path):
    file = tmp_path / "run.csv"
    code, output = ur("record", str(file), "timestamp", "actual_q", "--time", "1")
    assert code == 0, output
    rows = list(csv.reader(file.open()))
    assert f"{len(rows) - 1} rows" in output and len(rows) > 100 and len(rows[0]) == 7
    code, output = ur("record", str(file), "--time", "1")
    assert code == 2 and str(file) in output, output


def test_starts_the_viewer(monkeypatch):
    code, output = ur("view", "--help", domain=EMPTY_DOMAIN)
    assert code == 0 and "usage: ur view" in output and "--robot" in output, output
    monkeypatch.setattr(view, "find_viewer", lambda: None)
    with pytest.raises(CliError, match="ur_ros_rtde_viewer is not installed"):
        view.execute([])


def test_prints_a_urdf_without_nodes():
    code, output = ur("urdf", "--model", "ur5e", "--tf-prefix", "left_", domain=EMPTY_DOMAIN)
    assert code == 0 and output.startswith("<?xml") and 'name="left_tool0"' in output, output
    code, output = ur("urdf", "--model", "ur5f", domain=EMPTY_DOMAIN)
    assert code == 2 and output.startswith('model is "ur5f"'), output


@pytest.mark.parametrize("command", COMMANDS)
def test_help_of_every_command_works_without_ros(command):
    code = f"""
import sys
for missing in ("rclpy", "ament_index_python", "numpy", "yaml", "ur_ros_rtde_msgs"):
    sys.modules[missing] = None
from ur_ros_rtde_cli.main import main
main(["{command}", "--help"])
"""
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert result.returncode == 0 and f"usage: ur {command}" in result.stdout, result.stderr


def test_the_help_lists_all_commands_and_those_of_the_checkout(monkeypatch):
    monkeypatch.delenv(CHECKOUT_VARIABLE, raising=False)
    for arguments, expected in (((), 2), (("--help",), 0)):
        code, output = ur(*arguments)
        assert code == expected and all(re.search(rf"^    {command}(?: |$)", output, re.M) for command in COMMANDS), output
        assert ", ".join(CHECKOUT_COMMANDS)[:40] in output and "./ur" in output


@pytest.mark.parametrize("command, mentions", [("build", "run `./ur build` in a checkout"), ("cal", "did you mean call?"),
                                               ("qqq", "The commands are: call, state, plugins, record")])
def test_a_command_that_is_not_installed_is_explained(monkeypatch, command, mentions):
    monkeypatch.delenv(CHECKOUT_VARIABLE, raising=False)
    code, output = ur(command)
    assert code == 2 and mentions in output, output


def test_commands_of_the_checkout_are_passed_to_its_script(monkeypatch, tmp_path):
    script = tmp_path / "ur"
    script.write_text('#!/bin/sh\necho "checkout: $@"\nexit 7\n')
    script.chmod(0o755)
    monkeypatch.setenv(CHECKOUT_VARIABLE, str(tmp_path))
    for arguments in (("build", "--package", "x"), ("--help",), ("qqq",), ()):
        code, output = ur(*arguments)
        assert (code, output.split()) == (7, ["checkout:", *arguments]), output
    code, output = ur("plugins", "move_l")
    assert code == 0 and "checkout" not in output, output
