"""The program `ur` without its goals: state, plugins, recordings, help."""

import csv
import errno
import json
import os
import re
import signal
import subprocess
import sys
import threading
from types import SimpleNamespace

import pytest
from action_msgs.msg import GoalStatus
from programs import Process, find_program
from rclpy.qos import DurabilityPolicy, QoSProfile
from ros_client import Client
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool
from support import TIMEOUT_FACTOR, wait_for
from ur_program import DISCOVERY, EMPTY_DOMAIN, output_on_terminal, ur
from ur_ros_rtde_cli import print_state, record, view
from ur_ros_rtde_cli.errors import CliError
from ur_ros_rtde_cli.goal_output import JsonOutput
from ur_ros_rtde_cli.interruptions import Interrupted
from ur_ros_rtde_cli.main import CHECKOUT_COMMANDS, CHECKOUT_VARIABLE, COMMANDS, main
from ur_ros_rtde_cli.namespaces import other_drivers

from ur_ros_rtde_msgs.msg import ActiveModes, DriverState
from ur_ros_rtde_msgs.srv import StartRecording, StopRecording


def test_shows_the_version():
    code, output = ur("--version")
    assert code == 0 and re.match(r"ur_ros_rtde \d+\.\d+\.\d+", output), output


def test_watches_the_state_on_the_whole_screen(running):
    code, text = output_on_terminal(["state", "--watch"], lines=12, until=b"\x1b[Hrobot_mode")
    assert code == 0
    assert text.startswith("\x1b[?1049h") and text.rstrip().endswith("\x1b[?1049l"), "the screen is not restored"
    assert "elbow_joint" in text and "Ctrl-C" in text
    frames = text.split("\x1b[H")[1:]
    assert all(frame.count("\n") < 12 for frame in frames), frames[0]


def test_shows_the_state(running):
    code, output = ur("state")
    assert code == 0 and "elbow_joint" in output and "tcp position" in output, output


def test_the_state_as_json(running):
    code, output = ur("state", "--json")
    state = json.loads(output)
    assert code == 0 and state["driver_state"]["name"] == "READY" and len(state["joint_states"]["position"]) == 6, output


def test_the_state_names_fake_joint_positions():
    joints = JointState(name=["left_shoulder_lift_joint", "left_elbow_joint"], position=[1.0, 2.0], velocity=[0.0, 0.0])
    warning, *rows = print_state.state_lines(print_state.Latest(joint_states=joints, joint_states_are_fake=Bool(data=True)))
    assert warning == "joint_states has fake positions (digital twin); the robot's are on actual_joint_states:"
    assert len(rows) == 2 and len({row.index(" rad ") for row in rows}) == 1, rows
    assert len(list(print_state.state_lines(print_state.Latest(joint_states=joints, joint_states_are_fake=Bool())))) == 2


