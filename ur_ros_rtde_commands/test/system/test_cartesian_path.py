"""Tests of execute_cartesian_path on the simulator."""

import math

import pytest
from action_msgs.msg import GoalStatus
from arm_state import get_tcp_pose, translated
from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion
from support import wait_for
from trajectories import TargetRecorder
from ur_ros_rtde_description.kinematics import flange_pose, nominal_origins
from ur_ros_rtde_description.models import find_model

from ur_ros_rtde_msgs.action import ExecuteCartesianPath
from ur_ros_rtde_msgs.msg import ErrorCode

PLUGINS = "plugins:=[move_j,stop,execute_cartesian_path]"
SIMULATOR_ARGUMENTS = ("--calibration-seed", "3")  # the paths are straight for a calibrated arm, too
NAN = math.nan
MIN_LOOKAHEAD = 0.03  # s


def send(robot, *poses, **fields):
    return robot.send(ExecuteCartesianPath, "execute_cartesian_path", poses=list(poses), **fields)


def point(pose):
    return (pose.position.x, pose.position.y, pose.position.z)


def test_the_tcp_moves_in_straight_lines_between_poses(robot):
    start = get_tcp_pose(robot)
    down, aside = translated(start, z=-0.15), translated(start, y=0.1, z=-0.15)
    seen = robot.subscribe(PoseStamped, "tcp_pose")
    result = send(robot, down, aside, lookahead_time=MIN_LOOKAHEAD).succeeded()
    reached = result.final_state.tcp_pose
    assert point(reached) == pytest.approx(point(aside), abs=0.001)
    # Each position lies on one of the two lines.
    deviations = [min(math.dist((x, y), point(start)[:2]), math.dist((x, z), (point(down)[0], point(down)[2])))
                  for x, y, z in (point(message.pose) for message in robot.messages_until_now(seen))]
    assert len(deviations) > 100 and max(deviations) < 0.001


def test_the_arm_is_calibrated(robot, simulator):
    """Without the calibration, the TCP would be farther away than that."""
    x, y, z, *_ = simulator.state()["target_tcp_pose"]
    origins = nominal_origins(find_model("ur10e"))
    nominal = flange_pose(origins, simulator.state()["target"]["position"])[:3, 3]
    assert math.dist((x, y, z), nominal) > 3e-4


def test_keeps_its_speed_and_blends_corners(robot):
    start = get_tcp_pose(robot)
    corner, end = translated(start, z=-0.1), translated(start, y=0.1, z=-0.1)
    stops = send(robot, corner, end, speed=0.1, lookahead_time=MIN_LOOKAHEAD).succeeded()
    send(robot, start).succeeded()
    seen = robot.subscribe(PoseStamped, "tcp_pose")
    rounds = send(robot, corner, end, speed=0.1, blend_radius=0.01, lookahead_time=MIN_LOOKAHEAD).succeeded()
    assert 0.2 / 0.1 - 0.1 < rounds.duration < stops.duration
    distances = [math.dist(point(message.pose), point(corner)) for message in robot.messages_until_now(seen)]
    assert min(distances) == pytest.approx(0.01, abs=0.003)


def test_default_limits_make_the_joints_slow(robot, simulator):
    start = get_tcp_pose(robot)
    end = translated(start, y=0.6, z=-0.2)
    fast = {"speed": 3.0, "rotation_speed": 6.0}
    recorder = TargetRecorder(simulator)
    goal = send(robot, end, **fast)
    recorder.record_until_finished(goal)
    assert recorder.max_joint_speed() < 1.05 * 1.03
    duration = goal.succeeded().duration
    send(robot, start, **fast, max_velocity=[1.8] * 6, max_acceleration=[5.0] * 6).succeeded()
    given = send(robot, end, **fast, max_velocity=[1.05] * 6, max_acceleration=[1.4] * 6).succeeded()
    assert given.duration == pytest.approx(duration, rel=0.01)


def test_an_unreachable_point_on_the_path_aborts_the_goal_before_the_arm_moves(robot, simulator):
    start = get_tcp_pose(robot)
    before = simulator.state()["target"]["position"]
    # The line from one side of the base to the other passes through its axis.
    through = translated(start, x=-2.0 * start.position.x, y=-2.0 * start.position.y)
    goal = send(robot, through)
    if goal.accepted:
        status, result = goal.wait_for_result()
        assert status == GoalStatus.STATUS_ABORTED and result.error_code == ErrorCode.UNREACHABLE, result.message
        assert "poses[0]" in result.message
    else:
        assert robot.rejection(goal).error_code == ErrorCode.UNREACHABLE
    assert simulator.state()["target"]["position"] == before


def test_cancel_decelerates_on_the_line(robot, simulator):
    start = get_tcp_pose(robot)
    seen = robot.subscribe(PoseStamped, "tcp_pose")
    goal = send(robot, translated(start, z=-0.3), speed=0.1, lookahead_time=MIN_LOOKAHEAD)
    goal.wait_until(lambda: any(f.motion.progress > 0.1 for f in goal.feedback), 20.0, "a progress of 0.1")
    goal.cancel()
    status, result = goal.wait_for_result(10.0)
    assert status == GoalStatus.STATUS_CANCELED
    assert start.position.z - 0.29 < result.final_state.tcp_pose.position.z < start.position.z
    assert max(math.dist(point(message.pose)[:2], point(start)[:2]) for message in robot.messages_until_now(seen)) < 0.001
    wait_for(lambda: simulator.state()["at_rest"], 15.0, "standstill")


GOOD = Pose(position=Point(x=-0.69, y=-0.17, z=0.6), orientation=Quaternion(x=0.7071, y=0.7071))
REJECTED = [
    ({"poses": []}, ErrorCode.INVALID_GOAL, "poses has 0 entries"),
    ({"poses": [GOOD] * 10001}, ErrorCode.INVALID_GOAL, "poses has 10001 entries"),
    ({"poses": [GOOD, Pose(position=Point(x=NAN))]}, ErrorCode.INVALID_GOAL, "poses[1].position"),
    ({"poses": [Pose(position=Point(x=0.5), orientation=Quaternion(w=0.0))]}, ErrorCode.INVALID_GOAL, "poses[0].orientation"),
    ({"poses": [Pose(position=Point(x=5.0))]}, ErrorCode.UNREACHABLE, "poses[0]"),
    ({"speed": 0.0}, ErrorCode.INVALID_GOAL, "speed is 0"),
    ({"rotation_speed": 7.0}, ErrorCode.INVALID_GOAL, "rotation_speed is 7"),
    ({"blend_radius": -0.1}, ErrorCode.INVALID_GOAL, "blend_radius is -0.1"),
    ({"max_jerk": [0.0] * 6}, ErrorCode.INVALID_GOAL, "max_jerk[0] (shoulder_pan_joint) is 0"),
]


@pytest.mark.parametrize("fields, code, what", REJECTED, ids=[what for _, _, what in REJECTED])
def test_an_invalid_path_is_rejected_with_the_reason(driver, client, fields, code, what):
    goal = client.send(ExecuteCartesianPath, "execute_cartesian_path", **{"poses": [GOOD], **fields})
    assert not goal.accepted
    rejection = client.rejection(goal)
    assert rejection.error_code == code and what in rejection.message, rejection.message
