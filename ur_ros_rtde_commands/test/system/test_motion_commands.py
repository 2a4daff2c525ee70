"""Motion commands: the arm reaches the target along the specified path."""

import math

import pytest
from action_msgs.msg import GoalStatus
from arm_state import get_joint_positions, get_joint_speed, get_tcp_pose, translated
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3
from support import HOME, wait_for
from trajectories import TargetRecorder

from ur_ros_rtde_msgs.action import (
    Decelerate,
    Jog,
    MakeReady,
    MoveC,
    MoveJ,
    MoveJIK,
    MoveJRelative,
    MoveLFK,
    MoveLRelative,
    MoveP,
    MovePath,
    ServoC,
    ServoJ,
    ServoL,
    SetSpeedSlider,
    SpeedJ,
    SpeedL,
)
from ur_ros_rtde_msgs.msg import ErrorCode, PathWaypoint

DOWN = Quaternion(x=math.sqrt(0.5), y=math.sqrt(0.5), z=0.0, w=0.0)  # the tool looks down
FORWARD = Pose(position=Point(x=0.5), orientation=DOWN)


def distance(a, b):
    return math.dist((a.position.x, a.position.y, a.position.z), (b.position.x, b.position.y, b.position.z))


def angle(a, b):
    """Returns the angle between two orientations in rad."""
    dot = sum(getattr(a.orientation, axis) * getattr(b.orientation, axis) for axis in "xyzw")
    return 2.0 * math.acos(min(1.0, abs(dot)))


class TcpTrack:
    """The positions of the TCP in the simulator during the execution of a goal."""

    def __init__(self, simulator, goal):
        self.points = []
        while not goal.is_finished():
            self.points.append(tuple(simulator.state()["actual_tcp_pose"][:3]))
        goal.succeeded()

    def max_distance_from_line(self, start, end):
        direction = [b - a for a, b in zip(start, end)]
        length = math.dist(start, end)
        farthest = 0.0
        for point in self.points:
            along = sum(w * (p - s) for w, p, s in zip(direction, point, start)) / length
            foot = [s + along * w / length for s, w in zip(start, direction)]
            farthest = max(farthest, math.dist(point, foot))
        return farthest

    def min_distance_to(self, point):
        return min(math.dist(point, other) for other in self.points)


def xyz(pose):
    return pose.position.x, pose.position.y, pose.position.z


def test_move_j_ik_reaches_the_pose(robot):
    target = translated(get_tcp_pose(robot), y=0.2, z=-0.1)
    result = robot.send(MoveJIK, "move_j_ik", pose=target, speed=0.8, acceleration=3.0).succeeded()
    assert distance(result.final_state.tcp_pose, target) < 0.002 and angle(result.final_state.tcp_pose, target) < 0.01


def test_move_j_relative_adds_to_the_current_joint_positions(robot):
    offsets = [0.2, 0.0, -0.1, 0.0, 0.0, 0.3]
    for _ in range(2):
        start = get_joint_positions(robot)
        result = robot.send(MoveJRelative, "move_j_relative", joint_offsets=offsets, speed=1.0, acceleration=4.0).succeeded()
        assert list(result.final_state.joint_positions) == pytest.approx([a + b for a, b in zip(start, offsets)], abs=0.005)


def test_move_j_relative_rejects_targets_outside_the_joint_limits(robot):
    goal = robot.send(MoveJRelative, "move_j_relative", joint_offsets=[0.0, 0.0, 0.0, 0.0, 0.0, 6.5])
    assert not goal.accepted
    rejection = robot.rejection(goal)
    assert rejection.error_code == ErrorCode.INVALID_GOAL and "wrist_3_joint" in rejection.message


def test_move_l_fk_moves_in_a_straight_line(robot, simulator):
    start = xyz(get_tcp_pose(robot))
    target = [HOME[0] + 0.3, *HOME[1:]]
    goal = robot.send(MoveLFK, "move_l_fk", joint_positions=target, speed=0.2, acceleration=1.0)
    track = TcpTrack(simulator, goal)
    assert get_joint_positions(robot) == pytest.approx(target, abs=0.005)
    assert track.max_distance_from_line(start, xyz(get_tcp_pose(robot))) < 0.002


@pytest.mark.parametrize("frame, expected", [(MoveLRelative.Goal.BASE, (0.0, 0.0, 0.05)),
                                             (MoveLRelative.Goal.TOOL, (0.0, 0.0, -0.05))])