def test_the_state_without_a_robot_is_that_of_the_driver():
    client = Client("without_robot")
    state = DriverState(state=DriverState.DISCONNECTED, name="DISCONNECTED", message="no connection to 127.0.0.9: check the address")
    publisher = client.node.create_publisher(DriverState, "driver_state", QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
    publisher.publish(state)
    try:
        code, output = ur("state", "--namespace", "without_robot")
        assert code == 1 and output == f"driver_state   DISCONNECTED  {state.message}", output
    finally:
        client.close()


def test_the_state_says_that_it_is_old_and_names_active_modes(monkeypatch):
    latest, clock = print_state.Latest(active_modes=ActiveModes(names=["force_mode"])), [100.0]
    monkeypatch.setattr(print_state.time, "monotonic", lambda: clock[0])
    latest.take("joint_states", JointState())
    assert list(print_state.state_lines(latest)) == ["active_modes   force_mode"]
    clock[0] += 3.0
    assert next(iter(print_state.state_lines(latest))).startswith("no joint_states for 3 s: the driver has ended or has lost the robot")


@pytest.mark.parametrize("arguments", [["state"], ["call", "move_j"], ["record", "run.csv"], ["doctor", "--report", "report.md"]])
def test_an_invalid_namespace_is_rejected(arguments, capsys):
    assert main([*arguments, "--namespace", "my-robot"]) == 2 and '"my-robot" is no namespace' in capsys.readouterr().err


@pytest.mark.parametrize("command", ["call", "state", "plot"])
def test_each_command_shows_the_version(command, capsys):
    assert main([command, "--version"]) == 0 and capsys.readouterr().out.startswith("ur_ros_rtde ")


def test_a_missing_driver_is_reported_after_the_wait():
    code, output = ur("state", "--wait", "0.5", domain=EMPTY_DOMAIN)
    assert code == 1 and "no joint_states within 0.5 s. Does robot_state_receiver run" in output, output


@pytest.mark.parametrize("arguments, status, missing", [
    (["call", "move_j", "--wait", DISCOVERY], 2, "no server of /nope/move_j"),
    (["state", "--wait", DISCOVERY], 1, f"no joint_states within {float(DISCOVERY):g} s"),
    (["record", "run.csv"], 1, "there is no service start_recording"),
    (["doctor", "--report", "report.md", "--yes"], 0, "no node of the driver was found with this namespace and ROS_DOMAIN_ID"),
], ids=lambda value: value[0] if isinstance(value, list) else "")
def test_a_wrong_namespace_is_answered_with_the_existing_ones(running, tmp_path, monkeypatch, arguments, status, missing):
    monkeypatch.chdir(tmp_path)
    code, output = ur(*arguments, "--namespace", "nope")
    assert code == status and f"{missing}, but there is a driver in /: leave out --namespace" in output, output


@pytest.mark.parametrize("nodes, text", [
    ([], ""),
    ([("command_server", "/nope"), ("command_server", "/left")], ""),
    ([("command_server", "/right"), ("dashboard_server", "/right"), ("command_server", "/left"), ("ur_viewer", "/")],
     ", but there is a driver in /left and /right: give --namespace left"),
])
def test_finds_the_namespaces_of_drivers(nodes, text):
    node = SimpleNamespace(get_namespace=lambda: "/nope", get_node_names_and_namespaces=lambda: nodes)
    assert other_drivers(node) == text


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
    assert code == 1 and str(file) in output, output


@pytest.fixture
def slow_recorder():
    """Services in the namespace slow. Returns the names of the requests, and what is answered to start_recording: `success`, and when:
    after `delay` s, or as soon as the event `released` is set."""
    client, requests, answer = Client("slow"), [], {"success": True, "delay": 1.0, "released": threading.Event()}

    def start(_, response):
        requests.append("start")
        answer["released"].wait(answer["delay"])
        response.success, response.message = answer["success"], "another recording runs"
        return response

    def stop(_, response):
        requests.append("stop")
        response.success = True
        return response

    client.node.create_service(StartRecording, "start_recording", start)
    client.node.create_service(StopRecording, "stop_recording", stop)
    yield requests, answer
    answer["released"].set()
    client.close()


@pytest.mark.parametrize("success, code, expected", [(True, 0, ["start", "stop"]), (False, 1, ["start"])])
def test_a_signal_during_the_request_leaves_no_recording_running(slow_recorder, success, code, expected):
    requests, answer = slow_recorder
    answer["success"] = success
    process = Process([find_program("ur_ros_rtde_cli", "ur"), "record", "run.csv", "--namespace", "slow"])
    wait_for(lambda: requests, 20.0, "the request")
    process.interrupt()
    assert process.wait(20.0) == code, process.output()
    assert requests == expected and ("another recording runs" in process.output()) == (not success)


def late_recording(slow_recorder, success):
    """`ur record` when it has waited too long for the answer to start_recording."""
    slow_recorder[1].update(success=success, delay=TIMEOUT_FACTOR * 60.0)
    code = f"from ur_ros_rtde_cli import main, record; record.RESPONSE_TIMEOUT = {2.0 * TIMEOUT_FACTOR}; exit(main.main())"
    process = Process([sys.executable, "-c", code, "record", "run.csv", "--namespace", "slow"])
    process.wait_for_output("start_recording did not respond", 30.0)
    return process


@pytest.mark.parametrize("success, expected, message", [(True, ["start", "stop"], "0 rows"), (False, ["start"], "another recording runs")])
def test_a_recording_that_starts_late_is_stopped(slow_recorder, success, expected, message):
    requests, answer = slow_recorder
    process = late_recording(slow_recorder, success)
    answer["released"].set()
    assert process.wait(20.0) == 1 and message in process.output(), process.output()
    assert requests == expected


@pytest.mark.parametrize("is_interrupted, code", [(False, 1), (True, 128 + signal.SIGINT)])
def test_a_recording_that_may_still_start_is_named_with_the_remedy(slow_recorder, is_interrupted, code):
    process = late_recording(slow_recorder, True)
    if is_interrupted:
        process.interrupt()
    assert process.wait(20.0) == code
    assert "end it: ur record --stop --namespace slow" in process.output(), process.output()


def test_a_recording_whose_program_was_killed_can_be_ended(slow_recorder):
    requests, _ = slow_recorder
    code, output = ur("record", "--stop", "--namespace", "slow")
    assert code == 0 and requests == ["stop"], output
    for arguments in ([], ["run.csv", "--stop"]):
        code, output = ur("record", *arguments)
        assert code == 2 and "give the file of a recording, or --stop" in output, output
    code, output = ur("record", "run.csv", "--time", "-5")
    assert code == 2 and "-5 is not above 0 s" in output, output


def test_a_recording_whose_message_cannot_be_written_ends(slow_recorder):
    requests, _ = slow_recorder
    with open("/dev/full", "w") as full:
        command = [find_program("ur_ros_rtde_cli", "ur"), "record", "run.csv", "--namespace", "slow", "--time", "0.2"]
        assert subprocess.run(command, stderr=full, stdout=subprocess.DEVNULL).returncode == 0
    assert requests == ["start", "stop"]


def test_a_signal_before_the_request_stops_the_recording():
    def wait(condition, limit=None):
        if not waits:
            waits.append(limit)
            raise Interrupted(signal.SIGINT)
        return condition()

    waits, sent, response = [], [], SimpleNamespace(success=True)
    client = SimpleNamespace(service_is_ready=lambda: True, call_async=sent.append)
    session = SimpleNamespace(node=SimpleNamespace(create_client=lambda *_: client), wait=wait, result=lambda *_: response)
    assert record._stop(session, StopRecording) is response and len(sent) == 1 and waits


def test_feedback_that_cannot_be_written_does_not_end_the_wait_for_the_result(monkeypatch):
    def fail(_):
        raise OSError(errno.ENOSPC, "no space left on device")

    output = JsonOutput(quiet=False)
    with monkeypatch.context() as patch:
        patch.setattr(sys, "stdout", SimpleNamespace(write=fail))
        output.feedback(SimpleNamespace(feedback=ActiveModes()))
        with pytest.raises(OSError, match="no space"):
            output.result(SimpleNamespace(status=GoalStatus.STATUS_SUCCEEDED, result=ActiveModes()))


def assert_that_the_output_is_reported(arguments, **environment):
    """On a disk that is full."""
    with open("/dev/full", "w") as full:
        ended = subprocess.run([find_program("ur_ros_rtde_cli", "ur"), *arguments], stdout=full, stderr=subprocess.PIPE, text=True,
                               timeout=TIMEOUT_FACTOR * 60.0, env={**os.environ, **environment})
    assert ended.returncode == 1 and ended.stderr.splitlines()[-1:] == ["the output cannot be written: No space left on device"], ended
    assert "Traceback" not in ended.stderr


@pytest.mark.parametrize("unbuffered", ["", "1"])
@pytest.mark.parametrize("arguments", [["--version"], ["plot", "--help"], ["plugins"], ["call", "move_j", "--show"],
                                       ["urdf", "--model", "ur10e"]], ids=" ".join)
def test_an_output_that_cannot_be_written_is_reported(arguments, unbuffered):
    assert_that_the_output_is_reported(arguments, PYTHONUNBUFFERED=unbuffered)


@pytest.mark.parametrize("arguments", [["call", "dashboard/robot_mode", "--json"], ["call", "dashboard/robot_mode"], ["state"]],
                         ids=" ".join)
def test_an_answer_that_cannot_be_written_is_reported(running, arguments):
    assert_that_the_output_is_reported(arguments)


def test_a_row_count_that_cannot_be_written_is_reported(slow_recorder):
    assert_that_the_output_is_reported(["record", "run.csv", "--namespace", "slow", "--time", "0.2"])
    assert slow_recorder[0] == ["start", "stop"]


def test_an_error_that_cannot_be_written_does_not_change_the_exit_code():
    with open("/dev/full", "w") as full:
        assert subprocess.run([find_program("ur_ros_rtde_cli", "ur"), "unknown"], stderr=full).returncode == 2


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
