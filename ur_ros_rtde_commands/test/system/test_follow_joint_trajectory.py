"""Tests of follow_joint_trajectory, the action that MoveIt uses."""

import math
import pathlib

import pytest
import yaml
from action_msgs.msg import GoalStatus
from arm_state import home_plus
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from control_msgs.msg import JointComponentTolerance, JointTolerance
from programs import start_node
from support import HOME, JOINTS, wait_for
from trajectories import point, timed

Result = FollowJointTrajectory.Result
CONFIG = pathlib.Path(__file__).parents[3] / "ur_ros_rtde" / "config" / "moveit"


@pytest.fixture(scope="module")
def driver(simulator):
    driver = start_node("driver", simulator.address, "ur_type:=ur10e")
    yield driver
    driver.stop()
    print(driver.output())


def send(robot, *points, names=JOINTS, **fields):
    return robot.send(FollowJointTrajectory, "follow_joint_trajectory", trajectory=timed(*points, names=names), **fields)


def planned_points(positions, seconds=1.0):
    """Returns positions and velocities from home to `positions`, as a planner sends them."""
    return point(0.0, HOME, [0.0] * 6), point(seconds, positions, [0.0] * 6)


def tolerance(name, position=0.0, velocity=0.0, acceleration=0.0):
    return JointTolerance(name=name, position=position, velocity=velocity, acceleration=acceleration)


def rejection_message(robot, goal):
    assert not goal.accepted
    return robot.rejection(goal).message


