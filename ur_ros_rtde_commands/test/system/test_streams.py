"""The teleoperation topics servo_joint, servo_pose and twist."""

import math
import re
import time

import pytest
from arm_state import get_joint_speed, get_joint_state, get_tcp_pose, home_plus
from geometry_msgs.msg import PoseStamped, TwistStamped
from programs import Simulator, start_node
from publisher import Publisher
from robot_fixtures import make_ready
from ros_client import Client
from sensor_msgs.msg import JointState
from streams import STREAM_PARAMETERS, TIMEOUT, joint_message, log_lines, pause, twist_message
from support import FEW_PLUGINS, HOME, JOINTS, REAL_TIME_FACTOR, seconds, wait_for
from trajectories import TargetRecorder

from ur_ros_rtde_msgs.action import ForceMode, MoveJ, Stop
from ur_ros_rtde_msgs.msg import ActiveModes, ErrorCode, TeleoperationState
from ur_ros_rtde_msgs.srv import GetJointState

MEASURES_TIME = True
PLUGINS = FEW_PLUGINS
DRIVER_PARAMETERS = STREAM_PARAMETERS
PERIOD = 20_000_000  # ns of the host's time, of messages at 50 Hz
PERIODS_AHEAD = 1.5  # of the messages, in which the driver moves to a new target; it waits there for a later message
CYCLE = 2_000_000 / REAL_TIME_FACTOR  # ns of the host's time

pytestmark = pytest.mark.usefixtures("no_active_teleoperation")


def swing(t):
    """Moves by 0.3 rad and back in 4 s, from rest to rest, with at most 0.24 rad/s and 0.37 rad/s^2."""
    return 0.15 * (1.0 - math.cos(2.0 * math.pi * min(t, 4.0) / 4.0))


def is_regular(recorder, publish_times, first, last):
    """Returns whether publisher, driver and simulator were on time, from 0.1 s before this window of cycles to its end. The driver was
    not where it waited at its target for a message."""
    begin = first - 50
    if begin not in recorder.published or recorder.gaps(4, begin, last) or not recorder.held.isdisjoint(range(begin, last + 1)):
        return False
    span = recorder.published[last] - recorder.published[begin]
    around = [when for when in publish_times if recorder.published[begin] - PERIOD < when < recorder.published[last] + PERIOD]
    return (abs(span - (last - begin) * CYCLE) < 0.1 * span and len(around) > 1
            and max(after - before for before, after in zip(around, around[1:])) < PERIODS_AHEAD * PERIOD)


def measure_accelerations(robot, simulator):
    """Moves the base joint by messages at 50 Hz.

    Returns whether the joint has followed to the end, which it has not if the messages were interrupted for longer than the timeout,
    and its accelerations over 50 ms in rad/s^2 where the host was on time."""
    make_ready(robot)
    recorder = TargetRecorder(simulator)
    with Publisher(robot, JointState, "servo_joint", lambda t: joint_message(home_plus(swing(REAL_TIME_FACTOR * t)))) as publisher:
        publisher.join(4.5 / REAL_TIME_FACTOR)
    recorder.update()
    traveled = 0.002 * sum(recorder.joint_speeds.values())
    has_followed = abs(get_joint_state(robot).position[0]) < 0.02 and traveled == pytest.approx(0.6, abs=0.02)
    pause()
    speeds, window = recorder.joint_speeds, 25
    return has_followed, [abs(speeds[cycle + window] - speeds[cycle]) / (0.002 * window) for cycle in list(speeds)[:-window:5]
                          if speeds[cycle] > 0.02 and is_regular(recorder, publisher.times, cycle, cycle + window)]


def test_servo_joint_at_50_hz_moves_smoothly(robot, simulator):
    has_followed, accelerations = False, []
    for _ in range(8):
        followed, measured = measure_accelerations(robot, simulator)
        has_followed, accelerations = has_followed or followed, accelerations + measured
        if has_followed and len(accelerations) > 100:
            break
    assert has_followed and len(accelerations) > 100, "the messages were late, or the driver waits for each, nearly all the time"
    assert max(accelerations) < 3.0 * 0.37  # a target held constant between messages would cause ten times higher values


