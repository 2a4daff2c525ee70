"""Bringing the robot into operation from any state, and powering it down."""

import threading

import pytest
import robot_fixtures
from action_msgs.msg import GoalStatus
from arm_state import home_plus, wait_until_moving
from dashboard_proxy import PassesOn, robot_behind
from programs import Simulator, start_node
from ros_client import Client
from support import HOME, wait_for

from ur_ros_rtde_msgs.action import DashboardCommand, DashboardText, MakeReady, MoveJ, SendScript, Stop, Trigger
from ur_ros_rtde_msgs.msg import DriverState, ErrorCode

RECOVERY_TIME_FACTOR = 1.0  # real durations


def make_ready(robot, **fields):
    goal = robot.send(MakeReady, "make_ready", **fields)
    result = goal.succeeded(60.0)
    robot.send(MoveJ, "move_j", joint_positions=HOME, speed=1.0).succeeded()
    return result, [feedback.state for feedback in goal.feedback]


def fail_to_make_ready(robot, code, **fields):
    status, result = robot.send(MakeReady, "make_ready", **fields).wait_for_result()
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, code), result.message
    return result.message


def wait_for_protective_stop(simulator):
    wait_for(lambda: simulator.state()["safety_mode"] == "PROTECTIVE_STOP", 15.0, "the protective stop")


def power_off(robot, simulator):
    """Returns when the driver knows it: until then, the robot is ready for it."""
    simulator.control("power", to="off")
    wait_for(lambda: not robot.send(MoveJ, "move_j", joint_positions=HOME).accepted, 15.0, "the driver to detect the power off")


def test_make_ready_returns_at_once_if_the_robot_is_ready(robot):
    _, states = make_ready(robot)
    assert states == []


def test_make_ready_powers_on_with_progress(robot, simulator):
    robot.send(DashboardCommand, "stand_down").succeeded()
    assert simulator.state()["robot_mode"] == "POWER_OFF"
    _, states = make_ready(robot)
    progress = " / ".join(states)
    assert progress.index("powering on") < progress.index("releasing the brakes"), progress


def test_make_ready_releases_the_brakes(robot, simulator):
    power_off(robot, simulator)
    simulator.control("power", to="on")
    _, states = make_ready(robot)
    assert any("brakes" in state for state in states)


def test_make_ready_unlocks_a_protective_stop_without_resuming_the_motion(robot, simulator):
    goal = robot.send(MoveJ, "move_j", joint_positions=home_plus(1.5), speed=0.5)
    wait_until_moving(robot)
    robot.send(Trigger, "trigger_protective_stop").succeeded()
    assert goal.wait_for_result()[1].error_code == ErrorCode.PROTECTIVE_STOP
    wait_for_protective_stop(simulator)
    assert "unlock_protective_stop" in fail_to_make_ready(robot, ErrorCode.PROTECTIVE_STOP, unlock_protective_stop=False)
    robot.send(MakeReady, "make_ready").succeeded(60.0)
    stopped_at = simulator.state()["actual"]["position"][0]
    simulator.wait(0.5)
    assert simulator.state()["actual"]["position"][0] == pytest.approx(stopped_at, abs=1e-3)


def test_trigger_protective_stop_stops_a_script(robot, simulator):
    goal = robot.send(SendScript, "send_script", script=f"movej({home_plus(1.5)}, a=1, v=0.5)")
    wait_until_moving(robot)
    robot.send(Trigger, "trigger_protective_stop").succeeded()
    assert goal.wait_for_result()[1].error_code == ErrorCode.PROTECTIVE_STOP
    make_ready(robot)


def test_make_ready_restarts_a_stopped_program(robot, simulator):
    robot.send(DashboardCommand, "dashboard/stop").wait_for_result()
    make_ready(robot)


