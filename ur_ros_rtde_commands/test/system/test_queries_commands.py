"""Queries to the controller, compared with independent computations."""

import numpy as np
import pytest
import ur10e
from action_msgs.msg import GoalStatus
from arm_state import get_joint_state, home_plus, wait_until_moving
from geometry_msgs.msg import Point, Pose, Quaternion
from support import HOME, wait_for

from ur_ros_rtde_msgs.action import (
    CheckJoints,
    CheckPose,
    GetCoriolisTorques,
    GetFlag,
    GetForwardKinematics,
    GetInteger,
    GetInverseKinematics,
    GetJacobian,
    GetJointPositionsHistory,
    GetJointValues,
    GetMassMatrix,
    GetNumber,
    GetPose,
    GetRegister,
    MakeReady,
    MoveJ,
    PoseTrans,
    SendScript,
)
from ur_ros_rtde_msgs.msg import ErrorCode

OTHER_POSITIONS = [0.3, -1.2, 1.4, -1.1, -1.3, 0.5]
VELOCITIES = [0.3, -0.5, 0.7, 0.2, -0.9, 0.4]
TOOL = Pose(position=Point(x=0.05, y=-0.02, z=0.15), orientation=Quaternion(x=0.1, y=0.2, z=0.3, w=0.9))


def query(robot, action, name, **fields):
    return robot.send(action, name, **fields).succeeded()


def to_matrix(result):
    return np.array(result.matrix).reshape(6, 6)


def test_forward_kinematics_matches_the_dh_parameters(robot):
    at_flange = query(robot, GetForwardKinematics, "get_forward_kinematics", joint_positions=OTHER_POSITIONS).pose
    assert ur10e.matrix(at_flange) == pytest.approx(ur10e.flange(OTHER_POSITIONS), abs=1e-6)
    at_tool = query(robot, GetForwardKinematics, "get_forward_kinematics", joint_positions=OTHER_POSITIONS, use_tcp=True,
                    tcp=TOOL).pose
    assert ur10e.matrix(at_tool) == pytest.approx(ur10e.flange(OTHER_POSITIONS) @ ur10e.matrix(TOOL), abs=1e-6)


def test_forward_kinematics_without_arguments_uses_the_current_joint_positions(robot):
    pose = query(robot, GetForwardKinematics, "get_forward_kinematics").pose
    assert ur10e.matrix(pose) == pytest.approx(ur10e.flange(HOME), abs=2e-3)
    flange = query(robot, GetPose, "get_actual_tool_flange_pose")
    assert flange.frame == "base" and ur10e.matrix(flange.pose) == pytest.approx(ur10e.flange(HOME), abs=2e-3)


def test_inverse_kinematics_returns_the_nearest_solution(robot):
    pose = query(robot, GetForwardKinematics, "get_forward_kinematics", joint_positions=OTHER_POSITIONS).pose
    near = [value + 0.1 for value in OTHER_POSITIONS]
    found = query(robot, GetInverseKinematics, "get_inverse_kinematics", pose=pose, near=near).joint_positions
    assert list(found) == pytest.approx(OTHER_POSITIONS, abs=1e-4)
    flipped = [0.3, -1.2, 1.4, -1.1 - np.pi, 1.3, 0.5 - np.pi]
    found = query(robot, GetInverseKinematics, "get_inverse_kinematics", pose=pose, near=flipped).joint_positions
    assert ur10e.flange(found) == pytest.approx(ur10e.matrix(pose), abs=1e-6)
    assert abs(found[4] - 1.3) < 0.3, found