def test_servo_joint_accepts_any_order_and_ignores_other_joints(robot):
    names = [*reversed(JOINTS), "finger_joint"]
    target = home_plus(0.0, 0.0, 0.0, 0.0, 0.0, 0.1)
    values = [*reversed(target), 0.3]

    def ramp(t):
        return [h + min(t / 0.5, 1.0) * (v - h) for h, v in zip([*reversed(HOME), 0.3], values)]

    with Publisher(robot, JointState, "servo_joint", lambda t: joint_message(ramp(t), names)):
        wait_for(lambda: list(get_joint_state(robot).position) == pytest.approx(target, abs=0.005), 15.0, "the arm to reach the target")


def test_the_arm_decelerates_after_the_timeout_of_a_topic(robot, simulator):
    recorder = TargetRecorder(simulator)
    publisher = Publisher(robot, TwistStamped, "twist", lambda t: twist_message("base", -0.1), rate=100.0)
    wait_for(lambda: recorder.update().max_tcp_speed() > 0.095, 10.0, "the arm to move")
    publisher.stop()
    last = simulator.state()["cycle"]
    wait_for(lambda: recorder.update() and simulator.is_at_rest(), 10.0, "standstill")
    recorder.update()
    # Each cycle has at most one setpoint, even if the host is late.
    assert recorder.cycles_with_setpoint(last) < 500.0 * (TIMEOUT + 0.25), "the motion continued after the timeout"
    full = max(cycle for cycle, speed in recorder.tcp_speeds.items() if speed > 0.09)
    rest = next(cycle for cycle, speed in recorder.tcp_speeds.items() if cycle > full and speed < 0.01)
    assert 500.0 * 0.02 < rest - full < 500.0 * 0.1, "50 ms from 0.1 m/s at 2 m/s^2"
    pause()
    robot.send(MoveJ, "move_j", joint_positions=HOME, speed=1.0).succeeded()


def test_a_twist_is_followed_before_the_arm_has_reached_the_one_before(robot, simulator):
    is_released = []

    def speed():
        return math.hypot(*simulator.state()["target_tcp_speed"][:3])

    with Publisher(robot, TwistStamped, "twist", lambda t: twist_message("base", 0.0 if is_released else -0.3), rate=100.0):
        wait_for(lambda: speed() > 0.03, 15.0, "the arm to move")
        is_released.append(True)
        recorder = TargetRecorder(simulator)
        wait_for(lambda: recorder.update() and speed() < 0.005, 10.0, "the arm to brake")
    assert recorder.max_tcp_speed() < 0.25, "0.3 m/s take 0.3 s at 1 m/s^2 (stream_acceleration)"


@pytest.mark.parametrize("frame, sign", [("base", 1.0), ("tool0_controller", -1.0)])
def test_twist_moves_along_the_axes_of_its_frame(robot, frame, sign):
    start = get_tcp_pose(robot).position
    with Publisher(robot, TwistStamped, "twist", lambda t: twist_message(frame, 0.05)):
        wait_for(lambda: abs(get_tcp_pose(robot).position.z - start.z) > 0.03, 15.0, "the TCP to move")
    end = get_tcp_pose(robot).position
    assert sign * (end.z - start.z) > 0.02 and math.hypot(end.x - start.x, end.y - start.y) < 0.003


def test_servo_pose_follows_a_line(robot):
    start = get_tcp_pose(robot)

    def message(t):
        target = PoseStamped()
        target.header.frame_id = "base"
        target.pose.orientation = start.orientation
        for axis in "xyz":
            setattr(target.pose.position, axis, getattr(start.position, axis))
        target.pose.position.y += 0.1 * min(t, 1.5) / 1.5
        return target

    with Publisher(robot, PoseStamped, "servo_pose", message):
        wait_for(lambda: get_tcp_pose(robot).position.y - start.position.y == pytest.approx(0.1, abs=0.003), 6.0, "the pose")
    end = get_tcp_pose(robot).position
    assert (end.x, end.z) == pytest.approx((start.position.x, start.position.z), abs=0.003)


