"""A program that dashboard/play starts does not outlast a stop, a cancel or a failure, however late the robot answers or begins it."""

import contextlib
import socket
import threading

import pytest
from arm_state import home_plus
from dashboard_proxy import PORT_BEHIND, PassesOn, robot_behind
from support import wait_for

from ur_ros_rtde_msgs.action import DashboardCommand, Stop
from ur_ros_rtde_msgs.msg import ErrorCode

LATE = 1.5  # s, longer than the driver waits for the begin of a program that was answered and is to be ended


class HoldsPlay(PassesOn):
    """Holds `play` until the client has sent a stop."""

    @classmethod
    def arm(cls, timeout=1.2):
        """`timeout`: s, shorter than the driver waits for a late answer, or longer than the test."""
        cls.timeout, cls.holding, cls.stopped = timeout, threading.Event(), threading.Event()

    def answer(self, line):
        if line.strip() == b"play":
            self.holding.set()
            self.stopped.wait(self.timeout)
        return super().answer(line)


class HoldsGreeting(PassesOn):
    """Holds the greeting of the first connection after arm()."""

    holding = threading.Event()
    holding.set()
    has_played = False

    @classmethod
    def arm(cls):
        cls.holding, cls.stopped, cls.has_played = threading.Event(), threading.Event(), False

    def handle(self):
        if not self.holding.is_set():
            self.holding.set()
            self.stopped.wait(60.0)
        super().handle()

    def answer(self, line):
        HoldsGreeting.has_played = self.has_played or line.strip() == b"play"
        return super().answer(line)


class BeginsLate(PassesOn):
    """Answers `play` at once; the program begins when the client has sent a stop."""

    @classmethod
    def arm(cls):
        cls.answered, cls.stopped, cls.began = (threading.Event() for _ in range(3))

    def answer(self, line):
        if line.strip() != b"play":
            return super().answer(line)
        threading.Thread(target=self.play_later, daemon=True).start()
        self.answered.set()
        return b"Starting program\n"

    def play_later(self):
        self.stopped.wait(30.0)
        with socket.create_connection((self.server.server_address[0], PORT_BEHIND)) as robot:
            answers = robot.makefile()
            answers.readline()
            robot.sendall(b"play\n")
            if answers.readline().startswith("Starting program"):
                self.began.set()


@contextlib.contextmanager
def robot_with_program(handler, addresses, processes):
    """Yields a client and the simulator, with a loaded program that moves the arm for some seconds."""
    with robot_behind(handler, addresses, processes, "played", "restart_program:=false",
                      "plugins:=[move_j,stop,dashboard/stop,dashboard/play]") as (client, simulator):
        client.send(DashboardCommand, "dashboard/stop").succeeded()
        simulator.control("store_program", name="moves.urp", script=f"movej({home_plus(3.0)}, a=1, v=0.2)", load=True)
        yield client, simulator


def start_play(client, reached, **fields):
    """Returns the goal when the proxy has got as far as `reached`."""
    play = client.send(DashboardCommand, "dashboard/play", **fields)
    assert reached.wait(10.0)
    return play


def check_that_nothing_moves_again(simulator):
    wait_for(lambda: simulator.state()["program"]["state"] == "STOPPED", 5.0, "the end of the program")
    simulator.wait(0.2)
    assert simulator.state()["program"]["state"] == "STOPPED" and simulator.is_at_rest()


@pytest.mark.parametrize("is_canceled, action, name", [
    (False, Stop, "stop"), (False, DashboardCommand, "dashboard/stop"),
    (True, Stop, "stop"), (True, DashboardCommand, "dashboard/stop"), (True, None, "")])
def test_a_stop_outlasts_a_play_that_was_sent_before(addresses, processes, is_canceled, action, name):
    HoldsPlay.arm()
    with robot_with_program(HoldsPlay, addresses, processes) as (client, simulator):
        play = start_play(client, HoldsPlay.holding)
        if is_canceled:
            play.cancel()
        stop = client.send(action, name) if action else None
        assert stop is None or stop.accepted
        HoldsPlay.stopped.set()
        if stop:
            stop.succeeded()
            assert action is not Stop or simulator.is_at_rest()
        result = play.wait_for_result()[1]  # the stop may have ended the program before it was seen to play
        assert (result.success or result.error_code == ErrorCode.PREEMPTED) is not is_canceled, result.message
        check_that_nothing_moves_again(simulator)


def test_a_play_that_is_answered_after_the_stop_has_ended_is_ended(addresses, processes):
    HoldsPlay.arm(timeout=60.0)
    with robot_with_program(HoldsPlay, addresses, processes) as (client, simulator):
        play = start_play(client, HoldsPlay.holding)
        client.send(Stop, "stop").succeeded()
        HoldsPlay.stopped.set()
        assert play.wait_for_result()[1].error_code == ErrorCode.PREEMPTED
        check_that_nothing_moves_again(simulator)


def test_a_play_is_not_sent_after_a_stop_that_came_while_it_connected(addresses, processes):
    with robot_with_program(HoldsGreeting, addresses, processes) as (client, simulator):
        HoldsGreeting.arm()
        play = start_play(client, HoldsGreeting.holding)
        client.send(Stop, "stop").succeeded()
        HoldsGreeting.stopped.set()
        assert play.wait_for_result()[1].error_code == ErrorCode.PREEMPTED
        assert not HoldsGreeting.has_played
        check_that_nothing_moves_again(simulator)


def test_a_play_that_is_answered_late_succeeds(addresses, processes):
    HoldsPlay.arm(timeout=60.0)
    with robot_with_program(HoldsPlay, addresses, processes) as (client, simulator):
        play = start_play(client, HoldsPlay.holding)
        simulator.wait(3.0)
        HoldsPlay.stopped.set()
        play.succeeded()
        assert simulator.state()["program"]["state"] == "PLAYING"


@pytest.mark.parametrize("is_canceled", [False, True])
def test_a_program_that_begins_late_is_ended(addresses, processes, is_canceled):
    BeginsLate.arm()
    with robot_with_program(BeginsLate, addresses, processes) as (client, simulator):
        play = start_play(client, BeginsLate.answered)
        simulator.wait(LATE)
        stop = None if is_canceled else client.send(Stop, "stop")
        if is_canceled:
            play.cancel()
        assert stop is None or stop.accepted
        BeginsLate.stopped.set()
        if stop:
            stop.succeeded()
        assert BeginsLate.began.wait(10.0)
        assert play.wait_for_result()[1].error_code == (ErrorCode.CANCELED if is_canceled else ErrorCode.PREEMPTED)
        check_that_nothing_moves_again(simulator)


def test_a_program_that_begins_after_the_timeout_of_its_goal_is_ended(addresses, processes):
    BeginsLate.arm()
    with robot_with_program(BeginsLate, addresses, processes) as (client, simulator):
        play = start_play(client, BeginsLate.answered, timeout=0.5)
        simulator.wait(0.7)
        BeginsLate.stopped.set()
        assert play.wait_for_result()[1].error_code == ErrorCode.TIMEOUT
        assert BeginsLate.began.is_set()
        check_that_nothing_moves_again(simulator)