def test_move_l_relative_translates_along_the_axes_of_its_frame(robot, frame, expected):
    start = get_tcp_pose(robot)  # the tool points down
    result = robot.send(MoveLRelative, "move_l_relative", frame=frame, translation=Vector3(z=0.05)).succeeded()
    end = result.final_state.tcp_pose
    assert [b - a for a, b in zip(xyz(start), xyz(end))] == pytest.approx(expected, abs=0.002)
    assert angle(start, end) < 0.01


def test_move_l_relative_rotates_about_the_tcp(robot):
    start = get_tcp_pose(robot)
    result = robot.send(MoveLRelative, "move_l_relative", frame=MoveLRelative.Goal.BASE, rotation=Vector3(z=0.3),
                        speed=0.3).succeeded()
    assert distance(start, result.final_state.tcp_pose) < 0.002
    assert angle(start, result.final_state.tcp_pose) == pytest.approx(0.3, abs=0.01)


def test_move_p_blends_the_corner(robot, simulator):
    start = get_tcp_pose(robot)
    corner, end = translated(start, z=-0.1), translated(start, z=-0.1, y=0.15)
    goal = robot.send(MoveP, "move_p", poses=[corner, end], speed=0.1, blend_radius=0.03)
    track = TcpTrack(simulator, goal)
    assert distance(get_tcp_pose(robot), end) < 0.003
    assert 0.004 < track.min_distance_to(xyz(corner)) < 0.03, "the corner is blended within the blend radius"
    assert {feedback.waypoint for feedback in goal.feedback} == {0, 1}


def test_move_c_follows_the_arc(robot, simulator):
    start = get_tcp_pose(robot)
    via, end = translated(start, x=0.05, y=0.05), translated(start, y=0.1)
    track = TcpTrack(simulator, robot.send(MoveC, "move_c", via=via, pose=end, speed=0.1))
    assert distance(get_tcp_pose(robot), end) < 0.003
    centre = xyz(translated(start, y=0.05))
    radii = [math.dist(point, centre) for point in track.points]
    assert max(abs(radius - 0.05) for radius in radii) < 0.003
    assert track.min_distance_to(xyz(via)) < 0.005


def test_move_c_keeps_the_angle_to_the_arc(robot, simulator):
    start = get_tcp_pose(robot)
    via, end = translated(start, x=0.05, y=0.05), translated(start, y=0.1)
    via.orientation = Quaternion(x=0.0, y=0.0, z=0.0, w=0.0)  # not used, nor is that of the end
    robot.send(MoveC, "move_c", via=via, pose=end, speed=0.1, mode=MoveC.Goal.FIXED).succeeded()
    assert distance(get_tcp_pose(robot), end) < 0.003
    assert angle(get_tcp_pose(robot), start) == pytest.approx(math.pi, abs=0.02)


def test_move_path_combines_motion_types_and_reports_the_waypoint(robot):
    start = get_tcp_pose(robot)
    joints = [HOME[0] + 0.3, *HOME[1:]]
    goal = robot.send(MovePath, "move_path", waypoints=[
        PathWaypoint(type=PathWaypoint.MOVE_L, pose=translated(start, z=-0.1), speed=0.2, blend_radius=0.02),
        PathWaypoint(type=PathWaypoint.MOVE_L, pose=translated(start, z=-0.1, y=0.1), speed=0.2),
        PathWaypoint(type=PathWaypoint.MOVE_J, joint_positions=joints, speed=0.6, acceleration=2.0)])
    result = goal.succeeded()
    assert list(result.final_state.joint_positions) == pytest.approx(joints, abs=0.005)
    seen = [feedback.waypoint for feedback in goal.feedback]
    assert seen == sorted(seen) and {1, 2} <= set(seen)


def test_a_path_that_cannot_be_continued_is_aborted_by_a_protective_stop(robot):
    start = get_tcp_pose(robot)
    near = [translated(start, z=-0.002 * i) for i in range(1, 21)]  # the number of waypoints that are checked in advance
    status, result = robot.send(MovePath, "move_path", waypoints=[
        PathWaypoint(type=PathWaypoint.MOVE_L, pose=pose, speed=0.2, acceleration=2.0)
        for pose in [*near, translated(start, x=-0.8)]]).wait_for_result()
    assert status == GoalStatus.STATUS_ABORTED
    assert result.error_code == ErrorCode.PROTECTIVE_STOP, result.message
    assert distance(result.final_state.tcp_pose, near[-1]) < 0.01 and get_joint_speed(robot) < 0.01
    robot.send(MakeReady, "make_ready").succeeded(60.0)
    robot.send(MoveJ, "move_j", joint_positions=HOME, speed=1.0).succeeded()