def test_make_ready_recovers_from_a_violation_only_with_restart_safety(robot, simulator):
    simulator.control("violation", reason="a test")
    wait_for(lambda: simulator.state()["safety_mode"] == "VIOLATION", 15.0, "the violation")
    assert "restart_safety" in fail_to_make_ready(robot, ErrorCode.SAFETY_VIOLATION)
    make_ready(robot, restart_safety=True)


@pytest.mark.parametrize("blocker, remedy, code", [
    (("emergency_stop", {"pressed": True}), ("emergency_stop", {"pressed": False}), ErrorCode.EMERGENCY_STOP),
    (("safeguard", {"open": True}), ("safeguard", {"open": False}), ErrorCode.SAFEGUARD_STOP),
    (("remote_control", {"on": False}), ("remote_control", {"on": True}), ErrorCode.NOT_READY),
])
def test_make_ready_reports_conditions_that_require_an_operator(robot, simulator, blocker, remedy, code):
    if blocker[0] == "remote_control":
        simulator.control("power", to="off")
    simulator.control(blocker[0], **blocker[1])
    try:
        wait_for(lambda: robot.send(MakeReady, "make_ready").wait_for_result()[1].error_code == code, 10.0, "the reason")
    finally:
        simulator.control(remedy[0], **remedy[1])
    wait_for(lambda: simulator.state()["safety_mode"] == "NORMAL", 10.0, "the cycle in which the remedy has its effect")
    make_ready(robot)


def test_cancel_and_timeout_end_make_ready(robot, simulator):
    power_off(robot, simulator)
    goal = robot.send(MakeReady, "make_ready")
    wait_for(lambda: goal.feedback, 10.0, "the first step")
    goal.cancel()
    assert goal.wait_for_result()[0] == GoalStatus.STATUS_CANCELED
    assert "still" in fail_to_make_ready(robot, ErrorCode.TIMEOUT, timeout=0.01)
    make_ready(robot)


@pytest.mark.parametrize("command", ["stand_down", "dashboard/power_off"])
def test_a_command_that_powers_off_ends_make_ready(robot, simulator, command):
    power_off(robot, simulator)
    goal = robot.send(MakeReady, "make_ready")
    wait_for(lambda: simulator.state()["robot_mode"] != "POWER_OFF", 10.0, "the arm to be powered on")
    robot.send(DashboardCommand, command).succeeded()
    assert goal.wait_for_result()[1].error_code == ErrorCode.PREEMPTED
    simulator.wait(3.0)  # in which make_ready would send the next command
    assert simulator.state()["robot_mode"] == "POWER_OFF"
    make_ready(robot)


def test_stand_down_preempts_the_running_motion(robot, simulator):
    goal = robot.send(MoveJ, "move_j", joint_positions=home_plus(1.5), speed=0.5)
    wait_until_moving(robot)
    robot.send(DashboardCommand, "stand_down").succeeded()
    assert goal.wait_for_result()[1].error_code == ErrorCode.PREEMPTED
    assert simulator.state()["robot_mode"] == "POWER_OFF"
    make_ready(robot)


class RejectsStop(PassesOn):
    def answer(self, line):
        return b"Failed to execute: stop\n" if line.strip() == b"stop" else super().answer(line)


class HoldsMakeReady(PassesOn):
    """Holds one line of make_ready: the answer to `robotmode` until the arm is powered off, or `power on` until make_ready has to end."""

    held = ""
    holding = threading.Event()
    stopped = threading.Event()  # the goal of make_ready is being ended
    powered_off = threading.Event()
    passed_on = []
    is_make_ready = False  # the client of this connection: no other one asks for the safety mode

    @classmethod
    def arm(cls, held):
        cls.held, cls.passed_on = held, []
        cls.holding, cls.stopped, cls.powered_off = (threading.Event() for _ in range(3))

    def answer(self, line):
        text = line.strip().decode()
        self.is_make_ready = self.is_make_ready or text == "safetymode"
        holds = self.is_make_ready and text == self.held and not self.holding.is_set()
        if holds and text == "power on":
            self.hold(self.stopped, 1.8)  # make_ready waits for 2 s
        self.passed_on.append(text)
        answer = super().answer(line)
        if holds and text == "robotmode":
            self.hold(self.powered_off, 1.8)
        if text == "power off":
            self.powered_off.set()
        return answer

    def hold(self, until, timeout):
        self.holding.set()
        until.wait(timeout)