def test_executes_a_plan_with_feedback(robot):
    goal = send(robot, *planned_points(home_plus(0.4, 0.1)))
    status, result = goal.wait_for_result(20.0)
    assert status == GoalStatus.STATUS_SUCCEEDED and result.error_code == Result.SUCCESSFUL, result.error_string
    feedback = goal.feedback[len(goal.feedback) // 2]
    assert len(goal.feedback) > 10 and feedback.joint_names == JOINTS
    for desired, actual, error in zip(feedback.desired.positions, feedback.actual.positions, feedback.error.positions):
        assert error == pytest.approx(desired - actual, abs=1e-12)
    assert abs(feedback.error.positions[0]) < 0.1 and feedback.desired.velocities[0] > 0.1


def test_ends_where_the_arm_has_come_to_rest_within_a_wide_tolerance(robot, simulator):
    goal = send(robot, *planned_points(home_plus(0.4)), goal_tolerance=[tolerance(joint, 0.3) for joint in JOINTS])
    status, result = goal.wait_for_result(20.0)
    assert status == GoalStatus.STATUS_SUCCEEDED, result.error_string
    assert simulator.state()["actual"]["position"][0] == pytest.approx(HOME[0] + 0.4, abs=0.002)


def test_accepts_joints_in_any_order(robot):
    order = (3, 0, 5, 1, 4, 2)
    target = home_plus(0.1, 0.05, -0.1, 0.2, 0.0, 0.3)
    names = [JOINTS[i] for i in order]
    goal = send(robot, point(1.5, [target[i] for i in order], [0.0] * 6), names=names)
    status, result = goal.wait_for_result(20.0)
    assert status == GoalStatus.STATUS_SUCCEEDED, result.error_string
    last = goal.feedback[-1]
    assert last.joint_names == names and last.actual.positions == pytest.approx([target[i] for i in order], abs=0.1)


def test_a_last_step_of_microseconds_is_accepted(robot, simulator):
    """MoveIt samples every 0.1 s and appends the end."""
    start, target = simulator.state()["target"]["position"], home_plus(0.2)
    begin, end = point(0.0, start, [0.0] * 6), point(1.50005, target, [0.0] * 6)
    status, result = send(robot, begin, point(1.5, target, [0.0] * 6), end).wait_for_result(20.0)
    assert status == GoalStatus.STATUS_SUCCEEDED, result.error_string
    assert simulator.state()["actual"]["position"][0] == pytest.approx(target[0], abs=0.002)


def test_a_trajectory_of_another_arm_is_rejected(robot):
    goal = send(robot, point(1.5, home_plus(0.1), [0.0] * 6), names=["left_" + joint for joint in JOINTS])
    assert not goal.accepted
    message = robot.rejection(goal).message
    assert '"left_"' in message and "tf_prefix" in message, message


def test_a_new_goal_preempts_the_running_one(robot, simulator):
    first = send(robot, *planned_points(home_plus(1.0), 4.0))
    wait_for(lambda: len(first.feedback) > 10, 10.0, "motion")
    second = send(robot, point(2.0, HOME, [0.0] * 6))
    assert second.accepted
    status, result = first.wait_for_result(10.0)
    assert status == GoalStatus.STATUS_ABORTED and "preempted by" in result.error_string
    status, result = second.wait_for_result(20.0)
    assert status == GoalStatus.STATUS_SUCCEEDED, result.error_string
    wait_for(lambda: simulator.state()["at_rest"], 15.0, "standstill")


def test_an_empty_trajectory_stops_the_running_one(robot, simulator):
    first = send(robot, *planned_points(home_plus(1.0), 4.0))
    wait_for(lambda: len(first.feedback) > 10, 10.0, "motion")
    status, result = send(robot, names=[]).wait_for_result(10.0)
    assert status == GoalStatus.STATUS_SUCCEEDED and result.error_code == Result.SUCCESSFUL
    assert first.wait_for_result(10.0)[0] == GoalStatus.STATUS_ABORTED
    wait_for(lambda: simulator.state()["at_rest"], 15.0, "standstill")


def test_cancel_decelerates(robot, simulator):
    goal = send(robot, *planned_points(home_plus(1.0), 4.0))
    wait_for(lambda: len(goal.feedback) > 10, 10.0, "motion")
    goal.cancel()
    assert goal.wait_for_result(10.0)[0] == GoalStatus.STATUS_CANCELED
    wait_for(lambda: simulator.state()["at_rest"], 15.0, "standstill")


def test_a_path_tolerance_violation_aborts_the_goal(robot):
    goal = send(robot, *planned_points(home_plus(0.8)), path_tolerance=[tolerance(JOINTS[0], 1e-6)])
    status, result = goal.wait_for_result(10.0)
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == Result.PATH_TOLERANCE_VIOLATED
    assert "shoulder_pan_joint" in result.error_string and "tolerance" in result.error_string


def test_a_goal_tolerance_violation_aborts_the_goal(robot):
    goal = send(robot, *planned_points(home_plus(0.8)), goal_tolerance=[tolerance(JOINTS[0], 1e-9)],
                goal_time_tolerance=Duration(nanosec=100_000_000))
    status, result = goal.wait_for_result(10.0)
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == Result.GOAL_TOLERANCE_VIOLATED
    assert "0.10 s after the end" in result.error_string


def test_velocity_tolerance_and_feedback_are_those_of_the_slower_motion(robot, simulator):
    simulator.control("speed_slider", fraction=0.4)
    start = simulator.state()["actual"]["position"][0]
    goal = send(robot, *planned_points(home_plus(0.6), 2.4), path_tolerance=[tolerance(JOINTS[0], 0.0, 0.15)])
    status, result = goal.wait_for_result(30.0)
    assert status == GoalStatus.STATUS_SUCCEEDED, result.error_string
    assert simulator.state()["actual"]["position"][0] == pytest.approx(start + 0.6, abs=0.01)
    fastest = max(goal.feedback, key=lambda feedback: feedback.desired.velocities[0])
    assert fastest.desired.velocities[0] == pytest.approx(0.4 * 1.875 * 0.6 / 2.4, rel=0.2), "the plan has 2.5 times as much"


def test_a_goal_that_is_canceled_has_no_error_of_its_tolerances(robot, simulator):
    goal = send(robot, *planned_points(home_plus(1.0), 4.0), path_tolerance=[tolerance(JOINTS[0], 0.0, 0.15)])
    wait_for(lambda: len(goal.feedback) > 10, 10.0, "motion")
    goal.cancel()
    status, result = goal.wait_for_result(10.0)
    assert status == GoalStatus.STATUS_CANCELED and result.error_code == Result.SUCCESSFUL, result.error_string
    wait_for(lambda: simulator.state()["at_rest"], 15.0, "standstill")


def test_a_negative_goal_time_tolerance_is_no_limit(robot, simulator):
    goal = send(robot, *planned_points(home_plus(0.2)), goal_tolerance=[tolerance(JOINTS[0], 1e-9)], goal_time_tolerance=Duration(sec=-1))
    wait_for(lambda: not simulator.state()["at_rest"], 15.0, "the motion")
    wait_for(lambda: simulator.state()["at_rest"], 15.0, "its end")
    end = simulator.state()["timestamp"]
    wait_for(lambda: simulator.state()["timestamp"] > end + 3.0, 30.0, "3 s of the robot")
    assert not goal.is_finished()
    goal.cancel()
    assert goal.wait_for_result(10.0)[0] == GoalStatus.STATUS_CANCELED


def test_a_plan_for_later_is_checked_at_once(robot):
    trajectory = timed(*planned_points(home_plus(2.0), 0.5))
    trajectory.header.stamp = robot.node.get_clock().now().to_msg()
    trajectory.header.stamp.sec += 50
    status, result = robot.send(FollowJointTrajectory, "follow_joint_trajectory", trajectory=trajectory).wait_for_result(20.0)
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == Result.INVALID_GOAL


def test_starts_at_the_header_stamp(robot, simulator):
    begin = simulator.state()["timestamp"]
    trajectory = timed(*planned_points(home_plus(0.2)))
    trajectory.header.stamp = (robot.node.get_clock().now()).to_msg()
    trajectory.header.stamp.sec += 2
    goal = robot.send(FollowJointTrajectory, "follow_joint_trajectory", trajectory=trajectory)
    assert goal.wait_for_result(20.0)[0] == GoalStatus.STATUS_SUCCEEDED
    assert simulator.state()["timestamp"] - begin > 2.0


def test_a_header_stamp_in_the_past_is_rejected(robot):
    trajectory = timed(*planned_points(home_plus(0.2)))
    trajectory.header.stamp = robot.node.get_clock().now().to_msg()
    trajectory.header.stamp.sec -= 100
    message = rejection_message(robot, robot.send(FollowJointTrajectory, "follow_joint_trajectory", trajectory=trajectory))
    assert "header.stamp" in message and "s ago" in message


REJECTED = [
    ({"names": JOINTS[:5]}, "5 names"),
    ({"names": []}, "joint_names is empty"),
    ({"names": [*JOINTS[:5], "finger"]}, "wrist_3_joint"),
    ({"path_tolerance": [tolerance("finger", 0.1)]}, "finger"),
    ({"goal_tolerance": [tolerance(JOINTS[0], float("nan"))]}, "nan"),
    ({"goal_tolerance": [tolerance(JOINTS[0], 0.1, 0.0, 1.0)]}, "acceleration"),
    ({"component_path_tolerance": [JointComponentTolerance(joint_name="base")]}, "multi_dof_trajectory"),
]


@pytest.mark.parametrize("fields, what", REJECTED, ids=[what for _, what in REJECTED])
def test_unsupported_goals_are_rejected(robot, fields, what):
    assert what in rejection_message(robot, send(robot, *planned_points(home_plus(0.1)), **fields))


def test_a_distant_start_and_invalid_points_are_rejected(robot):
    assert "away" in rejection_message(robot, send(robot, point(0.0, home_plus(0.3)), point(1.0, HOME)))
    assert "times[1]" in rejection_message(robot, send(robot, point(0.0, HOME), point(0.0, HOME)))
    assert "at the latest" in rejection_message(robot, send(robot, point(0.0, HOME), point(1_800_000_000.0, HOME)))
    assert "7" in rejection_message(robot, send(robot, point(0.0, HOME), point(1.0, home_plus(7.0))))
    assert "rest" in rejection_message(robot, send(robot, point(0.0, HOME, [0.0] * 6), point(1.0, HOME, [1.0] * 6)))


def test_a_start_that_is_one_turn_off_is_rejected(robot):
    """As MoveIt may plan for the continuous wrist 3 of a UR3e."""
    turned = [*HOME[:5], HOME[5] - 2.0 * math.pi]
    message = rejection_message(robot, send(robot, point(0.0, turned), point(1.0, turned)))
    assert "wrist_3_joint at -6.28" in message and "away" in message


def test_a_trajectory_too_fast_for_the_arm_is_aborted_before_it_moves(robot):
    status, result = send(robot, *planned_points(home_plus(2.0), 0.5)).wait_for_result(10.0)
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == Result.INVALID_GOAL
    assert "velocity of shoulder_pan_joint" in result.error_string or "acceleration of" in result.error_string


def test_a_protective_stop_aborts_the_goal(robot, simulator):
    goal = send(robot, *planned_points(home_plus(1.0), 4.0))
    wait_for(lambda: len(goal.feedback) > 10, 10.0, "motion")
    simulator.control("protective_stop")
    status, result = goal.wait_for_result(10.0)
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == Result.INVALID_GOAL
    assert "protective stop" in result.error_string
    wait_for(simulator.unlock_protective_stop, 10.0, "the protective stop to be unlocked")


def test_the_example_configuration_uses_this_action():
    controllers = yaml.safe_load((CONFIG / "moveit_controllers.yaml").read_text())
    manager = controllers["moveit_simple_controller_manager"]
    for name in manager["controller_names"]:
        controller = manager[name]
        assert controller["type"] == "FollowJointTrajectory" and controller["joints"] == JOINTS
        assert "/".join(part for part in (name, controller["action_ns"]) if part) == "follow_joint_trajectory"