def test_cancel_stops_a_path_and_the_next_motion_succeeds(robot):
    start = get_tcp_pose(robot)
    goal = robot.send(MoveP, "move_p", poses=[translated(start, z=-0.15), translated(start, z=-0.15, y=0.3)], speed=0.1)
    wait_for(lambda: get_joint_speed(robot) > 0.05, 10.0, "the arm to move")
    goal.cancel()
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_CANCELED and result.error_code == ErrorCode.CANCELED, result.message
    assert get_joint_speed(robot) < 0.01
    assert distance(result.final_state.tcp_pose, translated(start, z=-0.15, y=0.3)) > 0.1
    robot.send(MoveJ, "move_j", joint_positions=HOME, speed=1.0).succeeded()


def test_move_path_rejects_invalid_waypoints(robot):
    good = PathWaypoint(type=PathWaypoint.MOVE_L, pose=get_tcp_pose(robot))
    for waypoints, text in (([], "1 to 1000"), ([good, PathWaypoint(type=7, pose=good.pose)], "waypoints[1].type"),
                            ([PathWaypoint(type=1, pose=good.pose, blend_radius=0.1)], "blend_radius"),
                            ([PathWaypoint(type=2, joint_positions=HOME)], "MOVE_P")):
        goal = robot.send(MovePath, "move_path", waypoints=waypoints)
        assert not goal.accepted and text in robot.rejection(goal).message, robot.rejection(goal).message


@pytest.mark.parametrize("field, value, limit", [("speed", 3.2, "m/s"), ("acceleration", 151.0, "m/s^2")])
@pytest.mark.parametrize("action, name, fields", [
    (MoveC, "move_c", {"via": FORWARD, "pose": FORWARD}),
    (MoveP, "move_p", {"poses": [FORWARD]}),
    (MoveLRelative, "move_l_relative", {"translation": Vector3(z=-0.1)}),
    (ServoC, "servo_c", {"pose": FORWARD}),
    (MoveJRelative, "move_j_relative", {"joint_offsets": [0.1] * 6})])
def test_the_speed_and_acceleration_of_a_goal_are_limited(robot, action, name, fields, field, value, limit):
    goal = robot.send(action, name, **fields, **{field: value})
    unit = limit.replace("m/", "rad/") if action is MoveJRelative else limit
    message = robot.rejection(goal).message
    assert not goal.accepted and field in message and message.endswith(f" {unit}"), message


@pytest.mark.parametrize("action, name, fields, unit", [
    (ServoJ, "servo_j", {"joint_positions": HOME}, "rad/s^2"),
    (ServoL, "servo_l", {"pose": FORWARD}, "m/s^2"),
    (ServoC, "servo_c", {"pose": FORWARD}, "m/s^2"),
    (Decelerate, "servo_stop", {}, "rad/s^2 or m/s^2")])
def test_the_deceleration_of_a_servo_motion_is_that_of_its_setpoints(robot, action, name, fields, unit):
    message = robot.rejection(robot.send(action, name, **fields, deceleration=41.0)).message
    assert message.startswith("deceleration is 41") and message.endswith(f"to 40 {unit}"), message


def test_speed_j_moves_for_the_given_time(robot):
    result = robot.send(SpeedJ, "speed_j", joint_velocities=[0.2, 0.0, 0.0, 0.0, 0.0, -0.4], acceleration=2.0,
                        time=1.0, deceleration=4.0).succeeded()
    moved = [b - a for a, b in zip(HOME, result.final_state.joint_positions)]
    assert moved[0] == pytest.approx(0.2, abs=0.06) and moved[5] == pytest.approx(2.0 * -moved[0], abs=0.02)
    assert moved[1:5] == pytest.approx([0.0] * 4, abs=0.005)


def test_speed_j_rejects_velocities_above_the_joint_limit(robot):
    goal = robot.send(SpeedJ, "speed_j", joint_velocities=[2.5, 0.0, 0.0, 0.0, 0.0, 0.0])  # UR10e: 120 degrees/s
    assert not goal.accepted
    assert "shoulder_pan_joint" in robot.rejection(goal).message and "2.094" in robot.rejection(goal).message