class RejectsStopLate(RejectsStop):
    """Holds the first `stop` until the driver has its RTDE connection again, but not until the driver waits no longer for the answer."""

    @classmethod
    def arm(cls):
        cls.is_held, cls.was_connected, cls.connected = False, False, threading.Event()

    def answer(self, line):
        if line.strip() == b"stop" and not self.is_held:
            RejectsStopLate.is_held = True
            RejectsStopLate.was_connected = self.connected.wait(0.4)
        return super().answer(line)


def test_stand_down_powers_off_although_its_stop_has_failed(addresses, processes):
    """Without a watchdog, only the dashboard server could end the script."""
    with robot_behind(RejectsStop, addresses, processes, "unstoppable", "watchdog_frequency:=0.0",
                      "plugins:=[move_j,send_script,stand_down]") as (client, simulator):
        assert client.send(SendScript, "send_script", script=f"movej({home_plus(3.0)}, a=1, v=0.2)").accepted
        wait_for(lambda: not simulator.is_at_rest(), 15.0, "a motion")
        result = client.send(DashboardCommand, "stand_down").succeeded()
        assert "all attempts to stop the arm have failed" in result.message, result.message
        assert simulator.state()["robot_mode"] == "POWER_OFF" and simulator.is_at_rest()


class AnswersStopLate(PassesOn):
    """Passes `stop` on, and answers it only when the goal of the stop has ended."""

    ended = threading.Event()

    def answer(self, line):
        answer = super().answer(line)
        if line.strip() == b"stop":
            self.ended.wait(10.0)
        return answer


def test_a_stop_succeeds_without_the_answer_of_a_busy_dashboard_server(addresses, processes):
    AnswersStopLate.ended.clear()
    with robot_behind(AnswersStopLate, addresses, processes, "busy", "plugins:=[move_j,send_script,stop]") as (client, simulator):
        script = client.send(SendScript, "send_script", script=f"movej({home_plus(3.0)}, a=1, v=0.2)")
        wait_for(lambda: not simulator.is_at_rest(), 15.0, "a motion")
        client.send(Stop, "stop").succeeded()
        assert simulator.is_at_rest() and not AnswersStopLate.ended.is_set()
        AnswersStopLate.ended.set()
        assert script.wait_for_result()[1].error_code == ErrorCode.PREEMPTED


@pytest.fixture
def make_ready_held(addresses, processes):
    """A client and the simulator behind a proxy, with the arm powered off."""
    HoldsMakeReady.arm("")
    with robot_behind(HoldsMakeReady, addresses, processes, "held",
                      "plugins:=[move_j,make_ready,stand_down,dashboard/power_off]") as (client, simulator):
        power_off(client, simulator)
        yield client, simulator


@pytest.mark.parametrize("command, held", [
    ("dashboard/power_off", "robotmode"),  # the next line would be `power on`
    ("dashboard/power_off", "power on"),
    ("stand_down", "power on"),
])
def test_make_ready_sends_nothing_after_a_power_off(make_ready_held, command, held):
    client, simulator = make_ready_held
    client.wait_for_server(DashboardCommand, command)  # its discovery takes no time while make_ready is held
    HoldsMakeReady.arm(held)
    goal = client.send(MakeReady, "make_ready")
    assert HoldsMakeReady.holding.wait(15.0), HoldsMakeReady.passed_on
    off = client.send(DashboardCommand, command)  # accepted after it has ended make_ready
    HoldsMakeReady.stopped.set()
    off.succeeded()
    assert goal.wait_for_result()[1].error_code == ErrorCode.PREEMPTED
    simulator.wait(3.0)  # in which make_ready would send the next command
    requests = [line for line in HoldsMakeReady.passed_on if line.startswith(("power", "brake"))]
    assert requests.index("power off") == len(requests) - 1, requests
    assert held == "power on" or len(requests) == 1, requests
    assert simulator.state()["robot_mode"] == "POWER_OFF"


