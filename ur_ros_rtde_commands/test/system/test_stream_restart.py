"""Teleoperation after a stop, a gap in its messages, or a stall or restart of the driver: what moves the arm again, and what does not."""

import signal
import time

import pytest
from arm_state import get_joint_speed, get_joint_state, home_plus
from geometry_msgs.msg import TwistStamped
from programs import Simulator, start_node
from publisher import Publisher
from robot_fixtures import make_ready
from ros_client import Client
from sensor_msgs.msg import JointState
from streams import STREAM_PARAMETERS, TIMEOUT, joint_message, log_lines, pause, twist_message
from support import FEW_PLUGINS, wait_for
from trajectories import TargetRecorder

from ur_ros_rtde_msgs.action import Stop

MEASURES_TIME = True
PLUGINS = FEW_PLUGINS
DRIVER_PARAMETERS = STREAM_PARAMETERS

pytestmark = pytest.mark.usefixtures("no_active_teleoperation")


class Operator:
    """A publisher whose message the test changes: that of a person, or of a program that hangs and goes on."""

    def __init__(self, robot, driver, kind, topic, message):
        self._driver, self.topic, self.message = driver, topic, message
        self._publisher = Publisher(robot, kind, topic, lambda t: self.message and self.message(t))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._publisher.stop()

    def hangs_and_goes_on(self):
        """Returns as soon as the driver has reported that it ignores the messages after the gap."""
        message, self.message = self.message, None
        lines = f"/{self.topic}: messages are ignored: there was none"
        before = len(log_lines(self._driver, lines))
        pause()
        self.message = message
        wait_for(lambda: len(log_lines(self._driver, lines)) > before, 10.0, "the warning")

    def publishes(self, count):
        """Waits for further messages."""
        published = len(self._publisher.times)
        wait_for(lambda: len(self._publisher.times) >= published + count, 10.0, "messages")

    def does_not_move_the_arm(self, simulator):
        recorder = TargetRecorder(simulator)
        self.publishes(25)
        assert recorder.update().max_tcp_speed() == 0.0

    def moves_the_arm_only_after_a_zero_twist(self, simulator):
        self.does_not_move_the_arm(simulator)
        self.message = lambda t: twist_message("base")
        self.publishes(3)
        self.message = lambda t: twist_message("base", 0.05)
        wait_for(lambda: max(map(abs, simulator.state()["target"]["velocity"])) > 0.03, 10.0, "the arm to move again")


def test_stop_ends_control_by_a_topic_until_there_has_been_a_pause(robot):
    with Publisher(robot, TwistStamped, "twist", lambda t: twist_message("base", -0.05)):
        wait_for(lambda: get_joint_speed(robot) > 0.03, 10.0, "the arm to move")
        result = robot.send(Stop, "stop").succeeded()
        assert "/twist" in result.message
        time.sleep(3.0 * TIMEOUT)
        assert get_joint_speed(robot) < 0.01
    pause()
    with Publisher(robot, TwistStamped, "twist", lambda t: twist_message("base", 0.05)):
        wait_for(lambda: get_joint_speed(robot) > 0.03, 10.0, "the arm to move again")


def test_a_publisher_that_hung_during_a_motion_moves_the_arm_only_after_a_zero_twist(robot, driver, simulator):
    with Operator(robot, driver, TwistStamped, "twist", lambda t: twist_message("base", -0.05)) as operator:
        wait_for(lambda: get_joint_speed(robot) > 0.03, 10.0, "the arm to move")
        operator.hangs_and_goes_on()
        operator.moves_the_arm_only_after_a_zero_twist(simulator)


def test_a_gap_in_the_messages_does_not_undo_a_stop(robot, driver, simulator):
    with Operator(robot, driver, TwistStamped, "twist", lambda t: twist_message("base", -0.05)) as operator:
        wait_for(lambda: get_joint_speed(robot) > 0.03, 10.0, "the arm to move")
        robot.send(Stop, "stop").succeeded()
        operator.hangs_and_goes_on()
        operator.does_not_move_the_arm(simulator)


def test_a_stall_of_the_driver_does_not_undo_a_stop(robot, driver, simulator):
    """The operator, whose stick is at rest, has published all the time: for the driver alone there was a pause."""
    started = "/twist: teleoperation started"
    before = len(log_lines(driver, started))
    with Operator(robot, driver, TwistStamped, "twist", lambda t: twist_message("base")) as operator:
        wait_for(lambda: len(log_lines(driver, started)) > before, 10.0, "the session")
        robot.send(Stop, "stop").succeeded()
        driver.signal(signal.SIGSTOP)
        pause()
        driver.signal(signal.SIGCONT)
        operator.publishes(3)
        operator.message = lambda t: twist_message("base", -0.05)
        operator.does_not_move_the_arm(simulator)
        assert len(log_lines(driver, started)) == before + 1, "a session has begun after the stop"


def test_a_stall_of_the_driver_does_not_undo_the_end_of_a_session(robot, driver, simulator):
    started, ended = "/twist: teleoperation started", "/twist: messages are ignored: the control program"
    before = len(log_lines(driver, started)), len(log_lines(driver, ended))
    with Operator(robot, driver, TwistStamped, "twist", lambda t: twist_message("base")) as operator:
        wait_for(lambda: len(log_lines(driver, started)) > before[0], 10.0, "the session")
        simulator.control("pause_program")
        wait_for(lambda: len(log_lines(driver, ended)) > before[1], 10.0, "the end of the session")
        make_ready(robot)
        for _ in range(3):
            driver.signal(signal.SIGSTOP)
            pause()
            driver.signal(signal.SIGCONT)
            operator.publishes(3)
            make_ready(robot)
        operator.message = lambda t: twist_message("base", -0.05)
        operator.does_not_move_the_arm(simulator)


