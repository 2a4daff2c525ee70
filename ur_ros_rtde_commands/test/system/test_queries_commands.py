"""What the controller answers, compared with computations of its own."""

import numpy as np
import pytest
import ur10e
from action_msgs.msg import GoalStatus
from arm_state import get_joint_state, home_plus, wait_until_moving
from geometry_msgs.msg import Point, Pose, Quaternion
from support import HOME, wait_for

from ur_ros_rtde_msgs.action import (CheckJoints, CheckPose, GetCoriolisTorques, GetFlag, GetForwardKinematics, GetInteger,
                                     GetInverseKinematics, GetJacobian, GetJointPositionsHistory, GetJointValues, GetMassMatrix,
                                     GetNumber, GetPose, GetRegister, MakeReady, MoveJ, PoseTrans, SendScript)
from ur_ros_rtde_msgs.msg import ErrorCode

ELSEWHERE = [0.3, -1.2, 1.4, -1.1, -1.3, 0.5]
VELOCITIES = [0.3, -0.5, 0.7, 0.2, -0.9, 0.4]
TOOL = Pose(position=Point(x=0.05, y=-0.02, z=0.15), orientation=Quaternion(x=0.1, y=0.2, z=0.3, w=0.9))


def ask(robot, action, name, **fields):
    return robot.send(action, name, **fields).succeeded()


def six_by_six(result):
    return np.array(result.matrix).reshape(6, 6)


def test_forward_kinematics_is_that_of_the_dh_table(robot):
    at_flange = ask(robot, GetForwardKinematics, "get_forward_kinematics", joint_positions=ELSEWHERE).pose
    assert ur10e.matrix(at_flange) == pytest.approx(ur10e.flange(ELSEWHERE), abs=1e-6)
    at_tool = ask(robot, GetForwardKinematics, "get_forward_kinematics", joint_positions=ELSEWHERE, use_tcp=True, tcp=TOOL).pose
    assert ur10e.matrix(at_tool) == pytest.approx(ur10e.flange(ELSEWHERE) @ ur10e.matrix(TOOL), abs=1e-6)


def test_forward_kinematics_without_arguments_is_where_the_arm_is(robot):
    pose = ask(robot, GetForwardKinematics, "get_forward_kinematics").pose
    assert ur10e.matrix(pose) == pytest.approx(ur10e.flange(HOME), abs=2e-3)
    flange = ask(robot, GetPose, "get_actual_tool_flange_pose")
    assert flange.frame == "base" and ur10e.matrix(flange.pose) == pytest.approx(ur10e.flange(HOME), abs=2e-3)


def test_inverse_kinematics_leads_to_the_pose_by_the_nearest_solution(robot):
    pose = ask(robot, GetForwardKinematics, "get_forward_kinematics", joint_positions=ELSEWHERE).pose
    near = [value + 0.1 for value in ELSEWHERE]
    found = ask(robot, GetInverseKinematics, "get_inverse_kinematics", pose=pose, near=near).joint_positions
    assert list(found) == pytest.approx(ELSEWHERE, abs=1e-4)
    flipped = [0.3, -1.2, 1.4, -1.1 - np.pi, 1.3, 0.5 - np.pi]
    found = ask(robot, GetInverseKinematics, "get_inverse_kinematics", pose=pose, near=flipped).joint_positions
    assert ur10e.flange(found) == pytest.approx(ur10e.matrix(pose), abs=1e-6)
    assert abs(found[4] - 1.3) < 0.3, found


def test_a_pose_out_of_reach_has_no_solution_and_asking_for_one_harms_nothing(robot):
    far = Pose(position=Point(x=1.2, y=1.2, z=0.5))
    status, result = robot.send(GetInverseKinematics, "get_inverse_kinematics", pose=far).wait_for_result()
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, ErrorCode.UNREACHABLE)
    assert not ask(robot, CheckPose, "get_inverse_kinematics_has_solution", pose=far).value
    assert not ask(robot, CheckPose, "is_pose_within_safety_limits", pose=far).value
    here = ask(robot, GetForwardKinematics, "get_forward_kinematics").pose
    assert ask(robot, CheckPose, "get_inverse_kinematics_has_solution", pose=here).value
    assert ask(robot, CheckPose, "is_pose_within_safety_limits", pose=here).value
    assert ask(robot, CheckJoints, "is_joints_within_safety_limits", joint_positions=HOME).value


def test_pose_trans_chains(robot):
    base = Pose(position=Point(x=3.0, y=-4.0, z=5.0), orientation=Quaternion(x=-0.3, y=0.1, z=0.2, w=0.8))
    pose = ask(robot, PoseTrans, "pose_trans", p_from=base, p_from_to=TOOL).pose
    assert ur10e.matrix(pose) == pytest.approx(ur10e.matrix(base) @ ur10e.matrix(TOOL), abs=1e-6)


def test_the_jacobian_is_the_derivative_of_the_pose(robot):
    tool = ur10e.matrix(TOOL)
    asked = six_by_six(ask(robot, GetJacobian, "get_jacobian", joint_positions=ELSEWHERE, use_tcp=True, tcp=TOOL))
    assert asked == pytest.approx(ur10e.jacobian(ELSEWHERE, tool), abs=1e-5)
    change = six_by_six(ask(robot, GetJacobian, "get_jacobian_time_derivative", joint_positions=ELSEWHERE,
                            joint_velocities=VELOCITIES, use_tcp=True, tcp=TOOL))
    later, before = (ur10e.jacobian(np.array(ELSEWHERE) + sign * 1e-4 * np.array(VELOCITIES), tool) for sign in (1, -1))
    assert change == pytest.approx((later - before) / 2e-4, abs=1e-3)
    present = six_by_six(ask(robot, GetJacobian, "get_jacobian"))
    assert present == pytest.approx(ur10e.jacobian(HOME), abs=5e-3)


