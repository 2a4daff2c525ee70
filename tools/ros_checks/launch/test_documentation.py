"""The installed ros2cli accepts every line of the README and the documentation that begins with `ros2`."""

import re
import shlex
import subprocess

import pytest
from ros2 import ROOT, ros2
from ur_ros_rtde_launch.launch_arguments import NODES

README = ROOT / "README.md"
# Dashboard commands power the robot off, so they come last.
DOCUMENTS = [README, *sorted((ROOT / "docs").glob("*/*.md")),
             *sorted((ROOT / "docs" / "use" / "commands").glob("*.md"), key=lambda file: file.name == "dashboard.md")]


def lines(document, verb):
    """Returns the commands `ros2 <verb> …` of a document without comments, but none with a part left out (`…/name`). Quoted arguments may
    span several lines."""
    text = document.read_text().replace("\\\n", " ")
    found = re.findall(rf'^(ros2 {verb} (?:"[^"]*"|[^"\n])*)$', text, re.M) + re.findall(rf"`(ros2 {verb} [^`]*)`", text)
    return [re.sub(r"\s{2,}#.*", "", line).strip() for line in found if "…" not in line]


def cases(verb):
    return [pytest.param(line, id=f"{document.name}-{line[:60]}") for document in DOCUMENTS for line in lines(document, verb)]


def arguments(line, tmp_path):
    return shlex.split(line.replace("$PWD", str(tmp_path)).replace("--feedback ", ""))[1:]


def test_the_readme_moves_the_simulated_robot(driver):
    line, = lines(README, "action send_goal")
    code, printed = ros2(*shlex.split(line)[1:])
    assert code == 0 and "Feedback:" in printed and "success: true" in printed and "SUCCEEDED" in printed, printed
    code, printed = ros2("topic", "echo", "--once", "/joint_states")
    position = re.search(r"position:\n- (\S+)", printed)
    assert code == 0 and position and float(position[1]) == pytest.approx(-0.2, abs=0.001), printed
    programs = [line for line in lines(README, "run") if line.endswith(".py")]  # those in C++ need rclcpp, which the wheels lack
    assert programs
    for line in programs:
        code, printed = ros2(*shlex.split(line)[1:])
        assert code == 0, printed


def test_the_path_of_the_readme_has_the_program_ur():
    path, = re.findall(r"^export PATH=.*", README.read_text(), re.M)
    found = subprocess.run(["bash", "-c", f"{path}\ntype -p ur\nur --version"], capture_output=True, text=True)
    assert re.fullmatch(r"/.*/lib/ur_ros_rtde_cli/ur\nur_ros_rtde .*\n", found.stdout), found


def test_nodes_and_parameters_are_listed(driver):
    code, printed = ros2("node", "list")
    assert code == 0 and {f"/{node}" for node in NODES} <= set(printed.split())
    code, printed = ros2("param", "list", "/command_server")
    assert code == 0 and {"on_busy", "urcap_port", "watchdog_frequency"} <= set(printed.split())
    code, printed = ros2("param", "describe", "/command_server", "on_busy")
    assert code == 0 and "Type: string" in printed and "Read only: true" in printed, printed
    code, printed = ros2("action", "list", "-t")
    assert "/move_j [ur_ros_rtde_msgs/action/MoveJ]" in printed, printed
    code, printed = ros2("service", "call", "/get_joint_state", "ur_ros_rtde_msgs/srv/GetJointState", "{}")
    assert code == 0 and "success=True" in printed, printed


def test_follow_joint_trajectory_has_the_published_type(driver):
    assert "/follow_joint_trajectory [control_msgs/action/FollowJointTrajectory]" in ros2("action", "list", "-t")[1]


@pytest.mark.parametrize("line", cases("interface show"))
def test_interfaces_exist(line):
    code, printed = ros2(*shlex.split(line)[1:])
    assert code == 0 and printed, printed


@pytest.mark.parametrize("line", cases("service call"))
def test_services_answer(driver, line, tmp_path):
    code, printed = ros2(*arguments(line, tmp_path))
    assert code == 0 and "response:" in printed, printed


@pytest.mark.parametrize("line", cases("action send_goal"))
def test_goals_are_accepted_or_rejected_by_their_server(driver, line, tmp_path):
    """Checks types and fields of the goals. The tests in ur_ros_rtde_commands/test/every_command check that they succeed."""
    try:
        printed = ros2(*arguments(line, tmp_path), limit=20.0)[1]
    except subprocess.TimeoutExpired as expired:  # a long motion: the arm stops because its client has exited
        printed = (expired.stdout or b"").decode()
    assert "Goal accepted" in printed or "Goal was rejected" in printed, printed
