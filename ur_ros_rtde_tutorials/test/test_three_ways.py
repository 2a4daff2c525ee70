"""Moving down until a force: a plugin, two programs that are sent to the robot, one program with a loop, and the command of the driver.
Each statement of docs/use/plugin_or_script.md about them is tested here."""

import csv
import signal

import pytest
from geometry_msgs.msg import Twist, Vector3
from programs import Process, find_program
from support import HOME, wait_for
from ur_ros_rtde_tutorials.action import MoveDownUntilForce

from ur_ros_rtde_msgs.action import MoveJ, MoveUntilForce, ZeroFtSensor
from ur_ros_rtde_msgs.srv import StartRecording, StopRecording

THRESHOLD = 20.0  # N
SURFACE = {"stiffness": 3000.0, "damping": 80.0}  # soft: no way may end in a protective stop, however busy the host is
CYCLE = 0.002  # s of the controller


@pytest.fixture
def above_a_surface(robot, simulator):
    robot.send(MoveJ, "move_j", joint_positions=HOME, speed=1.0).succeeded(30.0)
    robot.send(ZeroFtSensor, "zero_ft_sensor").succeeded()  # a program that began in contact has zeroed it there
    simulator.control("place_surface", z=simulator.state()["actual_tcp_pose"][2] - 0.1, **SURFACE)


def with_the_plugin(robot, simulator):
    robot.send(MoveDownUntilForce, "move_down_until_force").succeeded(30.0)


def with_the_command(robot, simulator):
    robot.send(MoveUntilForce, "move_until_force", twist=Twist(linear=Vector3(z=-0.1)), acceleration=0.5, distance=0.3,
               threshold=THRESHOLD).succeeded(30.0)


def with_two_programs(robot, simulator):
    run_example("two_snippets.py", simulator)


def with_one_program(robot, simulator):
    run_example("urscript_loop.py", simulator)


def start_example(name, simulator):
    return Process([find_program("ur_ros_rtde_tutorials", name), simulator.address])


def run_example(name, simulator):
    example = start_example(name, simulator)
    assert example.wait(60.0) == 0, example.output()
    assert "stopped at" in example.output()


def record(robot, file, way, simulator):
    """Returns for each cycle the time in s, the force along Z in N and the speed of the fastest joint in rad/s; then the lost cycles."""
    fields = ["timestamp", "actual_TCP_force", "target_qd"]
    assert robot.call(StartRecording, "start_recording", filename=str(file), fields=fields).success
    try:
        way(robot, simulator)
    finally:
        answer = robot.call(StopRecording, "stop_recording")
    assert answer.success
    with file.open(newline="") as text:
        return [(float(row["timestamp"]), abs(float(row["actual_TCP_force_2"])),
                 max(abs(float(row[f"target_qd_{joint}"])) for joint in range(6))) for row in csv.DictReader(text)], answer.lost


def reaction(rows):
    """Returns the time in s from the first force above the threshold to the first lower speed, and the largest force in N."""
    contact, _, speed = next(row for row in rows if row[1] > THRESHOLD and row[2] > 0.01)
    slower = next(time for time, _, now in rows if time > contact and now < 0.99 * speed)
    return slower - contact, max(force for _, force, _ in rows)


@pytest.mark.parametrize("way", [with_the_plugin, with_two_programs, with_one_program, with_the_command])
def test_the_arm_stops_at_the_surface(robot, simulator, above_a_surface, tmp_path, way):
    rows, lost = record(robot, tmp_path / "run.csv", way, simulator)
    duration, force = reaction(rows)
    print(f"{way.__name__}: {1e3 * duration:.0f} ms from the force to the deceleration, at most {force:.0f} N")
    assert simulator.is_at_rest()
    if way is with_one_program and lost == 0:
        assert duration <= 4.5 * CYCLE, "the loop runs on the controller"
    robot.send(MoveJ, "move_j", joint_positions=HOME, speed=1.0).succeeded(30.0)


def moves_down(simulator):
    return max(map(abs, simulator.state()["actual"]["velocity"])) > 0.02


@pytest.mark.parametrize("name, goes_on", [("two_snippets.py", True), ("urscript_loop.py", False)])
def test_what_the_arm_does_when_the_program_is_killed(robot, simulator, name, goes_on):
    robot.send(MoveJ, "move_j", joint_positions=HOME, speed=1.0).succeeded(30.0)
    start = simulator.state()["actual_tcp_pose"][2]
    example = start_example(name, simulator)
    wait_for(lambda: moves_down(simulator), 30.0, "the arm to move")
    example.signal(signal.SIGKILL)
    wait_for(lambda: simulator.is_at_rest(), 60.0, "standstill")
    way = start - simulator.state()["actual_tcp_pose"][2]
    assert way == pytest.approx(0.3, abs=0.002) if goes_on else way < 0.29, f"{way} m"


@pytest.mark.parametrize("name", ["two_snippets.py", "urscript_loop.py"])
def test_a_signal_stops_the_arm(robot, simulator, name):
    robot.send(MoveJ, "move_j", joint_positions=HOME, speed=1.0).succeeded(30.0)
    start = simulator.state()["actual_tcp_pose"][2]
    example = start_example(name, simulator)
    wait_for(lambda: moves_down(simulator), 30.0, "the arm to move")
    example.signal(signal.SIGINT)
    example.wait(30.0)
    wait_for(lambda: simulator.is_at_rest(), 30.0, "standstill")
    assert start - simulator.state()["actual_tcp_pose"][2] < 0.29
    wait_for(lambda: robot.send(MoveJ, "move_j", joint_positions=HOME, speed=1.0).accepted, 30.0, "the driver to accept a motion")
