"""Streams of setpoints: the arm follows a loop of the program, and decelerates however the loop ends."""

import pickle
import signal
import sys
import threading
import time

import numpy as np
import pytest
from programs import Process
from support import HOME, TIMEOUT_FACTOR, wait_for
from trajectories import TargetRecorder
from ur_ros_rtde import NoDriver, Rejected, Robot, RobotError, StreamEnded, pose, teleoperation

PLUGINS = "plugins:=[move_j,stop,make_ready]"
# The pauses of a busy host are shorter, and the program on the robot outlasts them.
DRIVER_PARAMETERS = ["stream_timeout:=0.5", "watchdog_frequency:=1.0"]
AWAY = [1.0, *HOME[1:]]
SLOW = 0.2  # rad/s: takes 5 s to AWAY
UP = [0.0, 0.0, 0.05, 0.0, 0.0, 0.0]


def moves(simulator):
    return max(map(abs, simulator.state()["target"]["velocity"])) > 0.01


def send_until(stream, condition, setpoint=UP, limit=15.0):
    """Sends a setpoint, or those that a function returns, until the condition is met."""
    def is_met():
        stream.send(setpoint() if callable(setpoint) else setpoint)
        return condition()

    wait_for(is_met, limit, "the condition of the stream")


def send_until_the_end(stream, setpoint=UP):
    """Returns the error of send()."""
    with pytest.raises(StreamEnded) as ended:
        send_until(stream, lambda: False, setpoint)
    return ended.value


def hang(simulator):
    wait_for(lambda: not moves(simulator), 10.0, "the arm to decelerate")


def does_not_move_again(simulator, stream):
    hang(simulator)
    recorder = TargetRecorder(simulator)
    for _ in range(20):
        with pytest.raises(StreamEnded):
            stream.send(UP)
    simulator.wait(0.5)
    return recorder.update().max_tcp_speed() == 0.0


def is_free(arm):
    """Returns whether the arm is at rest and accepts a goal at once."""
    return arm.move_j(HOME, speed=3.0, acceleration=15.0).success


@pytest.mark.parametrize("frame_id, sign", [("base", 1.0), ("tool0_controller", -1.0)])
def test_the_tcp_follows_twists_and_is_at_rest_after_the_block(arm, simulator, frame_id, sign):
    start = arm.state.tcp_pose
    with arm.stream.twist(frame_id) as stream:
        send_until(stream, lambda: sign * (arm.state.tcp_pose[2] - start[2]) > 0.02)
    assert simulator.is_at_rest() and np.allclose(arm.state.tcp_pose[:2], start[:2], atol=3e-3)
    assert is_free(arm)


def test_the_arm_follows_joint_positions(arm, simulator):
    begin = time.monotonic()
    with arm.stream.joints() as stream:
        send_until(stream, lambda: arm.state.joint_positions[0] > 0.095,
                   lambda: HOME + np.array([min(0.1, 0.1 * (time.monotonic() - begin)), 0, 0, 0, 0, 0]))
    assert simulator.is_at_rest() and arm.state.joint_positions[0] == pytest.approx(0.1, abs=0.005)
    assert is_free(arm)


def shifted(start, y):
    return start[:3] + [0.0, y, 0.0]


POSES = {"pose": lambda start, y: pose(shifted(start, y), start[3:]), "position": shifted,
         "mapping": lambda start, y: {"position": shifted(start, y)}}


@pytest.mark.parametrize("form", POSES.values(), ids=POSES)
def test_the_tcp_follows_poses_and_a_position_keeps_the_orientation(arm, form):
    start, begin = arm.state.tcp_pose, time.monotonic()
    with arm.stream.pose() as stream:
        send_until(stream, lambda: arm.state.tcp_pose[1] - start[1] > 0.045,
                   lambda: form(start, min(0.05, 0.05 * (time.monotonic() - begin))))
    assert np.allclose(arm.state.tcp_pose, pose(shifted(start, 0.05), start[3:]), atol=5e-3)


def test_the_arm_stays_at_rest_until_the_first_setpoint(arm, simulator):
    recorder = TargetRecorder(simulator)
    for stream in (arm.stream.joints(), arm.stream.pose(), arm.stream.twist()):
        with stream:
            pass
    assert recorder.update().max_joint_speed() < 0.01
    assert is_free(arm)


def test_streams_can_follow_each_other(arm):
    for _ in range(3):
        with arm.stream.twist() as stream:
            send_until(stream, lambda: np.abs(arm.state.joint_velocities).max() > 0.01)


def test_a_loop_that_hangs_decelerates_the_arm_and_the_next_setpoint_raises(arm, simulator):
    with pytest.raises(StreamEnded), arm.stream.twist() as stream:
        send_until(stream, lambda: moves(simulator))
        hang(simulator)
        with pytest.raises(StreamEnded, match="no setpoint was sent|no message was received") as ended:
            stream.send(UP)
        assert ended.value.name == "TIMEOUT"
        assert does_not_move_again(simulator, stream)
    assert is_free(arm)