def test_a_goal_is_rejected_while_a_topic_controls_the_arm_and_accepted_afterwards(robot):
    start = get_tcp_pose(robot).position
    with Publisher(robot, TwistStamped, "twist", lambda t: twist_message("base", 0.05)):
        wait_for(lambda: abs(get_tcp_pose(robot).position.z - start.z) > 0.005, 15.0, "the topic to move the arm")
        goal = robot.send(MoveJ, "move_j", joint_positions=HOME)
        assert not goal.accepted
        rejection = robot.rejection(goal)
        assert rejection.error_code == ErrorCode.BUSY and "/twist" in rejection.message, rejection

    def accepted():
        goal = robot.send(MoveJ, "move_j", joint_positions=HOME)
        return goal.accepted and goal

    wait_for(accepted, 10.0, "the end of the session").succeeded()


def test_messages_are_ignored_while_a_goal_moves_the_arm(robot, driver):
    goal = robot.send(MoveJ, "move_j", joint_positions=home_plus(0.8), speed=0.4)
    wait_for(lambda: get_joint_speed(robot) > 0.1, 10.0, "the arm to move")
    before = len(log_lines(driver, "/twist: messages are ignored"))
    with Publisher(robot, TwistStamped, "twist", lambda t: twist_message("base", 0.1)):
        goal.succeeded()
        assert list(get_joint_state(robot).position) == pytest.approx(home_plus(0.8), abs=0.005)
        time.sleep(0.5)
        assert get_joint_speed(robot) < 0.01, "a topic must not take control without a pause"
    assert len(log_lines(driver, "/twist: messages are ignored")) == before + 1, "logged once"


def test_messages_are_ignored_while_another_topic_controls_the_arm(robot, driver):
    sessions = len(log_lines(driver, "/twist: teleoperation started"))
    with Publisher(robot, TwistStamped, "twist", lambda t: twist_message("base")):
        wait_for(lambda: len(log_lines(driver, "/twist: teleoperation started")) > sessions, 15.0, "the session")
        before = len(log_lines(driver, "/servo_joint: messages are ignored"))
        with Publisher(robot, JointState, "servo_joint", lambda t: joint_message(home_plus(min(0.2, 0.2 * t)))):
            wait_for(lambda: len(log_lines(driver, "/servo_joint: messages are ignored")) > before, 15.0, "the warning")
            time.sleep(0.5)
        assert "/twist is running" in log_lines(driver, "/servo_joint: messages are ignored")[-1]
    assert get_joint_state(robot).position[0] == pytest.approx(0.0, abs=0.01)


def test_with_on_busy_preempt_a_goal_preempts_a_topic(addresses, processes):
    simulator = processes(Simulator(addresses[1]))
    processes(start_node("driver", simulator.address, FEW_PLUGINS, "ur_type:=ur10e", "on_busy:=preempt",
                         f"stream_timeout:={TIMEOUT}", namespace="other"))
    client = Client("other")
    try:
        make_ready(client)
        with Publisher(client, TwistStamped, "twist", lambda t: twist_message("base", -0.05)):
            wait_for(lambda: max(map(abs, simulator.state()["actual"]["velocity"])) > 0.03, 10.0, "the arm to move")
            client.send(MoveJ, "move_j", joint_positions=home_plus(0.3), speed=1.0).succeeded()
            time.sleep(0.5)
            assert simulator.state()["actual"]["position"] == pytest.approx(home_plus(0.3), abs=0.01)
    finally:
        client.close()


def test_the_end_of_the_messages_leaves_force_mode_on_and_an_invalid_one_ends_it(addresses, processes):
    simulator = processes(Simulator(addresses[1]))
    simulator.control("set_sensor_noise", force=0.0)  # each program zeroes the sensor amid its noise: the compliant arm would creep
    processes(start_node("driver", simulator.address, "plugins:=[move_j,stop,force_mode_start]", "ur_type:=ur10e",
                         f"stream_timeout:={TIMEOUT}", namespace="pressing"))
    client = Client("pressing")
    active = client.subscribe(ActiveModes, "active_modes", transient_local=True)
    try:
        make_ready(client)
        client.send(ForceMode, "force_mode_start", compliant=[True, False, False, False, False, False]).succeeded()
        wait_for(lambda: active and "force_mode" in active[-1].names, 10.0, "force mode")
        with Publisher(client, TwistStamped, "twist", lambda t: twist_message("base", 0.02), duration=1.0):
            wait_for(lambda: get_joint_speed(client) > 0.005, 10.0, "the arm to move")
        wait_for(lambda: get_joint_speed(client) < 0.001, 10.0, "the end of teleoperation")
        pause()
        assert "force_mode" in active[-1].names, "as after a motion that succeeds"
        with Publisher(client, TwistStamped, "twist", lambda t: twist_message("base", 0.02 if t < 1.0 else 3.5)):
            wait_for(lambda: "force_mode" not in active[-1].names, 15.0, "the end of force mode")
    finally:
        client.close()


