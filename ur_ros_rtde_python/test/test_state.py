"""Reads the state of the robot: attributes, streams and recordings."""

import itertools
import sys
import threading
import time

import numpy as np
import pytest
from support import HOME, TIMEOUT_FACTOR, wait_for
from ur_ros_rtde import NoDriver, Robot, RobotError, read_recording
from ur_ros_rtde.conversions import interface

PLUGINS = "plugins:=[move_j,stop]"
AWAY = [0.5, *HOME[1:]]
NOISE = 2e-4  # rad, more than that of the joint positions


def test_the_attributes_are_those_of_the_robot(arm, simulator):
    actual = simulator.state()["actual"]
    state = arm.state
    assert np.allclose(state.joint_positions, actual["position"], atol=1e-3)
    assert np.abs(state.joint_velocities).max() < 0.01 and np.abs(state.joint_efforts).max() > 1.0
    assert state.tcp_pose.shape == (7,) and np.linalg.norm(state.tcp_pose[3:]) == pytest.approx(1.0)
    assert state.wrench.shape == (6,) and np.abs(state.wrench).max() < 5.0
    assert (state.robot_mode, state.safety_mode, state.driver_state, state.driver_message) == ("RUNNING", "NORMAL", "READY", "")
    assert state.program_running is True and state.speed_scaling == pytest.approx(1.0)
    assert state.digital_inputs.shape == state.digital_outputs.shape == (18,) and state.analog_inputs.shape == (2,)


def test_the_attributes_follow_the_robot(arm, simulator):
    simulator.control("speed_slider", fraction=0.5)
    try:
        assert arm.state.wait_until(lambda state: state.speed_scaling == pytest.approx(0.5), 20.0)
    finally:
        simulator.control("speed_slider", fraction=1.0)


def test_a_stream_has_all_fields_of_each_cycle_and_ends(arm):
    with arm.start.move_j(AWAY, 0.5):
        samples = list(arm.state.stream("joint_positions", "joint_velocities", "tcp_pose", duration=0.5))
    times = np.array([sample.time for sample in samples])
    angles = np.array([sample.joint_positions[0] for sample in samples])
    assert len(samples) > 50 and np.all(np.diff(times) > 0.0) and times[-1] - times[0] <= 0.5
    assert np.all(np.diff(angles) >= -NOISE) and angles[-1] > angles[0]
    assert samples[0].joint_velocities.shape == (6,) and samples[0].tcp_pose.shape == (7,)
    # The joint and the TCP turn around the same axis, so they belong to the same cycle.
    turned = np.unwrap([np.arctan2(sample.tcp_pose[1], sample.tcp_pose[0]) for sample in samples])
    assert np.allclose(turned - turned[0], angles - angles[0], atol=NOISE)


def test_a_stream_has_the_joints_of_the_robot_not_those_of_the_twin(arm):
    service = "std_srvs/srv/SetBool"
    arm._connection.call(service, "publish_fake_joint_states", data=True)
    node, kind = arm._connection.node, interface("sensor_msgs/msg/JointState")
    publisher = node.create_publisher(kind, "fake_joint_states", 10)
    try:
        shown = []
        subscription = arm._connection.subscribe("sensor_msgs/msg/JointState", "joint_states", shown.append)

        def is_shown():
            publisher.publish(kind(name=arm.state.joint_names, position=[1.0] * 6))
            return shown and shown[-1].position[0] == 1.0

        wait_for(is_shown, 20.0, "the twin")
        sample = next(arm.state.stream("joint_positions", duration=10.0))
        assert np.allclose(sample.joint_positions, arm.state.joint_positions, atol=1e-3)
    finally:
        arm._connection.unsubscribe(subscription)
        arm._connection.call(service, "publish_fake_joint_states", data=False)
        node.destroy_publisher(publisher)


def test_a_slow_loop_gets_the_newest_samples(arm):
    delays = []
    for sample in arm.state.stream("joint_positions", duration=1.5, newest=True):
        delays.append(time.time() - sample.time)
        time.sleep(0.05)  # a slow loop, while 25 samples come
    assert len(delays) > 5 and np.median(delays) < 0.3


def test_a_stream_that_is_kept_does_not_grow_after_its_end(arm):
    stream = arm.state.stream("joint_positions", duration=0.2)
    first = next(stream)
    assert arm.state.wait_until(lambda state: time.time() > first.time + 1.0, 20.0)
    rest = list(stream)
    assert all(sample.time <= first.time + 0.2 for sample in rest) and len(rest) <= 101