def test_a_late_setpoint_is_not_published_even_if_the_driver_has_not_reported_the_end(arm, monkeypatch):
    with pytest.raises(StreamEnded), arm.stream.twist() as stream:
        published = record_published(monkeypatch)
        stream._session._published_at -= 1.0  # a loop that was suspended together with the node
        with pytest.raises(StreamEnded, match=r"no setpoint was sent for .* at most 0.5 s are allowed \(stream_timeout\)"):
            stream.send(UP)
        assert not published
    assert is_free(arm)


def test_a_stream_that_has_ended_is_reported_at_the_end_of_the_block(arm, simulator):
    with pytest.raises(StreamEnded, match="stream.twist: no "), arm.stream.twist() as stream:
        send_until(stream, lambda: moves(simulator))
        hang(simulator)


def test_a_stop_ends_the_stream(arm, simulator):
    with pytest.raises(StreamEnded), arm.stream.twist() as stream:
        send_until(stream, lambda: moves(simulator))
        arm.start.stop()
        error = send_until_the_end(stream)
        assert error.name == "PREEMPTED" and "stop" in error.message, error
        assert does_not_move_again(simulator, stream)
    with arm.stream.twist() as stream:
        send_until(stream, lambda: moves(simulator))


def test_a_protective_stop_ends_the_stream_and_prevents_the_next_one(arm, simulator):
    with pytest.raises(StreamEnded), arm.stream.twist() as stream:
        send_until(stream, lambda: moves(simulator))
        simulator.control("protective_stop", reason="of the test")
        error = send_until_the_end(stream)
        assert error.name == "PROTECTIVE_STOP" and "make_ready()" in error.remedy
    with pytest.raises(Rejected, match="protective stop"), arm.stream.twist():
        pytest.fail("the block was executed")
    arm.make_ready()
    with arm.stream.twist() as stream:
        send_until(stream, lambda: moves(simulator))


def test_a_setpoint_that_the_driver_does_not_accept_ends_the_stream(arm, simulator):
    with pytest.raises(StreamEnded), arm.stream.joints() as stream:
        error = send_until_the_end(stream, AWAY)
        assert error.name == "INVALID_GOAL" and "shoulder_pan_joint" in error.message
    with arm.stream.joints() as stream:  # without a pause
        stream.send(arm.state.joint_positions)
    assert is_free(arm)


def test_a_running_goal_prevents_the_stream_and_goes_on(arm):
    with arm.start.move_j(AWAY, SLOW) as goal:
        with pytest.raises(Rejected, match="move_j.* is running") as rejected, arm.stream.twist():
            pytest.fail("the block was executed")
        assert rejected.value.name == "BUSY" and "stop()" in rejected.value.remedy and not goal.is_finished
    assert is_free(arm)


def test_a_goal_is_rejected_in_the_block(arm, simulator):
    with arm.stream.twist() as stream:
        send_until(stream, lambda: moves(simulator))
        with pytest.raises(Rejected, match="/twist.* is running"):
            arm.move_j(HOME)
        stream.send(UP)


def test_two_programs_do_not_stream_at_the_same_time(arm, simulator):
    with Robot(timeout=TIMEOUT_FACTOR * 20.0) as other, arm.stream.twist() as stream:
        def open_another():
            try:
                with other.stream.twist():
                    errors.append(None)
            except Rejected as error:
                errors.append(error)

        errors = []
        thread = threading.Thread(target=open_another)
        thread.start()
        send_until(stream, lambda: errors and moves(simulator))
        thread.join()
        assert errors[0] and errors[0].name == "BUSY"


def record_published(monkeypatch):
    """Returns a list of the messages that are published from here on."""
    published, publish = [], teleoperation.Teleoperation._publish
    monkeypatch.setattr(teleoperation.Teleoperation, "_publish",
                        lambda self, message: published.append(message) or publish(self, message))
    return published


NAN = [0.0, float("nan"), 0.0, 0.0, 0.0, 0.0]


@pytest.mark.parametrize("kind, setpoint, field, text", [
    ("twist", NAN, "twist[1]", r"stream.twist: twist\[1\] is nan, it must be finite"),
    ("twist", [0.0] * 5, "twist", "expected a mapping of fields: linear, angular"),
    ("twist", {"lineal": [0.0] * 3}, "twist.lineal", "did you mean linear"),
    ("joints", NAN, "position[1]", r"stream.joints: position\[1\] is nan, it must be finite"),
    ("joints", HOME[:5], "position", "position has 5 values: expected a list of 6 numbers"),
    ("joints", [HOME], "position[0]", "expected a number"),
    ("joints", None, "position", "expected a list of numbers"),
    ("pose", [0.0, 0.0, float("inf")], "pose[2]", r"stream.pose: pose\[2\] is inf, it must be finite"),
    ("pose", [0.0] * 6, "pose", "expected a mapping of fields: position, orientation")])
