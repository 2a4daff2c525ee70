"""Runs the examples."""

import contextlib
import json
import pathlib
import signal
import subprocess
import sys

import pytest
from programs import Process, Simulator, find_program, start_node
from robot_fixtures import simulated_robot
from ros_client import Client
from support import FEW_PLUGINS, HOME, TIMEOUT_FACTOR, wait_for

from ur_ros_rtde_msgs.action import MoveJ


def has_program(name):
    try:
        return bool(find_program("ur_ros_rtde_tutorials", name))
    except FileNotFoundError:
        return False


NOTEBOOKS = pathlib.Path(__file__).resolve().parents[1] / "notebooks"
needs_rclcpp = pytest.mark.skipif(not has_program("c01_send_a_goal"), reason="rclcpp is not installed: no examples in C++")


@pytest.fixture(scope="module")
def running():
    with simulated_robot() as simulator:
        yield simulator


@pytest.mark.parametrize("name, limit, text", [
    ("t01_send_a_goal.py", 60.0, "done, error_code 0"),
    ("t02_read_the_state.py", 60.0, "force along the tool"),
    ("t03_cancel_a_goal.py", 60.0, "canceled: "),
    ("arm_in_ten_lines.py", 60.0, "s left"),
])
def test_the_example_succeeds(running, name, limit, text):
    example = Process([find_program("ur_ros_rtde_tutorials", name)])
    assert example.wait(limit) == 0, example.output()
    assert text in example.output()


def test_the_notebook_runs(running, tmp_path):
    notebook = json.loads((NOTEBOOKS / "arm_in_python.ipynb").read_text())
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    (tmp_path / "cells.py").write_text("\n".join("".join(cell["source"]) for cell in cells))
    cells = Process([sys.executable, tmp_path / "cells.py"], {"MPLBACKEND": "Agg", "TMPDIR": str(tmp_path)})
    assert cells.wait(90.0) == 0, cells.output()
    assert "speed | 10.0 | above 0 and at most 3.14 rad/s" in cells.output() and "largest tracking error" in cells.output()


def test_the_notebook_has_no_outputs():
    notebook = json.loads((NOTEBOOKS / "arm_in_python.ipynb").read_text())
    assert not any(cell.get("outputs") or cell.get("execution_count") for cell in notebook["cells"])


@pytest.mark.parametrize("name", ["t01_send_a_goal.py", "t03_cancel_a_goal.py",
                                  *(pytest.param(name, marks=needs_rclcpp) for name in ("c01_send_a_goal", "c03_waypoints"))])
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


@needs_rclcpp
@pytest.mark.parametrize("name, texts", [
    ("c01_send_a_goal", ["%", "done, error_code 0"]),
    ("c02_read_the_state", ["shoulder_pan_joint", "wrist_3_joint"]),
    ("c03_waypoints", ["s left", "done, error_code 0"]),
    ("c04_power_on", ["robot mode: RUNNING"]),
])
def test_the_cpp_example_succeeds(running, name, texts):
    example = Process([find_program("ur_ros_rtde_tutorials", name)])
    assert example.wait(90.0) == 0, example.output()
    assert all(text in example.output() for text in texts), example.output()


@needs_rclcpp
def test_the_cpp_example_powers_the_arm_on(running):
    running.control("power", to="off")
    wait_for(lambda: running.state()["robot_mode"] == "POWER_OFF", 10.0, "the arm to be off")
    example = Process([find_program("ur_ros_rtde_tutorials", "c04_power_on")])
    assert example.wait(90.0) == 0, example.output()
    assert running.state()["robot_mode"] == "RUNNING"


@needs_rclcpp
def test_the_cpp_example_reports_a_rejected_goal(running):
    example = Process([find_program("ur_ros_rtde_tutorials", "c01_send_a_goal"), "--ros-args", "-p", "speed:=-1.0"])
    assert example.wait(30.0) == 1
    assert "rejected: see the log of command_server" in example.output()
    assert running.is_at_rest()


@needs_rclcpp
@pytest.mark.parametrize("name, text", [
    ("c01_send_a_goal", "start the driver first"),
    ("c02_read_the_state", "no messages received"),
    ("c03_waypoints", "the action execute_trajectory is not available: start the driver first"),
    ("c04_power_on", "the action dashboard/power_on is not available: start the driver first"),
])
def test_the_cpp_example_reports_a_missing_driver(name, text):
    example = Process([find_program("ur_ros_rtde_tutorials", name), "--ros-args", "-r", "__ns:=/no_driver"])
    assert example.wait(30.0) == 1
    assert text in example.output()


@needs_rclcpp
@pytest.mark.parametrize("end", [Process.stop, Process.kill])
def test_the_cpp_example_ends_with_the_driver(addresses, end):
    simulator = Simulator(addresses[1])
    driver = start_node("driver", simulator.address, FEW_PLUGINS, namespace="ending")
    client = Client(namespace="ending")
    try:
        wait_for(lambda: client.send(MoveJ, "move_j", joint_positions=HOME).accepted, 30.0, "the driver to accept a motion")
        example = Process([find_program("ur_ros_rtde_tutorials", "c01_send_a_goal"), "--ros-args", "-r", "__ns:=/ending"])
        wait_for(lambda: not simulator.is_at_rest(), 20.0, "the arm to move")
        end(driver)
        assert example.wait(40.0) == 1, example.output()
        wait_for(simulator.is_at_rest, 10.0, "the arm to stop")
    finally:
        client.close()
        driver.stop()
        simulator.stop()


@pytest.fixture(scope="module")
def two_simulators(addresses):
    """Two robots with drivers in the namespaces left and right."""
    with contextlib.ExitStack() as resources:
        simulators = []
        for address, namespace in zip(addresses[1:3], ("left", "right"), strict=True):
            simulators.append(Simulator(address))
            resources.callback(simulators[-1].stop)
            resources.callback(start_node("driver", address, "ur_type:=ur10e", namespace=namespace).stop)
        yield simulators


def test_two_arms_stop_together(two_simulators):
    def start():
        return Process([find_program("ur_ros_rtde_tutorials", "two_arms.py")])

    example = start()
    assert example.wait(60.0) == 0 and "both arms have arrived" in example.output(), example.output()
    example = start()
    wait_for(lambda: not any(simulator.is_at_rest() for simulator in two_simulators), 30.0, "both arms to move")
    two_simulators[0].control("protective_stop", reason="a test")
    assert example.wait(20.0) == 1 and "both arms are at rest: " in example.output(), example.output()
    assert all(simulator.is_at_rest() for simulator in two_simulators)