def test_a_stream_can_be_left_early(arm):
    for sample in arm.state.stream("wrench", duration=60.0):
        assert sample.wrench.shape == (6,)
        break
    assert arm.state.joint_positions.shape == (6,)


def test_a_stream_goes_on_after_a_pause_that_is_shorter_than_the_timeout():
    with Robot("paused", timeout=TIMEOUT_FACTOR * 20.0) as robot:
        kind, seconds, ended = interface("sensor_msgs/msg/JointState"), itertools.count(1), threading.Event()
        publisher = robot._connection.node.create_publisher(kind, "actual_joint_states", 10)

        def publish():
            message = kind(position=[0.0] * 6)
            message.header.stamp.sec = next(seconds)
            publisher.publish(message)
            return message.header.stamp.sec

        def publish_until_the_end():
            while not ended.wait(0.05):
                publish()

        publishing = threading.Thread(target=publish_until_the_end)
        publishing.start()
        stream = robot.state.stream("joint_positions", duration=1e6)
        next(stream)
        ended.set()
        publishing.join()
        last = publish()
        assert any(sample.time == last for sample in stream)
        threading.Timer(3.0, publish).start()
        assert next(stream).time == last + 1


def test_an_unknown_field_of_a_stream_is_reported_with_the_known_ones(arm):
    with pytest.raises(ValueError, match="there is no field torque; the fields are: joint_positions"):
        arm.state.stream("torque", duration=1.0)


def test_a_recording_is_a_structured_array(arm, tmp_path):
    with arm.record(tmp_path / "run.csv", ["timestamp", "actual_q", "runtime_state"]) as recording:
        arm.move_j(AWAY, speed=1.0)
    values = recording.read()
    assert len(values) == recording.rows > 50 and recording.lost == 0
    assert values.dtype.names == ("timestamp", "actual_q", "runtime_state") and values["actual_q"].shape == (len(values), 6)
    assert np.all(np.diff(values["timestamp"]) > 0.0) and values["actual_q"][-1, 0] == pytest.approx(0.5, abs=1e-2)
    assert np.array_equal(read_recording(recording.file), values)


def test_a_recording_ends_with_an_exception(arm, tmp_path):
    with pytest.raises(KeyError), arm.record(tmp_path / "first.csv"):
        raise KeyError
    with arm.record(tmp_path / "second.csv"):
        pass


def test_a_recording_that_cannot_be_started_raises_the_reason(arm, tmp_path):
    (tmp_path / "run.csv").write_text("")
    with pytest.raises(RobotError, match="exists already"), arm.record(tmp_path / "run.csv"):
        pass
    with pytest.raises(RobotError, match="actual_qq"), arm.record(tmp_path / "other.csv", ["actual_qq"]):
        pass


def test_a_table_for_pandas_has_the_columns_of_the_file(arm, tmp_path, monkeypatch):
    with arm.record(tmp_path / "run.csv") as recording:
        pass
    pandas = type("pandas", (), {"read_csv": staticmethod(lambda file: ("table of", file))})
    monkeypatch.setitem(sys.modules, "pandas", pandas)
    assert recording.to_pandas() == ("table of", recording.file)


@pytest.mark.parametrize("read", [lambda state: state.joint_positions, lambda state: state.robot_mode,
                                  lambda state: list(state.stream("tcp_pose", duration=1.0))])
def test_a_missing_driver_is_reported(read):
    with Robot("nobody", timeout=0.3) as nobody, pytest.raises(NoDriver, match="start the driver"):
        read(nobody.state)


def test_the_mode_follows_the_robot(arm, simulator):
    simulator.control("power", to="off")
    try:
        assert arm.state.wait_until(lambda state: state.robot_mode == "POWER_OFF", 20.0)
    finally:
        simulator.control("power", to="running")


def test_a_lost_controller_is_reported_with_the_reason(lost_robot):
    with lost_robot("lost") as (robot, _driver, simulator):
        assert robot.state.joint_positions.shape == (6,)
        simulator.kill()
        assert robot.state.wait_until(lambda state: state.robot_mode == "NO_CONTROLLER", TIMEOUT_FACTOR * 20.0)
        with pytest.raises(RobotError, match="connection"):
            _ = robot.state.joint_positions