def test_an_unreachable_pose_has_no_solution_and_later_queries_succeed(robot):
    far = Pose(position=Point(x=1.2, y=1.2, z=0.5))
    status, result = robot.send(GetInverseKinematics, "get_inverse_kinematics", pose=far).wait_for_result()
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, ErrorCode.UNREACHABLE)
    assert not query(robot, CheckPose, "get_inverse_kinematics_has_solution", pose=far).value
    assert not query(robot, CheckPose, "is_pose_within_safety_limits", pose=far).value
    here = query(robot, GetForwardKinematics, "get_forward_kinematics").pose
    assert query(robot, CheckPose, "get_inverse_kinematics_has_solution", pose=here).value
    assert query(robot, CheckPose, "is_pose_within_safety_limits", pose=here).value
    assert query(robot, CheckJoints, "is_joints_within_safety_limits", joint_positions=HOME).value


def test_pose_trans_composes_poses(robot):
    base = Pose(position=Point(x=3.0, y=-4.0, z=5.0), orientation=Quaternion(x=-0.3, y=0.1, z=0.2, w=0.8))
    pose = query(robot, PoseTrans, "pose_trans", p_from=base, p_from_to=TOOL).pose
    assert ur10e.matrix(pose) == pytest.approx(ur10e.matrix(base) @ ur10e.matrix(TOOL), abs=1e-6)


def test_the_jacobian_is_the_derivative_of_the_pose(robot):
    tool = ur10e.matrix(TOOL)
    actual = to_matrix(query(robot, GetJacobian, "get_jacobian", joint_positions=OTHER_POSITIONS, use_tcp=True, tcp=TOOL))
    assert actual == pytest.approx(ur10e.jacobian(OTHER_POSITIONS, tool), abs=1e-5)
    change = to_matrix(query(robot, GetJacobian, "get_jacobian_time_derivative", joint_positions=OTHER_POSITIONS,
                             joint_velocities=VELOCITIES, use_tcp=True, tcp=TOOL))
    later, before = (ur10e.jacobian(np.array(OTHER_POSITIONS) + sign * 1e-4 * np.array(VELOCITIES), tool) for sign in (1, -1))
    assert change == pytest.approx((later - before) / 2e-4, abs=1e-3)
    present = to_matrix(query(robot, GetJacobian, "get_jacobian"))
    assert present == pytest.approx(ur10e.jacobian(HOME), abs=5e-3)


def test_coriolis_torques_follow_from_the_mass_matrix(robot):
    def mass(q):
        return to_matrix(query(robot, GetMassMatrix, "get_mass_matrix", joint_positions=list(q)))

    q, qd, step = np.array(OTHER_POSITIONS), np.array(VELOCITIES), 1e-3
    here = mass(q)
    assert here == pytest.approx(here.T, abs=1e-9) and np.linalg.eigvalsh(here).min() > 0.0
    assert here[0, 0] > 5.0 > here[5, 5]
    slopes = [(mass(q + step * axis) - mass(q - step * axis)) / (2 * step) for axis in np.eye(6)]
    # Lagrange: dM/dt qd - 1/2 d(qd' M qd)/dq
    expected = sum(slope * rate for slope, rate in zip(slopes, qd)) @ qd - 0.5 * np.array([qd @ slope @ qd for slope in slopes])
    actual = query(robot, GetCoriolisTorques, "get_coriolis_and_centrifugal_torques", joint_positions=list(q),
                   joint_velocities=list(qd)).joint_torques
    assert list(actual) == pytest.approx(list(expected), abs=2e-3)


def test_joint_torques_match_an_external_force(robot, simulator):
    force = np.array([0.0, 20.0, 0.0])
    simulator.control("push", force=list(force), duration=4.0)  # a half-sine over the duration
    expected = ur10e.jacobian(HOME)[:3].T @ force

    measured = []

    def torques_match():
        measured.append(np.array(query(robot, GetJointValues, "get_joint_torques").values))
        return np.abs(measured[-1] - expected).max() < 3.0

    try:
        wait_for(torques_match, 15.0, f"the torques {expected}")
    except AssertionError as error:
        raise AssertionError(f"{error}; last torques: {measured[-1]}") from None
    finally:
        simulator.control("clear_pushes")


