"""The teleoperation topics servo_joint, servo_pose and twist."""

import csv
import math
import threading
import time

import pytest
from arm_state import get_joint_speed, get_joint_state, get_tcp_pose, home_plus
from geometry_msgs.msg import PoseStamped, TwistStamped
from rclpy.qos import QoSProfile
from robot_fixtures import make_ready
from sensor_msgs.msg import JointState
from support import FEW_PLUGINS, HOME, JOINTS, REAL_TIME_FACTOR, Client, Simulator, seconds, start_node, wait_for

from ur_ros_rtde_msgs.action import MoveJ, Stop
from ur_ros_rtde_msgs.msg import ErrorCode
from ur_ros_rtde_msgs.srv import StartRecording, StopRecording

MEASURES_TIME = True
TIMEOUT = 0.5  # s; allows for delays of the publisher by other tests


@pytest.fixture(scope="module")
def driver(simulator):
    driver = start_node("driver", simulator.address, FEW_PLUGINS, "ur_type:=ur10e", f"stream_timeout:={TIMEOUT}")
    yield driver
    driver.stop()
    print(driver.output())


class Publisher(threading.Thread):
    """Publishes `message(t)`, where t is the time since the start in s, at a fixed rate until `duration` has passed or stop()."""

    def __init__(self, client, kind, topic, message, rate=50.0, duration=60.0):
        super().__init__(daemon=True)
        self._message, self._duration = message, duration
        self.period, self.longest_gap = 1.0 / rate, 0.0
        self._publisher = client.node.create_publisher(kind, topic, QoSProfile(depth=1))
        self._stop_event = threading.Event()
        wait_for(lambda: self._publisher.get_subscription_count() > 0, 10.0, f"a subscription of {topic}")
        self.start()

    def run(self):
        begin = before = time.monotonic()
        number = 0
        while not self._stop_event.is_set() and (now := time.monotonic()) - begin < self._duration:
            self._publisher.publish(self._message(now - begin))
            self.longest_gap, before = max(self.longest_gap, now - before), now
            number += 1
            self._stop_event.wait(max(0.0, begin + number * self.period - time.monotonic()))

    def stop(self):
        self._stop_event.set()
        self.join(5.0)
        return time.time()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()


def joint_message(positions, names=JOINTS):
    return JointState(name=list(names), position=[float(p) for p in positions])


def log_lines(driver, text):
    return [line for line in list(driver.lines) if text in line]


def pause():
    time.sleep(TIMEOUT + 0.1)


@pytest.fixture(autouse=True)
def no_active_teleoperation(robot):
    """Stops any motion that late messages of an earlier test started, and waits for the timeout of the topics."""
    robot.send(Stop, "stop").succeeded()
    pause()


def twist_message(frame, z=0.0):
    message = TwistStamped()
    message.header.frame_id = frame
    message.twist.linear.z = z
    return message


def swing(t):
    """Moves by 0.3 rad and back in 4 s, from rest to rest, with at most 0.24 rad/s and 0.37 rad/s^2."""
    return 0.15 * (1.0 - math.cos(2.0 * math.pi * min(t, 4.0) / 4.0))


def record_swing(robot, file):
    """Returns times, positions and velocities of the base joint by the robot's clock. None if the host delayed the publisher."""
    assert robot.call(StartRecording, "start_recording", filename=str(file), fields=["timestamp", "actual_q", "actual_qd"]).success
    with Publisher(robot, JointState, "servo_joint", lambda t: joint_message(home_plus(swing(REAL_TIME_FACTOR * t)))) as publisher:
        publisher.join(4.5 / REAL_TIME_FACTOR)
    assert robot.call(StopRecording, "stop_recording").success
    if publisher.longest_gap > 2.0 * publisher.period:
        return None
    with file.open(newline="") as text:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(text)]
    return [[row[name] for row in rows] for name in ("timestamp", "actual_q_0", "actual_qd_0")]


def test_servo_joint_at_50_hz_moves_smoothly(robot, tmp_path):
    swings = (record_swing(robot, tmp_path / f"{attempt}.csv") or pause() for attempt in range(8))
    regular = next(filter(None, swings), None)
    assert regular, "the host delayed the publisher in every attempt"
    times, positions, velocities = regular
    assert max(positions) == pytest.approx(0.3, abs=0.01)
    assert positions[-1] == pytest.approx(0.0, abs=0.02)
    # Accelerations over 50 ms. A target held constant between messages would cause ten times higher values.
    window = 25
    accelerations = [(velocities[i + window] - velocities[i]) / (times[i + window] - times[i])
                     for i in range(len(times) - window)]
    assert len(accelerations) > 1500
    assert max(map(abs, accelerations)) < 3.0 * 0.37