def test_a_script_that_dashboard_pause_has_stopped_goes_on_with_play(robot, simulator):
    goal = robot.send(SendScript, "send_script", script=f"movej({home_plus(0.5)}, a=1, v=0.2)")
    wait_until_moving(robot)
    robot.send(DashboardCommand, "dashboard/pause").succeeded()
    wait_for(simulator.is_at_rest, 10.0, "standstill")
    robot.send(DashboardCommand, "dashboard/play").succeeded()
    goal.succeeded()
    assert simulator.state()["actual"]["position"][0] == pytest.approx(HOME[0] + 0.5, abs=0.01)


def test_dashboard_pause_ends_a_motion_of_the_driver(robot, simulator):
    goal = robot.send(MoveJ, "move_j", joint_positions=home_plus(0.5), speed=0.2)
    wait_until_moving(robot)
    paused = robot.send(DashboardCommand, "dashboard/pause").succeeded()
    assert "programState" in paused.message, paused.message
    assert goal.wait_for_result()[1].error_code == ErrorCode.PROGRAM_STOPPED
    wait_for(simulator.is_at_rest, 10.0, "standstill")
    robot_fixtures.make_ready(robot)  # the driver has started its program again


def test_dashboard_load_succeeds_beside_the_program_of_the_driver(robot, simulator):
    simulator.control("store_program", name="other.urp", script="def other():\n  sync()\nend\n")
    loaded = robot.send(DashboardText, "dashboard/load", text="other.urp").succeeded()
    assert loaded.answer == "Loading program: other.urp"


def test_polyscope_x_rejects_what_needs_a_dashboard_server_with_this_reason(addresses, processes):
    simulator = processes(Simulator(addresses[1], "--polyscope", "10.12.0", "--ports", "robot_api=0", urcaps=()))
    driver = processes(start_node("driver", simulator.address, "plugins:=[make_ready,dashboard/power_on]", "ur_type:=ur10e", namespace="x"))
    driver.wait_for_output("PolyScope X has no dashboard server")
    client = Client("x")
    try:
        for action, name in ((MakeReady, "make_ready"), (DashboardCommand, "dashboard/power_on")):
            rejection = client.rejection(client.send(action, name))
            assert rejection.error_code == ErrorCode.NOT_SUPPORTED, rejection.message
            assert "PolyScope X has no dashboard server" in rejection.message, rejection.message
    finally:
        client.close()


def stop_while_rtde_comes_back(client, simulator):
    """Returns the result of a stop."""
    states = client.subscribe(DriverState, "driver_state", transient_local=True)

    def is_disconnected():
        return states[-1].name == "DISCONNECTED"

    simulator.control("refuse_connections", which="rtde")
    simulator.control("drop_links", which="rtde")
    wait_for(lambda: states and is_disconnected(), 10.0, "the driver to notice it")
    RejectsStopLate.arm()
    stop = client.send(Stop, "stop")
    simulator.control("accept_connections", which="rtde")
    wait_for(lambda: not is_disconnected(), 10.0, "the connection")
    RejectsStopLate.connected.set()
    return stop.wait_for_result()[1]


def test_a_stop_goes_on_with_rtde_that_is_back_when_the_dashboard_server_has_failed(addresses, processes):
    RejectsStopLate.arm()
    with robot_behind(RejectsStopLate, addresses, processes, "interrupted", "plugins:=[move_j,stop]") as (client, simulator):
        for _ in range(20):  # the driver tries to connect once a second
            robot_fixtures.make_ready(client)
            result = stop_while_rtde_comes_back(client, simulator)
            if RejectsStopLate.was_connected:
                assert result.success, result.message
                return
        pytest.fail("the connection was never back in time")