def test_mass_matrix_and_coriolis_torques_belong_to_one_arm(robot):
    def mass(q):
        return six_by_six(ask(robot, GetMassMatrix, "get_mass_matrix", joint_positions=list(q)))

    q, qd, step = np.array(ELSEWHERE), np.array(VELOCITIES), 1e-3
    here = mass(q)
    assert here == pytest.approx(here.T, abs=1e-9) and np.linalg.eigvalsh(here).min() > 0.0
    assert here[0, 0] > 5.0 > here[5, 5]
    slopes = [(mass(q + step * axis) - mass(q - step * axis)) / (2 * step) for axis in np.eye(6)]
    # Lagrange: dM/dt qd - 1/2 d(qd' M qd)/dq
    expected = sum(slope * rate for slope, rate in zip(slopes, qd)) @ qd - 0.5 * np.array([qd @ slope @ qd for slope in slopes])
    asked = ask(robot, GetCoriolisTorques, "get_coriolis_and_centrifugal_torques", joint_positions=list(q),
                joint_velocities=list(qd)).joint_torques
    assert list(asked) == pytest.approx(list(expected), abs=2e-3)


def test_joint_torques_are_those_of_a_push(robot, simulator):
    force = np.array([0.0, 20.0, 0.0])
    simulator.control("push", force=list(force), duration=4.0)  # it swells and ebbs
    expected = ur10e.jacobian(HOME)[:3].T @ force

    measured = []

    def agree():
        measured.append(np.array(ask(robot, GetJointValues, "get_joint_torques").values))
        return np.abs(measured[-1] - expected).max() < 3.0

    try:
        wait_for(agree, 5.0, f"the torques {expected}")
    except AssertionError as error:
        raise AssertionError(f"{error}, the last were {measured[-1]}") from None
    finally:
        simulator.control("clear_pushes")


def test_queries_are_answered_while_the_arm_moves(robot):
    motion = robot.send(MoveJ, "move_j", joint_positions=home_plus(1.2), speed=0.5, acceleration=1.0)
    wait_until_moving(robot, 0.2)
    waypoint = ask(robot, GetPose, "get_target_waypoint").pose
    assert ur10e.matrix(waypoint) == pytest.approx(ur10e.flange(home_plus(1.2)), abs=2e-3)
    assert not ask(robot, GetFlag, "is_steady").value
    progress = ask(robot, GetInteger, "get_async_operation_progress")
    assert progress.value == 0 and "waypoint" in progress.text
    assert ask(robot, GetFlag, "is_program_running").value
    past = ask(robot, GetJointPositionsHistory, "get_actual_joint_positions_history", steps=100).joint_positions
    assert 0.02 < get_joint_state(robot).position[0] - past[0] < 0.6
    ask(robot, GetJointValues, "get_target_joint_accelerations")
    motion.succeeded()
    assert ask(robot, GetInteger, "get_async_operation_progress").value == -1
    wait_for(lambda: ask(robot, GetFlag, "is_steady").value, 3.0, "the arm to be steady")
    assert list(ask(robot, GetJointValues, "get_target_joint_accelerations").values) == pytest.approx([0.0] * 6, abs=1e-9)


def test_step_time_and_status(robot):
    step = ask(robot, GetNumber, "get_step_time")
    assert (step.value, step.unit) == (pytest.approx(0.002), "s")
    status = ask(robot, GetInteger, "get_robot_status")
    assert (status.value, status.text) == (3, "power on, program running")


def test_output_registers_are_read_and_not_touched_by_queries(robot):
    ask(robot, SendScript, "send_secondary_script",
        script="write_output_integer_register(13, -42)\nwrite_output_float_register(14, 2.5)")
    ask(robot, GetMassMatrix, "get_mass_matrix")  # it has 36 values to give
    wait_for(lambda: ask(robot, GetRegister, "get_output_int_register", index=13).value == -42, 2.0, "the register")
    assert ask(robot, GetRegister, "get_output_double_register", index=14).value == 2.5


def test_nobody_answers_while_a_script_runs_in_place_of_the_control_program(robot, simulator):
    goal = robot.send(SendScript, "send_script", script='while True:\n  textmsg("here")\n  sleep(0.1)\nend', timeout=60.0)
    wait_for(lambda: goal.feedback, 10.0, "the script to run")
    refused = robot.send(GetFlag, "is_steady")
    assert not refused.accepted and robot.refusal(refused).error_code == ErrorCode.BUSY
    assert ask(robot, GetFlag, "is_program_running").value
    goal.cancel()
    assert goal.wait_for_result()[0] == GoalStatus.STATUS_CANCELED
    assert ask(robot, GetFlag, "is_steady").success


def test_nobody_answers_in_a_protective_stop(robot, simulator):
    simulator.control("protective_stop", reason="a test")
    wait_for(lambda: simulator.state()["safety_mode"] == "PROTECTIVE_STOP", 5.0, "the stop")

    def reason():
        goal = robot.send(GetPose, "get_tcp_offset")
        return None if goal.accepted else robot.refusal(goal).error_code

    wait_for(lambda: reason() == ErrorCode.PROTECTIVE_STOP, 5.0, "the refusal")
    robot.send(MakeReady, "make_ready").succeeded()
    assert ask(robot, GetPose, "get_tcp_offset").frame == "tool0_controller"