def test_servo_joint_accepts_any_order_and_ignores_other_joints(robot):
    names = [*reversed(JOINTS), "finger_joint"]
    target = home_plus(0.0, 0.0, 0.0, 0.0, 0.0, 0.1)
    values = [*reversed(target), 0.3]
    ramp = lambda t: [h + min(t / 0.5, 1.0) * (v - h) for h, v in zip([*reversed(HOME), 0.3], values)]
    with Publisher(robot, JointState, "servo_joint", lambda t: joint_message(ramp(t), names)):
        wait_for(lambda: list(get_joint_state(robot).position) == pytest.approx(target, abs=0.005), 5.0, "the arm to reach the target")


def test_the_arm_decelerates_after_the_timeout_of_a_topic(robot):
    states = robot.subscribe(JointState, "joint_states")
    publisher = Publisher(robot, TwistStamped, "twist", lambda t: twist_message("base", -0.1), rate=100.0)
    wait_for(lambda: states and max(map(abs, states[-1].velocity)) > 0.1, 10.0, "the arm to move")
    time.sleep(0.3)
    publisher.stop()
    last = seconds(get_joint_state(robot).header.stamp)
    wait_for(lambda: seconds(states[-1].header.stamp) > last and max(map(abs, states[-1].velocity)) < 0.01, 5.0,
             "standstill")
    recorded = [(seconds(s.header.stamp), max(map(abs, s.velocity))) for s in list(states)]
    rest = next(stamp for stamp, speed in recorded if stamp > last and speed < 0.01)
    assert rest - last < TIMEOUT + 0.1 / 2.0 + 0.15, "timeout, deceleration from 0.1 m/s at 2 m/s^2, and a margin"
    top = max(speed for _, speed in recorded)
    full = max(stamp for stamp, speed in recorded if stamp < rest and speed > 0.9 * top)
    assert rest - full > 0.02, "the arm stopped abruptly instead of decelerating in 50 ms"
    pause()
    robot.send(MoveJ, "move_j", joint_positions=HOME, speed=1.0).succeeded()


@pytest.mark.parametrize("frame, sign", [("base", 1.0), ("tool0_controller", -1.0), ("left_base", 1.0)])
def test_twist_moves_along_the_axes_of_its_frame(robot, frame, sign):
    start = get_tcp_pose(robot).position
    with Publisher(robot, TwistStamped, "twist", lambda t: twist_message(frame, 0.05)):
        wait_for(lambda: abs(get_tcp_pose(robot).position.z - start.z) > 0.03, 5.0, "the TCP to move")
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
        wait_for(lambda: abs(get_tcp_pose(robot).position.z - start.z) > 0.005, 5.0, "the topic to move the arm")
        goal = robot.send(MoveJ, "move_j", joint_positions=HOME)
        assert not goal.accepted
        refusal = robot.refusal(goal)
        assert refusal.error_code == ErrorCode.BUSY and "/twist" in refusal.message, refusal
    pause()
    robot.send(MoveJ, "move_j", joint_positions=HOME).succeeded()


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
    with Publisher(robot, TwistStamped, "twist", lambda t: twist_message("base")):
        time.sleep(0.3)
        before = len(log_lines(driver, "/servo_joint: messages are ignored"))
        with Publisher(robot, JointState, "servo_joint", lambda t: joint_message(home_plus(min(0.2, 0.2 * t)))):
            wait_for(lambda: len(log_lines(driver, "/servo_joint: messages are ignored")) > before, 5.0, "the warning")
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
        wait_for(lambda: len(log_lines(driver, warning)) > before, 5.0, "the warning")
        time.sleep(0.5)
        assert get_joint_speed(robot) < 0.01
    assert len(log_lines(driver, warning)) == before + 1 and text in log_lines(driver, warning)[-1]
    assert get_joint_state(robot).position[0] == pytest.approx(0.0, abs=0.02)


def test_a_protective_stop_ends_control_by_a_topic_without_resuming_it(robot, simulator):
    with Publisher(robot, TwistStamped, "twist", lambda t: twist_message("base", -0.05)):
        wait_for(lambda: get_joint_speed(robot) > 0.03, 10.0, "the arm to move")
        simulator.control("protective_stop", reason="a test")
        wait_for(lambda: get_joint_speed(robot) < 0.01, 5.0, "standstill")
        wait_for(simulator.unlock_protective_stop, 10.0, "the protective stop to be unlocked")
        wait_for(lambda: simulator.state()["program"]["state"] == "PLAYING", 10.0, "the control program to be restarted")
        time.sleep(0.5)
        assert get_joint_speed(robot) < 0.01


def test_latency_from_message_to_command_is_below_20_ms(robot, driver):
    with Publisher(robot, TwistStamped, "twist", lambda t: twist_message("base"), rate=200.0, duration=2.0) as publisher:
        publisher.join(5.0)
    line = driver.wait_for_output("ms from message to command")
    mean = float(log_lines(driver, "ms from message to command")[-1].split(" messages, ")[1].split(" ms")[0])
    assert mean < 20.0, line