def test_queries_are_answered_during_a_motion(robot):
    for action, name in ((GetPose, "get_target_waypoint"), (GetFlag, "is_steady"), (GetInteger, "get_async_operation_progress"),
                         (GetFlag, "is_program_running"), (GetJointPositionsHistory, "get_actual_joint_positions_history"),
                         (GetJointValues, "get_target_joint_accelerations")):
        robot.send(action, name).wait_for_result()  # its server is known from now on
    # For 5 s, so that it goes on if the host is late.
    motion = robot.send(MoveJ, "move_j", joint_positions=home_plus(2.4), speed=0.5, acceleration=1.0)
    wait_until_moving(robot, 0.2)
    waypoint = query(robot, GetPose, "get_target_waypoint").pose
    assert ur10e.matrix(waypoint) == pytest.approx(ur10e.flange(home_plus(2.4)), abs=2e-3)
    assert not query(robot, GetFlag, "is_steady").value
    progress = query(robot, GetInteger, "get_async_operation_progress")
    assert progress.value == 0 and "waypoint" in progress.text
    assert query(robot, GetFlag, "is_program_running").value
    before = get_joint_state(robot).position[0]
    history = query(robot, GetJointPositionsHistory, "get_actual_joint_positions_history", steps=100).joint_positions
    assert get_joint_state(robot).position[0] - history[0] > 0.02
    assert before - history[0] < 0.5 * 0.2 + 0.005, "100 steps are 0.2 s"
    query(robot, GetJointValues, "get_target_joint_accelerations")
    motion.succeeded()
    assert query(robot, GetInteger, "get_async_operation_progress").value == -1
    wait_for(lambda: query(robot, GetFlag, "is_steady").value, 15.0, "the arm to be steady")
    assert list(query(robot, GetJointValues, "get_target_joint_accelerations").values) == pytest.approx([0.0] * 6, abs=1e-9)


def test_step_time_and_status(robot):
    step = query(robot, GetNumber, "get_step_time")
    assert (step.value, step.unit) == (pytest.approx(0.002), "s")
    status = query(robot, GetInteger, "get_robot_status")
    assert (status.value, status.text) == (3, "power on, program running")


def test_queries_do_not_change_output_registers(robot):
    query(robot, SendScript, "send_secondary_script",
          script="write_output_integer_register(13, -42)\nwrite_output_float_register(14, 2.5)")
    query(robot, GetMassMatrix, "get_mass_matrix")  # returns 36 values
    wait_for(lambda: query(robot, GetRegister, "get_output_int_register", index=13).value == -42, 15.0, "the register")
    assert query(robot, GetRegister, "get_output_double_register", index=14).value == 2.5


def test_queries_are_rejected_while_a_script_replaces_the_control_program(robot, simulator):
    goal = robot.send(SendScript, "send_script", script='while True:\n  textmsg("here")\n  sleep(0.1)\nend', timeout=60.0)
    wait_for(lambda: goal.feedback, 10.0, "the script to run")
    rejected = robot.send(GetFlag, "is_steady")
    assert not rejected.accepted and robot.rejection(rejected).error_code == ErrorCode.BUSY
    assert query(robot, GetFlag, "is_program_running").value
    goal.cancel()
    assert goal.wait_for_result()[0] == GoalStatus.STATUS_CANCELED
    assert query(robot, GetFlag, "is_steady").success


def test_queries_are_rejected_in_a_protective_stop(robot, simulator):
    simulator.control("protective_stop", reason="a test")
    wait_for(lambda: simulator.state()["safety_mode"] == "PROTECTIVE_STOP", 15.0, "the stop")

    def rejection_code():
        goal = robot.send(GetPose, "get_tcp_offset")
        return None if goal.accepted else robot.rejection(goal).error_code

    wait_for(lambda: rejection_code() == ErrorCode.PROTECTIVE_STOP, 15.0, "the rejection")
    robot.send(MakeReady, "make_ready").succeeded()
    assert query(robot, GetPose, "get_tcp_offset").frame == "tool0"