def test_a_stall_of_the_driver_does_not_undo_a_stop_of_two_publishers(robot, driver, simulator):
    """The first message after the stall may be of the other one than the last message before it."""
    def publisher():
        return Operator(robot, driver, TwistStamped, "twist", lambda t: twist_message("base", -0.05))

    ignored = "/twist: messages are ignored: their publisher"
    before = len(log_lines(driver, ignored))
    with publisher(), publisher() as operator:
        wait_for(lambda: get_joint_speed(robot) > 0.03, 10.0, "the arm to move")
        robot.send(Stop, "stop").succeeded()
        stalls = 5
        for _ in range(stalls):
            driver.signal(signal.SIGSTOP)
            pause()
            driver.signal(signal.SIGCONT)
            operator.does_not_move_the_arm(simulator)
    assert len(log_lines(driver, ignored)) - before <= stalls


def test_a_stream_that_was_there_before_the_driver_moves_the_arm_only_after_a_zero_twist(addresses, processes):
    simulator = processes(Simulator(addresses[1]))
    client = Client("restarted")

    def start():
        driver = processes(start_node("driver", simulator.address, FEW_PLUGINS, "ur_type:=ur10e", f"stream_timeout:={TIMEOUT}",
                                      namespace="restarted"))
        make_ready(client)
        return driver

    driver = start()
    try:
        with Operator(client, driver, TwistStamped, "twist", lambda t: twist_message("base", -0.05)) as operator:
            wait_for(lambda: max(map(abs, simulator.state()["target"]["velocity"])) > 0.03, 10.0, "the arm to move")
            driver.stop()
            driver = start()
            wait_for(lambda: log_lines(driver, "messages are ignored: their publisher may have been there before"), 10.0, "the warning")
            operator.moves_the_arm_only_after_a_zero_twist(simulator)
    finally:
        client.close()


def test_a_stop_ends_the_session_that_waits_for_the_end_of_the_one_before(addresses, processes):
    """Messages after a pause begin a session while the arm still decelerates at the end of the previous one."""
    simulator = processes(Simulator(addresses[1]))
    driver = processes(start_node("driver", simulator.address, FEW_PLUGINS, "ur_type:=ur10e", f"stream_timeout:={TIMEOUT}",
                                  "stream_deceleration:=0.1", namespace="waits"))
    client = Client("waits")
    try:
        make_ready(client)
        with Operator(client, driver, TwistStamped, "twist", lambda t: twist_message("base", -0.15)) as operator:
            wait_for(lambda: get_joint_speed(client) > 0.1, 10.0, "the arm to move")
            operator.message = None
            pause()
            operator.message = lambda t: twist_message("base")
            operator.publishes(3)
            operator.message = lambda t: twist_message("base", -0.15)
            operator.publishes(3)
            assert get_joint_speed(client) > 0.02, "the previous session has ended too early for this test"
            client.send(Stop, "stop").succeeded()
            operator.does_not_move_the_arm(simulator)
    finally:
        client.close()


def test_a_publisher_that_ended_its_motion_can_start_again_after_a_pause(robot, driver):
    with Operator(robot, driver, TwistStamped, "twist", lambda t: twist_message("base", -0.05)) as operator:
        wait_for(lambda: get_joint_speed(robot) > 0.03, 10.0, "the arm to move")
        operator.message = lambda t: twist_message("base")
        operator.publishes(3)
        operator.message = None
        pause()
        operator.message = lambda t: twist_message("base", 0.05)
        wait_for(lambda: get_joint_speed(robot) > 0.03, 10.0, "the arm to move again")


def test_a_publisher_that_hung_on_the_way_of_the_joints_starts_again_at_the_arm(robot, driver, simulator):
    with Operator(robot, driver, JointState, "servo_joint", lambda t: joint_message(home_plus(0.02 * t))) as operator:
        wait_for(lambda: get_joint_state(robot).position[0] > 0.01, 10.0, "the arm to move")
        operator.hangs_and_goes_on()
        recorder = TargetRecorder(simulator)
        operator.publishes(25)
        assert recorder.update().max_joint_speed() == 0.0
        positions = list(get_joint_state(robot).position)
        started = len(log_lines(driver, "/servo_joint: teleoperation started"))
        operator.message = lambda t: joint_message(positions)
        wait_for(lambda: len(log_lines(driver, "/servo_joint: teleoperation started")) > started, 10.0, "teleoperation to start")


def test_a_protective_stop_ends_control_by_a_topic_without_resuming_it(robot, simulator):
    with Publisher(robot, TwistStamped, "twist", lambda t: twist_message("base", -0.05)):
        wait_for(lambda: get_joint_speed(robot) > 0.03, 10.0, "the arm to move")
        simulator.control("protective_stop", reason="a test")
        wait_for(lambda: get_joint_speed(robot) < 0.01, 15.0, "standstill")
        wait_for(simulator.unlock_protective_stop, 10.0, "the protective stop to be unlocked")
        wait_for(lambda: simulator.state()["program"]["state"] == "PLAYING", 10.0, "the control program to be restarted")
        time.sleep(0.5)
        assert get_joint_speed(robot) < 0.01
