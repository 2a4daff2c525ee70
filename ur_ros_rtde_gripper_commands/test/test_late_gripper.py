"""Robotiq grippers that react late, and a URCap whose answers are late."""

import socketserver
import threading
import time

import pytest
from action_msgs.msg import GoalStatus
from support import wait_for
from ur_ros_rtde_gripper_commands.action import RobotiqGrip

from ur_ros_rtde_msgs.msg import ErrorCode

PLUGINS = "plugins:=[move_j,stop,robotiq_open,robotiq_close]"
PORT = 63352
SIMULATOR_ARGUMENTS = ("--ports", "robotiq=0")  # leaves PORT to the URCap of the test
REACTION = 0.2  # s, from GTO 1 to the registers that show the motion
MOTION = 0.2  # s


class Urcap(socketserver.ThreadingTCPServer):
    """The socket server of the URCap, with a gripper that holds an object since the motion before."""

    allow_reuse_address = daemon_threads = True

    def __init__(self, address):
        super().__init__((address, PORT), Session)
        self.registers = {"STA": 3, "OBJ": 2, "FLT": 0, "POS": 120, "GTO": 1, "PRE": 255, "SPE": 255, "FOR": 0}
        self.requests = []
        self.answers_pre = threading.Event()
        self.answers_pre.set()
        self.began = None
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def value(self, name):
        if name == "PRE":
            self.answers_pre.wait(20.0)
        if self.began is not None and name in ("OBJ", "POS"):
            since = time.monotonic() - self.began
            if since > REACTION + MOTION:
                self.registers.update(OBJ=3, POS=self.registers["PRE"])
            elif since > REACTION:
                self.registers["OBJ"] = 0
        return self.registers[name]

    def assign(self, text):
        self.requests.append(text)
        words = text.split()
        for name, value in zip(words[::2], words[1::2]):
            self.registers["PRE" if name == "POS" else name] = int(value)
        if "GTO 1" in text:
            self.began = time.monotonic()


class Session(socketserver.StreamRequestHandler):
    def handle(self):
        for line in self.rfile:
            verb, _, text = line.decode().strip().partition(" ")
            if verb == "SET":
                self.server.assign(text)
                self.wfile.write(b"ack")
            else:
                self.wfile.write(f"{text} {self.server.value(text)}\n".encode())
            self.wfile.flush()


@pytest.fixture
def urcap(simulator, robot):
    with Urcap(simulator.address) as server:
        yield server
        server.answers_pre.set()
        server.shutdown()


def test_the_contact_of_the_motion_before_is_not_the_end_of_this_one(urcap, robot):
    result = robot.send(RobotiqGrip, "robotiq_open").succeeded(20.0)
    assert result.position == 0 and not result.object_detected


def test_a_cancel_while_the_gripper_answers_is_not_followed_by_a_motion(urcap, robot):
    urcap.answers_pre.clear()
    goal = robot.send(RobotiqGrip, "robotiq_open")
    wait_for(lambda: urcap.requests, 10.0, "the target")
    goal.cancel()
    urcap.answers_pre.set()
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_CANCELED and result.error_code == ErrorCode.CANCELED, result.message
    assert urcap.requests == ["GTO 0 POS 0 SPE 255 FOR 128", "GTO 0"]


@pytest.fixture
def abandoned(urcap, robot):
    """A canceled goal still waits for an answer, after its result."""
    urcap.answers_pre.clear()
    goal = robot.send(RobotiqGrip, "robotiq_open")
    wait_for(lambda: urcap.requests, 10.0, "the target")
    goal.cancel()
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_CANCELED and "did not return" in result.message, result.message
    del urcap.requests[:]


def test_an_abandoned_goal_stops_the_fingers_when_the_gripper_answers(urcap, abandoned):
    urcap.answers_pre.set()
    wait_for(lambda: urcap.requests, 10.0, "the stop")
    assert urcap.requests == ["GTO 0"]


def test_an_abandoned_goal_does_not_disturb_the_next_one(urcap, abandoned, robot):
    target = "GTO 0 POS 255 SPE 255 FOR 128"
    goal = robot.send(RobotiqGrip, "robotiq_close")
    wait_for(lambda: urcap.requests == [target], 10.0, "the target of the next goal")
    urcap.answers_pre.set()
    goal.succeeded(20.0)
    assert urcap.requests == [target, "GTO 1"]