@pytest.mark.parametrize("frame, expected", [(Jog.Goal.BASE, 0.1), (Jog.Goal.TOOL, -0.1)])
def test_jog_moves_along_the_axes_of_its_frame(robot, frame, expected):
    start = get_tcp_pose(robot)
    result = robot.send(Jog, "jog", twist=Twist(linear=Vector3(z=0.1)), frame=frame, acceleration=2.0, time=1.0).succeeded()
    translation = [b - a for a, b in zip(xyz(start), xyz(result.final_state.tcp_pose))]
    assert translation == pytest.approx([0.0, 0.0, expected], abs=0.02)


def test_jog_moves_along_the_axes_of_a_custom_frame(robot):
    start = get_tcp_pose(robot)
    frame = Pose(orientation=Quaternion(x=math.sqrt(0.5), y=0.0, z=0.0, w=math.sqrt(0.5)))  # its y axis is the z axis of the base
    result = robot.send(Jog, "jog", twist=Twist(linear=Vector3(y=-0.1)), frame=Jog.Goal.CUSTOM, custom_frame=frame,
                        acceleration=2.0, time=0.5).succeeded()
    translation = [b - a for a, b in zip(xyz(start), xyz(result.final_state.tcp_pose))]
    assert translation == pytest.approx([0.0, 0.0, -0.05], abs=0.02)


@pytest.mark.parametrize("time", [0.0, 60.0])
def test_cancel_is_a_regular_end_of_a_jog(robot, time):
    goal = robot.send(Jog, "jog", twist=Twist(linear=Vector3(z=-0.05)), time=time)
    wait_for(lambda: get_joint_speed(robot) > 0.02, 10.0, "the arm to move")
    goal.cancel()
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_SUCCEEDED and result.success, result.message
    assert get_joint_speed(robot) < 0.01


def test_servo_l_moves_in_a_straight_line(robot, simulator):
    start = get_tcp_pose(robot)
    target = translated(start, y=0.15, z=-0.1)
    track = TcpTrack(simulator, robot.send(ServoL, "servo_l", pose=target, time=2.0))
    assert distance(get_tcp_pose(robot), target) < 0.005
    assert track.max_distance_from_line(xyz(start), xyz(target)) < 0.005


def test_servo_l_rejects_a_time_that_is_too_short_for_the_tcp(robot):
    goal = robot.send(ServoL, "servo_l", pose=translated(get_tcp_pose(robot), z=-0.2), time=0.05)
    assert not goal.accepted and "use a time of at least" in robot.rejection(goal).message


def planned_cycles(distance, speed):
    """Returns the duration of a servo motion in cycles of the controller: its peak speed is 15/8 of the mean speed."""
    return 15.0 / 8.0 * distance / speed * 500.0


@pytest.mark.parametrize("action, name, target, cycles, speed_ratio", [
    (ServoJ, "servo_j", lambda _: {"joint_positions": [1.5, *HOME[1:]]}, planned_cycles(1.5, 1.05),
     lambda recorder: recorder.max_joint_speed() / 1.05),
    (ServoL, "servo_l", lambda robot: {"pose": translated(get_tcp_pose(robot), y=0.3)}, planned_cycles(0.3, 0.25),
     lambda recorder: recorder.max_tcp_speed() / 0.25)])
def test_servo_without_a_time_uses_the_default_speeds(robot, simulator, action, name, target, cycles, speed_ratio):
    goal_fields = target(robot)
    recorder = TargetRecorder(simulator)
    goal = robot.send(action, name, **goal_fields)
    recorder.record_until_finished(goal)
    goal.succeeded()
    # The peak speed of an idle host follows from the number of setpoints; test_servo_profile.cpp has the exact values.
    host_was_late = recorder.gaps(longer_than=4)  # after which the arm goes on more slowly
    assert host_was_late or recorder.cycles_with_setpoint() < 1.01 * cycles
    assert recorder.cycles_from_first_to_last_setpoint() > 0.98 * cycles
    assert speed_ratio(recorder) < 1.03


def test_servo_c_reaches_the_pose(robot):
    target = translated(get_tcp_pose(robot), y=0.1)
    result = robot.send(ServoC, "servo_c", pose=target, speed=0.1).succeeded()
    assert distance(result.final_state.tcp_pose, target) < 0.005


def test_servo_c_may_be_slower_than_what_counts_as_standstill(robot):
    target = translated(get_tcp_pose(robot), y=0.012)
    result = robot.send(ServoC, "servo_c", pose=target, speed=0.004).succeeded()
    assert distance(result.final_state.tcp_pose, target) < 0.005


