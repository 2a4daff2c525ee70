"""Tests of the commands of command_server on the simulator."""

import math

import pytest
from action_msgs.msg import GoalStatus
from arm_state import get_joint_state, get_tcp_pose, home_plus, is_at_rest, wait_until_moving
from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion, Twist, Vector3
from support import HOME, robot_seconds, seconds, wait_for
from trajectories import TargetRecorder

from ur_ros_rtde_msgs.action import MoveJ, MoveL, ServoJ, SetDigitalOutput, SetPayload, SetSpeedSlider, SpeedL, Stop, ZeroFtSensor
from ur_ros_rtde_msgs.msg import ErrorCode, IOState

NAN = math.nan


def test_move_j_reports_progress_and_the_final_state(robot):
    goal = robot.send(MoveJ, "move_j", joint_positions=home_plus(0.4), speed=0.6, acceleration=1.5)
    result = goal.succeeded()
    assert result.final_state.joint_positions == pytest.approx(home_plus(0.4), abs=0.005)
    assert get_joint_state(robot).position == pytest.approx(home_plus(0.4), abs=0.005)
    progress = [feedback.motion.progress for feedback in goal.feedback]
    assert len(progress) >= 10 and progress == sorted(progress) and 0.2 < progress[len(progress) // 2] < 0.9
    stamps = [seconds(feedback.motion.elapsed) for feedback in goal.feedback]
    assert all(later > earlier for earlier, later in zip(stamps, stamps[1:]))
    assert (stamps[-1] - stamps[0]) / (len(stamps) - 1) == pytest.approx(0.05, abs=0.02)


def test_move_l_moves_in_a_straight_line(robot):
    start = get_tcp_pose(robot)
    target = get_tcp_pose(robot)
    target.position.z -= 0.1
    poses = robot.subscribe(PoseStamped, "tcp_pose")
    wait_for(lambda: poses, 10.0, "tcp_pose")
    result = robot.send(MoveL, "move_l", pose=target, speed=0.2, acceleration=1.0).succeeded()
    reached = result.final_state.tcp_pose.position
    assert (reached.x, reached.y, reached.z) == pytest.approx((start.position.x, start.position.y, target.position.z),
                                                              abs=0.002)
    wait_for(lambda: poses[-1].pose.position.z == pytest.approx(target.position.z, abs=0.002), 10.0, "the last pose")
    positions = [pose.pose.position for pose in list(poses)]
    assert sum(0.02 < start.position.z - p.z < 0.08 for p in positions) > 20, "poses along the line"
    assert all((p.x, p.y) == pytest.approx((start.position.x, start.position.y), abs=0.001) for p in positions)


def test_move_l_normalizes_the_quaternion(robot):
    target = get_tcp_pose(robot)
    target.position.z += 0.02
    for axis in "xyzw":
        setattr(target.orientation, axis, 3.0 * getattr(target.orientation, axis))
    robot.send(MoveL, "move_l", pose=target, speed=0.2).succeeded()


BAD_GOALS = [
    (MoveJ, "move_j", {"joint_positions": [0.0] * 5}, "joint_positions has 5 values", "6"),
    (MoveJ, "move_j", {"joint_positions": []}, "joint_positions has 0 values", "6"),
    (MoveJ, "move_j", {"joint_positions": [0.0] * 7}, "joint_positions has 7 values", "6"),
    (MoveJ, "move_j", {"joint_positions": home_plus(0.0, 0.0, NAN)}, "joint_positions[2] (elbow_joint) is nan", "6.28"),
    (MoveJ, "move_j", {"joint_positions": home_plus(0.0, 0.0, 0.0, 0.0, 0.0, 9.0)}, "joint_positions[5] (wrist_3_joint) is 9", "6.28"),
    (MoveJ, "move_j", {"joint_positions": HOME, "speed": 3.5}, "speed is 3.5 rad/s", "3.14"),
    (MoveJ, "move_j", {"joint_positions": HOME, "speed": 0.0}, "speed is 0", "above 0"),
    (MoveJ, "move_j", {"joint_positions": HOME, "speed": -1.0}, "speed is -1", "above 0"),
    (MoveJ, "move_j", {"joint_positions": HOME, "acceleration": 41.0}, "acceleration is 41", "40"),
    (MoveJ, "move_j", {"joint_positions": HOME, "acceleration": math.inf}, "acceleration is inf", "40"),
    (MoveL, "move_l", {"pose": Pose(position=Point(x=0.5), orientation=Quaternion(w=0.0))}, "pose.orientation", "0"),
    (MoveL, "move_l", {"pose": Pose(position=Point(x=NAN))}, "pose.position", "nan"),
    (MoveL, "move_l", {"pose": Pose(position=Point(x=0.5)), "speed": 3.1}, "speed is 3.1 m/s", "3"),
    (MoveL, "move_l", {"pose": Pose(position=Point(x=0.5)), "acceleration": -1.0}, "acceleration is -1", "150"),
    (ServoJ, "servo_j", {"joint_positions": HOME, "time": 0.001}, "time is 0.001", "0.01"),
    (ServoJ, "servo_j", {"joint_positions": HOME, "lookahead_time": 0.5}, "lookahead_time is 0.5", "0.2"),
    (ServoJ, "servo_j", {"joint_positions": HOME, "gain": 5000.0}, "gain is 5000", "2000"),
    (ServoJ, "servo_j", {"joint_positions": [NAN] * 6}, "joint_positions[0]", "nan"),
    (SpeedL, "speed_l", {"twist": Twist(linear=Vector3(x=4.0))}, "twist.linear is 4 m/s", "3"),
    (SpeedL, "speed_l", {"twist": Twist(angular=Vector3(x=NAN))}, "twist.angular is nan", "3.14"),
    (SpeedL, "speed_l", {"twist": Twist()}, "twist is zero", "nothing"),
    (SpeedL, "speed_l", {"twist": Twist(linear=Vector3(x=0.1)), "time": 1e9}, "time is 1e+09", "3600"),
    (Stop, "stop", {"joint_deceleration": 0.0}, "joint_deceleration is 0", "0.1"),
    (Stop, "stop", {"linear_deceleration": NAN}, "linear_deceleration is nan", "150"),
    (SetDigitalOutput, "set_digital_output", {"pin": 18}, "pin is 18", "17"),
    (SetPayload, "set_payload", {"mass": -1.0}, "mass is -1 kg", "50"),
    (SetPayload, "set_payload", {"center_of_gravity": Vector3(z=NAN)}, "center_of_gravity.z is nan", "1"),
    (SetSpeedSlider, "set_speed_slider", {"fraction": 1.5}, "fraction is 1.5", "1"),
    (SetSpeedSlider, "set_speed_slider", {"fraction": 0.0}, "fraction is 0", "0.01"),
]


@pytest.mark.parametrize("action, name, fields, what, limit", BAD_GOALS,
                         ids=[f"{case[1]}-{case[3]}" for case in BAD_GOALS])
def test_an_invalid_goal_is_rejected_with_field_value_and_limit(driver, simulator, client, action, name, fields, what, limit):
    goal = client.send(action, name, **fields)
    assert not goal.accepted
    rejection = client.rejection(goal)
    assert rejection.error_code == ErrorCode.INVALID_GOAL
    assert rejection.action == f"/{name}"
    assert what in rejection.message and limit in rejection.message, rejection.message
    driver.wait_for_output(what)


def test_a_valid_goal_succeeds_after_an_invalid_one(robot):
    assert not robot.send(MoveJ, "move_j", joint_positions=[0.0]).accepted
    robot.send(MoveJ, "move_j", joint_positions=home_plus(0.05)).succeeded()


@pytest.mark.parametrize("x", [1.6, 2.9])
def test_an_unreachable_pose_is_rejected(robot, x):
    pose = get_tcp_pose(robot)
    pose.position.x, pose.position.y, pose.position.z = x, 0.0, 0.5
    goal = robot.send(MoveL, "move_l", pose=pose)
    assert not goal.accepted
    rejection = robot.rejection(goal)
    assert rejection.error_code == ErrorCode.UNREACHABLE, rejection.message
    assert "pose" in rejection.message


def test_a_second_motion_is_rejected_with_the_id_of_the_running_goal(robot):
    first = robot.send(MoveJ, "move_j", joint_positions=home_plus(1.0), speed=0.5)
    wait_until_moving(robot)
    second = robot.send(SpeedL, "speed_l", twist=Twist(linear=Vector3(z=0.05)))
    assert not second.accepted
    rejection = robot.rejection(second)
    assert rejection.error_code == ErrorCode.BUSY
    assert "move_j" in rejection.message and first.id.hex()[:8] in rejection.message
    first.succeeded()


@pytest.mark.parametrize("action, name, fields", [
    (MoveJ, "move_j", {"joint_positions": home_plus(2.0), "speed": 0.6, "acceleration": 2.0}),
    (MoveL, "move_l", {"speed": 0.1}),
    (ServoJ, "servo_j", {"joint_positions": home_plus(1.0), "time": 4.0}),
    (SpeedL, "speed_l", {"twist": Twist(linear=Vector3(z=-0.1)), "time": 20.0}),
], ids=lambda value: value if isinstance(value, str) else "")
def test_cancel_decelerates_and_reports_the_final_state(robot, simulator, action, name, fields):
    if action is MoveL:
        fields = {**fields, "pose": get_tcp_pose(robot)}
        fields["pose"].position.z -= 0.4
    goal = robot.send(action, name, **fields)
    wait_until_moving(robot, 0.1)
    wait_for(lambda: goal.feedback and seconds(goal.feedback[-1].motion.elapsed) > 0.6, 10.0, "the motion to reach its speed")
    recorder = TargetRecorder(simulator)
    goal.cancel()
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_CANCELED
    assert not result.success and result.error_code == ErrorCode.CANCELED
    assert is_at_rest(robot)
    assert result.final_state.joint_positions == pytest.approx(list(get_joint_state(robot).position), abs=0.003)
    speed = list(recorder.update().joint_speeds.values())
    begin = next(i for i, value in enumerate(speed) if value < 0.9 * speed[0])
    end = next(i for i, value in enumerate(speed) if value < 0.02)
    assert end - begin > 5, "the arm stopped abruptly instead of decelerating"
    assert end < 500.0 * 2.5


def test_stop_aborts_the_running_motion(robot):
    motion = robot.send(MoveJ, "move_j", joint_positions=home_plus(2.0), speed=0.8, acceleration=2.0)
    wait_until_moving(robot, 0.3)
    result = robot.send(Stop, "stop").succeeded()
    assert is_at_rest(robot)
    assert 0.05 < result.time_to_standstill < 2.0
    assert f"move_j, goal {motion.id.hex()[:8]}" in result.message
    status, ended = motion.wait_for_result()
    assert status == GoalStatus.STATUS_ABORTED and ended.error_code == ErrorCode.PREEMPTED
    assert "stop" in ended.message


def test_stop_succeeds_at_standstill(robot):
    robot.send(Stop, "stop").succeeded(5.0)


def test_servo_j_takes_at_least_the_given_time(robot):
    goal = robot.send(ServoJ, "servo_j", joint_positions=home_plus(0.5), time=1.5)
    result = goal.succeeded()
    assert result.final_state.joint_positions == pytest.approx(home_plus(0.5), abs=0.015)
    assert robot_seconds(goal.feedback[-1].motion.elapsed) > 1.5 - 0.1  # longer on a busy host, never shorter; feedback comes at 20 Hz


def test_servo_j_rejects_a_time_that_is_too_short_for_the_joints(robot):
    goal = robot.send(ServoJ, "servo_j", joint_positions=home_plus(1.0), time=0.5)
    assert not goal.accepted
    rejection = robot.rejection(goal)
    assert rejection.error_code == ErrorCode.INVALID_GOAL
    assert "shoulder_pan_joint" in rejection.message and "use a time of at least" in rejection.message


def test_speed_l_moves_for_the_given_time_and_stops(robot):
    start = get_tcp_pose(robot).position.z
    result = robot.send(SpeedL, "speed_l", twist=Twist(linear=Vector3(z=-0.1)), acceleration=1.0, time=1.0).succeeded()
    assert is_at_rest(robot)
    assert start - result.final_state.tcp_pose.position.z == pytest.approx(0.095, abs=0.03)


@pytest.mark.parametrize("pin", [0, 7, 8, 15, 16, 17])
def test_set_digital_output_switches_the_pin(robot, simulator, pin):
    for state in (True, False):
        robot.send(SetDigitalOutput, "set_digital_output", pin=pin, state=state).succeeded()
        assert bool(simulator.state()["io"]["digital_outputs"] >> pin & 1) == state
    messages = robot.subscribe(IOState, "io_state")
    wait_for(lambda: messages, 15.0, "io_state")
    assert not messages[-1].digital_outputs[pin]


def test_outputs_can_be_switched_during_a_motion(robot):
    motion = robot.send(MoveJ, "move_j", joint_positions=home_plus(1.0), speed=0.5)
    wait_until_moving(robot)
    robot.send(SetDigitalOutput, "set_digital_output", pin=1, state=True).succeeded()
    motion.succeeded()
    robot.send(SetDigitalOutput, "set_digital_output", pin=1, state=False).succeeded()


def test_set_payload_and_speed_slider_take_effect(robot, simulator):
    robot.send(SetPayload, "set_payload", mass=1.5, center_of_gravity=Vector3(z=0.05)).succeeded()
    assert simulator.state()["payload"] == {"mass": pytest.approx(1.5), "center_of_gravity": pytest.approx([0.0, 0.0, 0.05])}
    robot.send(SetPayload, "set_payload", mass=0.0).succeeded()
    assert simulator.state()["payload"]["center_of_gravity"] == pytest.approx([0.0, 0.0, 0.0], abs=1e-6)
    robot.send(SetSpeedSlider, "set_speed_slider", fraction=0.5).succeeded()
    assert simulator.state()["speed_slider"] == pytest.approx(0.5)
    robot.send(SetSpeedSlider, "set_speed_slider", fraction=1.0).succeeded()


def test_the_speed_slider_makes_a_running_motion_faster(robot, simulator):
    def turns_with(speed):
        return simulator.state()["target"]["velocity"][0] == pytest.approx(speed, rel=0.01)

    robot.send(SetSpeedSlider, "set_speed_slider", fraction=0.1).succeeded()
    motion = robot.send(MoveJ, "move_j", joint_positions=home_plus(2.0), speed=0.5)
    wait_for(lambda: turns_with(0.05), 10.0, "a tenth of the speed")
    robot.send(SetSpeedSlider, "set_speed_slider", fraction=1.0).succeeded()
    wait_for(lambda: turns_with(0.5), 10.0, "the whole speed")
    motion.cancel()
    motion.wait_for_result()


def test_zero_ft_sensor_reads_zero_afterwards(robot):
    result = robot.send(ZeroFtSensor, "zero_ft_sensor").succeeded()
    assert abs(result.wrench.force.z) < 5.0


def test_a_protective_stop_aborts_the_goal_and_the_next_goal_succeeds_after_unlocking(robot, simulator):
    goal = robot.send(MoveJ, "move_j", joint_positions=home_plus(2.0), speed=0.6)
    wait_until_moving(robot)
    simulator.control("protective_stop", reason="a test")
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == ErrorCode.PROTECTIVE_STOP, result.message
    assert "not known" not in result.message
    rejected = robot.send(MoveJ, "move_j", joint_positions=HOME)
    assert not rejected.accepted and robot.rejection(rejected).error_code == ErrorCode.PROTECTIVE_STOP
    wait_for(simulator.unlock_protective_stop, 10.0, "the protective stop to be unlocked")
    home = wait_for(lambda: _send_accepted_goal(robot), 20.0, "a motion to be accepted again")
    home.succeeded()


def _send_accepted_goal(client):
    goal = client.send(MoveJ, "move_j", joint_positions=HOME, speed=1.0, acceleration=3.0)
    return goal if goal.accepted else None


def test_an_emergency_stop_aborts_the_goal(robot, simulator):
    goal = robot.send(MoveJ, "move_j", joint_positions=home_plus(2.0), speed=0.6)
    wait_until_moving(robot)
    simulator.control("emergency_stop", pressed=True)
    try:
        status, result = goal.wait_for_result()
        assert status == GoalStatus.STATUS_ABORTED and result.error_code == ErrorCode.EMERGENCY_STOP, result.message
        wait_for(lambda: simulator.state()["program"]["state"] == "STOPPED", 10.0, "the end of the program that the robot has paused")
    finally:
        simulator.control("emergency_stop", pressed=False)
        simulator.control("power", to="running")


def test_stopping_the_program_aborts_the_goal_without_resuming_it(robot, simulator):
    goal = robot.send(MoveJ, "move_j", joint_positions=home_plus(2.0), speed=0.6)
    wait_until_moving(robot)
    simulator.control("stop_program")
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == ErrorCode.PROGRAM_STOPPED, result.message
    wait_for(lambda: simulator.state()["program"]["state"] == "PLAYING", 10.0, "the control program to be restarted")
    assert is_at_rest(robot)


def test_a_suspended_driver_names_the_watchdog_as_the_cause(robot, simulator, driver):
    goal = robot.send(MoveJ, "move_j", joint_positions=home_plus(2.0), speed=0.6)
    wait_until_moving(robot)
    cycle = simulator.state()["cycle"]
    driver.pause()
    # At half speed, below a sanitizer, this is 2 s of the host: clients lose a driver that is silent for 3 s, and its result with it.
    wait_for(lambda: simulator.state()["cycle"] > cycle + 500, 20.0, "1 s without the driver")
    driver.resume()
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == ErrorCode.PROGRAM_STOPPED, result.message
    assert "this host sent no heartbeat" in result.message
    wait_for(lambda: is_at_rest(robot), 15.0, "standstill")


@pytest.mark.parametrize("clients", ["all", "receive", "control"])
def test_a_lost_connection_aborts_the_goal_and_stops_the_arm(robot, simulator, clients):
    goal = robot.send(MoveJ, "move_j", joint_positions=home_plus(2.0), speed=0.6)
    wait_until_moving(robot)
    simulator.control("drop_links", which="rtde", clients=clients)
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_ABORTED
    assert result.error_code in (ErrorCode.LINK_LOST, ErrorCode.PROGRAM_STOPPED), result.message
    wait_for(lambda: max(map(abs, simulator.state()["actual"]["velocity"])) < 0.01, 15.0, "standstill")
    assert simulator.state()["actual"]["position"][0] < 1.9


def test_each_of_many_concurrent_goals_gets_one_result(robot):
    switches, motions = [], []
    for i in range(10):  # in small groups, because ROS services queue at most ten requests
        switches += [robot.send(SetDigitalOutput, "set_digital_output", pin=pin, state=bool(i % 2)) for pin in range(4)]
        motions.append(robot.send(MoveJ, "move_j", joint_positions=home_plus(0.01 * i)))
        assert all(goal.accepted for goal in switches[-4:])
    assert all(goal.wait_for_result()[0] in (GoalStatus.STATUS_SUCCEEDED, GoalStatus.STATUS_ABORTED) for goal in switches)
    for goal in motions:
        if goal.accepted:
            goal.succeeded()
        else:
            assert robot.rejection(goal).error_code == ErrorCode.BUSY
