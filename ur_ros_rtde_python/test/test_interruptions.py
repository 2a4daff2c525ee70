"""Interruptions between the requests of a Robot, with a driver whose answers are delayed."""

import contextlib
import re
import signal
import sys

import pytest
from fake_driver import NAMESPACE, FakeDriver
from programs import Process
from support import HOME, TIMEOUT_FACTOR, wait_for
from ur_ros_rtde import CommandFailed, NoDriver, Rejected, Robot, Timeout, goal, recording
from ur_ros_rtde.connection import Connection


@pytest.fixture
def fake():
    with contextlib.closing(FakeDriver()) as driver:
        yield driver


@pytest.fixture
def arm(fake):
    with Robot(NAMESPACE, timeout=TIMEOUT_FACTOR * 20.0) as robot:
        yield robot


HEADER = """
import threading
import time
import rclpy
from ur_ros_rtde import Robot, RobotError
rclpy.init()
node = rclpy.create_node("own_node")
"""


@contextlib.contextmanager
def signaled_program(code):
    """A program with rclpy.init() that receives SIGINT when it has printed "running"."""
    program = Process([sys.executable, "-c", f"{HEADER}{code}"])
    try:
        program.wait_for_output("running", 30.0)
        program.signal(signal.SIGINT)
        yield program
    finally:
        program.kill()


def test_a_connection_that_a_signal_has_closed_is_no_lost_driver(fake):
    code = f"""
def wait():
    for use in (goal.result, lambda: arm.state.joint_positions, arm.stop):
        try:
            use()
        except RobotError as error:
            print(type(error).__name__, error, flush=True)
    print("end", flush=True)

arm = Robot("{NAMESPACE}", timeout=20.0)
goal = arm.start.move_j({HOME})
worker = threading.Thread(target=wait)
worker.start()
try:
    print("running", flush=True)
    rclpy.spin(node)
except BaseException:  # KeyboardInterrupt, or an error of rclpy.spin()
    worker.join()
"""
    with signaled_program(code) as program:
        program.wait_for_output("end", 30.0)
        closed = "RobotError the Robot is closed: a signal handler of rclpy.init() has shut down ROS in this program"
        assert [line for line in program.lines if line.startswith(("RobotError", "NoDriver"))] == [closed] * 3
        assert "Traceback" not in program.output()
        wait_for(lambda: "cancel move_j" in fake.received, 10.0, "the end of the goal")


def test_a_goal_that_could_not_be_sent_is_no_missing_driver(fake, arm, monkeypatch):
    def fail(self, function):
        raise Timeout("the node could not send a request within 10 s")

    arm._connection.action_client("move_j")
    monkeypatch.setattr(Connection, "in_executor", fail)
    monkeypatch.setattr(goal.Goal, "abandon", lambda self: None)
    with pytest.raises(Timeout, match="could not send"):
        arm.start.move_j(HOME)
    arm._goals.clear()


@pytest.mark.parametrize("wait", ["rclpy.spin(node)", "time.sleep(30.0)"], ids=["spin", "sleep"])
def test_a_signal_ends_a_recording_of_a_program_that_uses_rclpy_itself(fake, wait):
    code = f"""
try:
    with Robot("{NAMESPACE}", timeout=20.0) as arm, arm.record("run.csv"):
        print("running", flush=True)
        {wait}
except BaseException:  # KeyboardInterrupt, or an error of rclpy.spin()
    print("end", flush=True)
"""
    with signaled_program(code) as program:
        program.wait_for_output("end", 30.0)
        assert fake.received[:2] == ["start_recording", "stop_recording"] and "not confirmed" not in program.output()


def test_a_recording_that_is_not_stopped_is_reported_beside_the_exception(fake, arm, caplog):
    fake.set(failures={"stop_recording": "the disk is full"})
    with pytest.raises(KeyError), arm.record("run.csv"):
        raise KeyError
    assert re.search("the end of the recording .*run.csv is not confirmed: the disk is full", caplog.text)


@pytest.mark.parametrize("failures, expected", [({}, ["start_recording", "stop_recording"]),
                                                ({"start_recording": "another recording runs"}, ["start_recording"])])
def test_an_interrupted_start_leaves_no_recording_of_this_program_running(fake, arm, failures, expected):
    fake.set(interrupt="start_recording", failures=failures)
    with pytest.raises(KeyboardInterrupt), arm.record("run.csv"):
        pytest.fail("the block was executed")
    assert fake.received == expected


def requests_of_a_late_recording(fake):
    """With a timeout of 0.9 s. Returns the requests."""
    with Robot(NAMESPACE, timeout=TIMEOUT_FACTOR * 20.0) as robot:
        wait_for(lambda: robot._connection.served().get("move_j"), 20.0, "the driver")
        robot._connection.timeout = 0.9
        with pytest.raises(NoDriver, match="did not respond"), robot.record("run.csv"):
            pytest.fail("the block was executed")
    return fake.received


def test_a_recording_that_starts_late_is_stopped(fake):
    fake.set(delay="start_recording")
    assert requests_of_a_late_recording(fake) == ["start_recording", "stop_recording"]