@pytest.mark.parametrize("action, name, target", [
    (ServoJ, "servo_j", lambda _: {"joint_positions": [0.2, *HOME[1:]]}),
    (ServoL, "servo_l", lambda robot: {"pose": translated(get_tcp_pose(robot), y=0.1)})])
def test_servo_follows_the_speed_slider(robot, simulator, action, name, target):
    robot.send(SetSpeedSlider, "set_speed_slider", fraction=0.5).succeeded()
    try:
        begin = simulator.state()["timestamp"]
        robot.send(action, name, time=1.0, **target(robot)).succeeded()
        assert simulator.state()["timestamp"] - begin > 2.0
    finally:
        robot.send(SetSpeedSlider, "set_speed_slider", fraction=1.0).succeeded()


def test_servo_follows_the_speed_slider_smoothly(robot, simulator):
    recorder = TargetRecorder(simulator)
    goal = robot.send(ServoJ, "servo_j", joint_positions=[1.0, *HOME[1:]], time=2.0)
    wait_for(lambda: get_joint_speed(robot) > 0.7, 10.0, "the arm to move")
    robot.send(SetSpeedSlider, "set_speed_slider", fraction=0.1).succeeded()
    try:
        wait_for(lambda: get_joint_speed(robot) < 0.2, 10.0, "the arm to slow down")
        recorder.update()
    finally:
        robot.send(SetSpeedSlider, "set_speed_slider", fraction=1.0).succeeded()
    goal.succeeded()
    host_was_late = recorder.gaps(longer_than=4)  # then the controller slows the arm down
    assert host_was_late or recorder.max_deceleration() < 4.0  # 0.9 rad/s within lookahead_time: 9 rad/s²


@pytest.mark.parametrize("name, action, motion, fields", [
    ("stop_j", MoveJ, "move_j", {"joint_positions": [2.0, *HOME[1:]], "speed": 0.8, "acceleration": 2.0}),
    ("stop_l", MoveLRelative, "move_l_relative", {"translation": Vector3(z=-0.3), "speed": 0.2}),
    ("servo_stop", ServoL, "servo_l", {"time": 2.0}),
    ("speed_stop", SpeedJ, "speed_j", {"joint_velocities": [0.4, 0.0, 0.0, 0.0, 0.0, 0.0], "time": 10.0}),
    ("speed_stop", SpeedL, "speed_l", {"twist": Twist(linear=Vector3(z=-0.1)), "time": 10.0}),
    ("stop_l", MoveJ, "move_j", {"joint_positions": [2.0, *HOME[1:]], "speed": 0.8, "acceleration": 2.0}),
])
def test_stop_commands_preempt_the_running_motion(robot, name, action, motion, fields):
    if action is ServoL:
        fields = {**fields, "pose": translated(get_tcp_pose(robot), z=-0.2)}
    goal = robot.send(action, motion, **fields)
    wait_for(lambda: get_joint_speed(robot) > 0.03, 10.0, "the arm to move")
    result = robot.send(Decelerate, name, deceleration=3.0).succeeded()
    assert get_joint_speed(robot) < 0.01 and 0.01 < result.time_to_standstill < 2.0
    assert motion in result.message
    assert goal.wait_for_result()[1].error_code == ErrorCode.PREEMPTED


def test_stop_j_applies_the_deceleration(start_slow_robot):
    robot, _driver, simulator = start_slow_robot("speed_j", "stop_j")
    for deceleration in (0.5, 4.0):
        motion = robot.send(SpeedJ, "speed_j", joint_velocities=[0.4, 0.0, 0.0, 0.0, 0.0, 0.0], acceleration=10.0, time=60.0)
        assert motion.accepted, robot.rejection(motion).message
        wait_for(lambda: simulator.state()["target"]["velocity"][0] == pytest.approx(0.4, abs=1e-3), 20.0, "the speed")
        recorder = TargetRecorder(simulator)
        stopped = robot.send(Decelerate, "stop_j", deceleration=deceleration).succeeded()
        recorder.update()
        assert recorder.max_deceleration() == pytest.approx(deceleration, rel=0.15)
        # A late host notices the standstill later, and its newest sample at the begin may be older.
        assert 0.9 * 0.4 / deceleration < stopped.time_to_standstill < recorder.duration() + 0.1