def test_an_invalid_setpoint_is_not_published(arm, monkeypatch, kind, setpoint, field, text):
    with getattr(arm.stream, kind)() as stream:
        published = record_published(monkeypatch)
        with pytest.raises(Rejected, match=text) as rejected:
            stream.send(setpoint)
        assert rejected.value.field == field and rejected.value.name == "INVALID_GOAL" and not published


def test_an_unknown_frame_is_rejected(arm):
    with pytest.raises(Rejected, match="header.frame_id is \"camera\", it may be base or tool0_controller"), arm.stream.twist("camera"):
        pytest.fail("the block was executed")
    assert is_free(arm)


@pytest.mark.parametrize("error", [KeyError, KeyboardInterrupt])
def test_an_exception_stops_the_arm_before_it_propagates(arm, simulator, error, caplog):
    with pytest.raises(error), arm.stream.twist() as stream:
        send_until(stream, lambda: moves(simulator))
        raise error
    assert simulator.is_at_rest() and not caplog.text
    assert is_free(arm)


def test_an_interruption_of_the_start_ends_the_stream(arm, monkeypatch):
    def interrupt(self, message):
        publish(self, message)
        wait_for(lambda: self._state.has_started, 10.0, "teleoperation")
        raise KeyboardInterrupt

    publish = teleoperation.Teleoperation._publish
    with monkeypatch.context() as patch:
        patch.setattr(teleoperation.Teleoperation, "_publish", interrupt)
        with pytest.raises(KeyboardInterrupt), arm.stream.twist():
            pytest.fail("the block was executed")
    assert is_free(arm)


def test_an_interruption_of_the_end_is_raised_at_standstill(arm, simulator, monkeypatch):
    def interrupt(self, connection):
        monkeypatch.undo()
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt), arm.stream.twist() as stream:
        send_until(stream, lambda: moves(simulator))
        monkeypatch.setattr(teleoperation.Teleoperation, "_wait_for_end", interrupt)
    assert simulator.is_at_rest() and is_free(arm)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=["SIGINT", "SIGTERM"])
@pytest.mark.parametrize("init", ["", "rclpy.init()"], ids=["alone", "rclpy"])
def test_a_signal_stops_the_arm_before_the_block_ends(arm, simulator, init, number):
    """The handlers of rclpy.init() close the connection first. The program survives."""
    code = f"""
import time
import rclpy
from ur_ros_rtde import Robot
{init}
with Robot(timeout=20.0) as arm:
    try:
        with arm.stream.twist() as stream:
            while True:
                stream.send({UP})
                time.sleep(0.01)
    except BaseException as error:
        print("ended", type(error).__name__, flush=True)
        time.sleep(30.0)
"""
    program = Process([sys.executable, "-c", code])
    try:
        wait_for(lambda: moves(simulator), 30.0, f"the arm to move: {program.output()}")
        program.signal(number)
        program.wait_for_output("ended", 20.0)
        assert simulator.is_at_rest() and "not confirmed" not in program.output()
    finally:
        program.kill()


def test_closing_the_robot_ends_its_streams(arm, simulator):
    robot = Robot(timeout=TIMEOUT_FACTOR * 20.0)
    with robot.stream.twist() as stream:
        send_until(stream, lambda: moves(simulator))
        robot.close()
        assert simulator.is_at_rest() and is_free(arm)
        with pytest.raises(RobotError, match="the Robot is closed"):
            stream.send(UP)


def test_setpoints_outside_of_the_block_are_not_sent(arm):
    stream = arm.stream.twist()
    for _ in range(2):
        with pytest.raises(RobotError, match="stream.twist: the stream is closed"):
            stream.send(UP)
        with stream:
            pass


def test_the_error_reaches_another_process():
    copy = pickle.loads(pickle.dumps(StreamEnded("stream.twist", 6, "too late")))
    assert (copy.name, copy.message, str(copy)) == ("TIMEOUT", "too late", "stream.twist: too late (TIMEOUT)")


def test_a_missing_driver_is_reported():
    with Robot("nobody", timeout=0.5) as nobody, pytest.raises(NoDriver, match="start the driver"), nobody.stream.twist():
        pytest.fail("the block was executed")


def test_a_driver_that_ends_ends_the_stream(lost_robot):
    with lost_robot("ends") as (robot, driver, simulator):
        with pytest.raises(RobotError) as ended, robot.stream.twist() as stream:
            driver.interrupt()
            send_until(stream, lambda: False)
        assert isinstance(ended.value, NoDriver) or ended.value.name == "SHUTDOWN"
        assert simulator.is_at_rest()


def test_a_driver_that_is_killed_ends_the_stream(lost_robot):
    with lost_robot("killed") as (robot, driver, simulator):
        with pytest.raises(NoDriver, match="the driver has ended or is out of reach"), robot.stream.twist() as stream:
            driver.kill()
            send_until(stream, lambda: False, limit=60.0)
        wait_for(simulator.is_at_rest, 10.0, "the watchdog to stop the arm")