INVALID_MESSAGES = [
    ("a jump", JointState, "servo_joint", lambda t: joint_message(home_plus(0.5 if t > 0.5 else 0.0)), "shoulder_pan_joint"),
    ("a missing joint", JointState, "servo_joint", lambda t: joint_message(HOME[:5], JOINTS[:5]), "wrist_3_joint"),
    ("NaN", JointState, "servo_joint", lambda t: joint_message(home_plus(math.nan if t > 0.5 else 0.0)), "nan"),
    ("a frame", TwistStamped, "twist", lambda t: twist_message("camera"), "camera"),
    ("too fast", TwistStamped, "twist", lambda t: twist_message("base", 3.5 if t > 0.5 else 0.0), "3.5"),
]


@pytest.mark.parametrize("kind, topic, message, text", [case[1:] for case in INVALID_MESSAGES],
                         ids=[case[0] for case in INVALID_MESSAGES])
def test_an_invalid_message_ends_control_by_the_topic_and_is_logged_once(robot, driver, kind, topic, message, text):
    warning = f"/{topic}: messages are ignored"
    before = len(log_lines(driver, warning))
    with Publisher(robot, kind, topic, message):
        wait_for(lambda: len(log_lines(driver, warning)) > before, 15.0, "the warning")
        time.sleep(0.5)
        assert get_joint_speed(robot) < 0.01
    assert len(log_lines(driver, warning)) == before + 1 and text in log_lines(driver, warning)[-1]
    assert get_joint_state(robot).position[0] == pytest.approx(0.0, abs=0.02)


def test_the_state_of_a_topic_is_published(robot, simulator):
    begin = seconds(robot.call(GetJointState, "get_joint_state").joint_state.header.stamp)
    states = robot.subscribe(TeleoperationState, "teleoperation", transient_local=True)

    def new():
        return [(state.topic, state.state, state.error_code) for state in list(states) if seconds(state.stamp) > begin]

    with Publisher(robot, TwistStamped, "twist", lambda t: twist_message("base", -0.05)):
        wait_for(lambda: not simulator.is_at_rest(), 10.0, "a motion")
        wait_for(new, 10.0, "the state")
        assert new() == [("/twist", TeleoperationState.ACTIVE, 0)]
        robot.send(Stop, "stop").succeeded()
        wait_for(lambda: len(new()) >= 3, 10.0, "the end of the session")
        assert simulator.is_at_rest()
    assert new()[1:3] == [("/twist", state, ErrorCode.PREEMPTED) for state in (TeleoperationState.STOPPING, TeleoperationState.IDLE)]
    pause()
    robot.send(MoveJ, "move_j", joint_positions=HOME, speed=1.0).succeeded()


def test_the_latency_from_message_to_command_is_logged(robot, driver):
    before = len(log_lines(driver, "ms from message to command"))
    with Publisher(robot, TwistStamped, "twist", lambda t: twist_message("base"), rate=200.0, duration=1.0) as publisher:
        publisher.join(5.0)
    line = wait_for(lambda: log_lines(driver, "ms from message to command")[before:], 10.0, "the end of teleoperation")[0]
    count, mean = re.search(r"(\d+) messages, ([\d.]+) ms from message to command", line).groups()
    # A message that waits for longer than the next packages is replaced by a newer one or ends the motion by the timeout.
    assert int(count) > 10 and 0.0 < float(mean) < 1e3 * TIMEOUT, line