def test_a_recording_that_may_still_start_is_named_with_the_remedy(fake, monkeypatch, caplog):
    monkeypatch.setattr(recording, "ANSWER_TIMEOUT", 0.0)
    fake.set(hold="start_recording")
    assert requests_of_a_late_recording(fake) == ["start_recording"]
    assert re.search("the end of the recording .*run.csv is not confirmed: .* end it: ur record --stop --namespace fake", caplog.text)


def test_a_recording_whose_end_is_interrupted_is_stopped(fake, arm, monkeypatch):
    def request(self, service, name, *others):
        if name == "stop_recording" and not interrupted:
            interrupted.append(name)
            raise KeyboardInterrupt  # before it is sent
        return send(self, service, name, *others)

    interrupted, send = [], Connection.request
    monkeypatch.setattr(Connection, "request", request)
    with pytest.raises(KeyboardInterrupt), arm.record("run.csv"):
        pass
    assert interrupted and fake.received == ["start_recording", "stop_recording"]


@pytest.mark.parametrize("event, timeout, error", [("interrupt", None, KeyboardInterrupt), ("delay", 0.5, Timeout)])
def test_an_interrupted_start_of_force_mode_ends_it(fake, arm, event, timeout, error):
    fake.set(**{event: "force_mode_start"})
    with pytest.raises(error), arm.modes.force_mode(result_timeout=timeout):
        pytest.fail("the block was executed")
    received = fake.received
    assert received[0] == "force_mode_start" and received[-1] == "force_mode_stop"


def test_a_start_of_force_mode_that_fails_leaves_the_mode_of_another_client_on(fake, arm):
    fake.set(failures={"force_mode_start": "the robot is in a protective stop"})
    with pytest.raises(CommandFailed, match="protective stop"), arm.modes.force_mode():
        pytest.fail("the block was executed")
    fake.set(reject="force_mode_start")
    with pytest.raises(Rejected), arm.modes.force_mode():
        pytest.fail("the block was executed")
    assert fake.received == ["force_mode_start"]


def test_force_mode_whose_end_is_interrupted_is_ended(fake, arm):
    fake.set(interrupt="force_mode_stop")
    with pytest.raises(KeyboardInterrupt), arm.modes.force_mode():
        pass
    assert [name for name in fake.received if "cancel" not in name] == ["force_mode_start", "force_mode_stop", "force_mode_stop"]


def test_force_mode_that_is_not_ended_is_reported_beside_the_exception(fake, arm, caplog):
    fake.set(failures={"force_mode_stop": "a motion is running", "stop": "the arm still moves"})
    with pytest.raises(KeyError), arm.modes.force_mode():
        raise KeyError
    assert "the end of force mode is not confirmed: stop: the arm still moves" in caplog.text


@pytest.mark.parametrize("mode, end", [("force_mode", "force_mode_stop"), ("freedrive", "cancel freedrive")])
def test_a_signal_ends_a_mode_of_a_program_that_uses_rclpy_itself(fake, mode, end):
    code = f"""
arm = Robot("{NAMESPACE}", timeout=20.0)
try:
    with arm.modes.{mode}():
        print("running", flush=True)
        rclpy.spin(node)
except BaseException:  # KeyboardInterrupt, or an error of rclpy.spin()
    print("end", flush=True)
time.sleep(30.0)
"""
    with signaled_program(code) as program:
        program.wait_for_output("end", 30.0)
        assert end in fake.received, program.output()


@pytest.mark.parametrize("start", [lambda arm: arm.modes.freedrive(), lambda arm: arm.start.freedrive()], ids=["mode", "goal"])
def test_an_interruption_after_the_acceptance_cancels_the_goal(fake, arm, monkeypatch, start):
    @contextlib.contextmanager
    def interrupted_signals():
        yield
        raise KeyboardInterrupt

    monkeypatch.setattr(goal, "own_signals", interrupted_signals)
    with pytest.raises(KeyboardInterrupt), start(arm):
        pytest.fail("the block was executed")
    assert fake.received == ["freedrive", "cancel freedrive"]


def test_an_interruption_at_the_end_of_a_block_cancels_the_goal(fake, arm, monkeypatch):
    def cancel(self):
        monkeypatch.undo()
        raise KeyboardInterrupt  # before the request is sent

    monkeypatch.setattr(goal.Goal, "cancel", cancel)
    with pytest.raises(KeyboardInterrupt), arm.start.freedrive():
        pass
    assert fake.received == ["freedrive", "cancel freedrive"]


def test_an_interruption_while_a_robot_is_closed_removes_its_node(fake, monkeypatch):
    def abandon(self):
        raise KeyboardInterrupt

    robot = Robot(NAMESPACE, timeout=TIMEOUT_FACTOR * 20.0)
    robot.start.freedrive()
    monkeypatch.setattr(goal.Goal, "abandon", abandon)
    with pytest.raises(KeyboardInterrupt):
        robot.close()
    assert not robot._connection.is_open
