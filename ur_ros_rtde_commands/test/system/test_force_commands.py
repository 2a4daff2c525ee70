"""Tests of force mode, freedrive, teach mode, joint torques and external sensors, with the simulator's physics."""

import math

import pytest
from action_msgs.msg import GoalStatus
from arm_state import get_joint_state, get_tcp_pose, home_plus, is_at_rest, wait_until_moving
from control_msgs.action import FollowJointTrajectory
from geometry_msgs.msg import Point, Pose, Twist, Vector3, Wrench
from sensor_msgs.msg import JointState
from support import JOINTS, wait_for
from trajectories import point, timed

from ur_ros_rtde_msgs.action import (
    DirectTorque,
    EnableExternalFtSensor,
    ForceMode,
    Freedrive,
    GetFlag,
    GetInverseKinematics,
    GetPose,
    MoveJ,
    MoveL,
    MoveP,
    SendScript,
    ServoL,
    SetExternalForceTorque,
    SetForceModeParameter,
    SetGravity,
    SetPayload,
    SetTargetPayload,
    SetTcp,
    SpeedL,
    TeachMode,
    Trigger,
    ZeroFtSensor,
)
from ur_ros_rtde_msgs.msg import ActiveModes, ErrorCode

ALONG_Z = [False, False, True, False, False, False]


def down(force):
    return Wrench(force=Vector3(z=-force))


def press(robot, simulator, force, **fields):
    """Activates force mode toward a surface 5 mm below the TCP and waits until the contact force reaches `force` in N."""
    robot.send(ZeroFtSensor, "zero_ft_sensor").succeeded()
    simulator.control("place_surface", z=get_tcp_pose(robot).position.z - 0.005, stiffness=20000.0)
    goal = robot.send(ForceMode, "force_mode", task_frame=Pose(), compliant=ALONG_Z, wrench=down(force),
                      limits=[0.1, 0.1, 0.03, 0.5, 0.5, 0.5], **fields)

    def force_is_reached():
        return goal.feedback and goal.feedback[-1].wrench.force.z == pytest.approx(force, abs=0.15 * force)

    assert goal.accepted, robot.rejection(goal).message
    wait_for(force_is_reached, 15.0, f"{force} N, now {[round(f.wrench.force.z, 1) for f in goal.feedback[-5:]]}")
    return goal


def test_force_mode_applies_the_wrench_until_it_is_canceled(robot, simulator):
    before = get_tcp_pose(robot).position
    goal = press(robot, simulator, 20.0)
    assert simulator.state()["force_mode"]
    goal.cancel()
    status, result = goal.wait_for_result()
    assert (status, result.success) == (GoalStatus.STATUS_SUCCEEDED, True), result.message
    assert not simulator.state()["force_mode"] and is_at_rest(robot)
    after = get_tcp_pose(robot).position
    assert (after.x, after.y) == pytest.approx((before.x, before.y), abs=0.003)
    assert before.z - after.z == pytest.approx(0.005, abs=0.003)


def test_force_mode_ends_after_its_duration(robot, simulator):
    goal = robot.send(ForceMode, "force_mode", compliant=ALONG_Z, wrench=down(5.0), limits=[0.1, 0.1, 0.02, 0.5, 0.5, 0.5],
                      duration=1.0)
    goal.succeeded()
    assert not simulator.state()["force_mode"] and is_at_rest(robot)
    progress = [feedback.motion.progress for feedback in goal.feedback]
    assert progress == sorted(progress) and 0.0 < progress[-1] <= 1.0


def test_a_protective_stop_ends_force_mode(robot, simulator):
    goal = press(robot, simulator, 20.0)
    simulator.control("protective_stop", reason="a test")
    status, result = goal.wait_for_result()
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, ErrorCode.PROTECTIVE_STOP)
    assert not simulator.state()["force_mode"]
    simulator.control("clear_surfaces")
    wait_for(simulator.unlock_protective_stop, 15.0, "the protective stop to be unlocked")


def test_force_mode_can_be_changed_during_a_motion_along_a_surface(robot, simulator):
    robot.send(ZeroFtSensor, "zero_ft_sensor").succeeded()
    simulator.control("place_surface", z=get_tcp_pose(robot).position.z - 0.005, stiffness=20000.0)
    fields = dict(compliant=ALONG_Z, limits=[0.1, 0.1, 0.03, 0.5, 0.5, 0.5])

    def pressing(force):
        return simulator.state()["contact_wrench"][2] == pytest.approx(force, abs=5.0)

    robot.send(ForceMode, "force_mode_start", wrench=down(15.0), **fields).succeeded()
    wait_for(lambda: pressing(15.0) and is_at_rest(robot), 10.0, "15 N")
    target = get_tcp_pose(robot)
    target.position.y += 0.1
    motion = robot.send(MoveL, "move_l", pose=target, speed=0.02)
    wait_until_moving(robot, 0.01)
    rejected = robot.send(Trigger, "force_mode_stop")
    assert not rejected.accepted and robot.rejection(rejected).error_code == ErrorCode.BUSY
    robot.send(ForceMode, "force_mode_start", wrench=down(30.0), **fields).succeeded()
    motion.succeeded()
    assert get_tcp_pose(robot).position.y == pytest.approx(target.position.y, abs=0.002)
    assert simulator.state()["force_mode"] and pressing(30.0), "a successful motion leaves force mode active"
    robot.send(Trigger, "force_mode_stop").succeeded()
    assert not simulator.state()["force_mode"] and is_at_rest(robot)


@pytest.mark.parametrize("force", [30.0, 2.0])
@pytest.mark.parametrize("action, name, fields", [(MoveL, "move_l", {"speed": 0.05}), (ServoL, "servo_l", {"time": 1.0})])
def test_a_motion_in_force_mode_ends_with_its_path(robot, simulator, action, name, fields, force):
    """A surface keeps the arm from its target, or nothing keeps it from drifting."""
    robot.send(ZeroFtSensor, "zero_ft_sensor").succeeded()
    target = get_tcp_pose(robot)
    if force > 10.0:
        simulator.control("place_surface", z=target.position.z - 0.005, stiffness=20000.0)
    robot.send(ForceMode, "force_mode_start", compliant=ALONG_Z, wrench=down(force), limits=[0.1, 0.1, 0.02, 0.5, 0.5, 0.5]).succeeded()
    wait_for(lambda: get_tcp_pose(robot).position.z < target.position.z - 0.004, 10.0, "the arm to follow the force")
    target.position.y += 0.02
    robot.send(action, name, pose=target, **fields).succeeded(15.0)
    assert get_tcp_pose(robot).position.y == pytest.approx(target.position.y, abs=0.003)
    assert get_tcp_pose(robot).position.z < target.position.z - 0.003
    assert simulator.state()["force_mode"], "a successful motion leaves force mode active"
    robot.send(Trigger, "force_mode_stop").succeeded()
    assert not simulator.state()["force_mode"] and is_at_rest(robot)


CHANGES_THE_FORCE = {
    "set_payload": (SetPayload, {"mass": 1.0}),
    "set_target_payload": (SetTargetPayload, {"mass": 1.0}),
    "set_tcp": (SetTcp, {"pose": Pose(position=Point(z=0.1))}),
    "set_gravity": (SetGravity, {"direction": Vector3(z=9.82)}),
    "zero_ft_sensor": (ZeroFtSensor, {}),
    "enable_external_ft_sensor": (EnableExternalFtSensor, {"enable": True}),
    "ft_rtde_input_enable": (EnableExternalFtSensor, {"enable": True}),
}


def test_what_would_change_the_force_or_end_force_mode_is_rejected_during_it(robot, simulator):
    robot.send(ForceMode, "force_mode_start", compliant=ALONG_Z, limits=[0.1, 0.1, 0.02, 0.5, 0.5, 0.5]).succeeded()
    scripts = {"move_p": (MoveP, {"poses": [get_tcp_pose(robot)]}), "send_script": (SendScript, {"script": "sleep(0.1)"})}
    for name, (action, fields) in {**CHANGES_THE_FORCE, **scripts}.items():
        goal = robot.send(action, name, **fields)
        assert not goal.accepted, name
        rejection = robot.rejection(goal)
        assert rejection.error_code == ErrorCode.BUSY and f"force mode is active, and /{name} would" in rejection.message, rejection
    assert simulator.state()["force_mode"]
    robot.send(Trigger, "force_mode_stop").succeeded()
    robot.send(SendScript, "send_script", script="sleep(0.1)").succeeded()


def test_servo_l_does_not_begin_faster_than_the_tcp_may_move_when_force_mode_moves_the_arm(robot):
    robot.send(ZeroFtSensor, "zero_ft_sensor").succeeded()
    robot.send(ForceMode, "force_mode_start", compliant=ALONG_Z, wrench=down(2.0), limits=[0.1, 0.1, 0.02, 0.5, 0.5, 0.5]).succeeded()
    wait_until_moving(robot, 0.012)
    target = get_tcp_pose(robot)
    target.position.y += 0.3
    _, result = robot.send(ServoL, "servo_l", pose=target, time=0.01).wait_for_result()
    assert result.error_code == ErrorCode.INVALID_GOAL and "use a time of at least" in result.message, result.message
    assert abs(get_tcp_pose(robot).position.y - target.position.y) > 0.29


def test_a_trajectory_does_not_begin_away_from_where_it_was_planned(robot):
    robot.send(ZeroFtSensor, "zero_ft_sensor").succeeded()
    trajectory = timed(point(1.0, home_plus(0.1), [0.0] * 6))
    trajectory.header.stamp = robot.node.get_clock().now().to_msg()
    trajectory.header.stamp.sec += 4
    goal = robot.send(FollowJointTrajectory, "follow_joint_trajectory", trajectory=trajectory)
    assert goal.accepted
    robot.send(ForceMode, "force_mode_start", compliant=ALONG_Z, wrench=down(5.0), limits=[0.1, 0.1, 0.05, 0.5, 0.5, 0.5]).succeeded()
    status, result = goal.wait_for_result(20.0)
    assert status == GoalStatus.STATUS_ABORTED and "since this motion was planned" in result.error_string, result.error_string
    assert result.error_code == FollowJointTrajectory.Result.INVALID_GOAL
    assert abs(get_joint_state(robot).position[0]) < 0.01


def test_force_mode_that_is_started_during_a_motion_outlasts_it(robot, simulator):
    motion = robot.send(MoveJ, "move_j", joint_positions=home_plus(0.5), speed=0.3)
    wait_until_moving(robot)
    slow = [0.1, 0.1, 0.001, 0.5, 0.5, 0.5]  # so that the force does not keep the arm from its target
    robot.send(ForceMode, "force_mode_start", compliant=ALONG_Z, limits=slow).succeeded()
    motion.succeeded()
    assert simulator.state()["force_mode"], "the motion has ended the mode of another goal"
    robot.send(Trigger, "force_mode_stop").succeeded()
    assert not simulator.state()["force_mode"] and is_at_rest(robot)


def test_a_velocity_ends_while_force_mode_goes_on_moving_the_arm(robot, simulator):
    robot.send(ZeroFtSensor, "zero_ft_sensor").succeeded()
    robot.send(ForceMode, "force_mode_start", compliant=ALONG_Z, wrench=down(2.0), limits=[0.1, 0.1, 0.02, 0.5, 0.5, 0.5]).succeeded()
    wait_until_moving(robot, 0.005)
    before, begin = get_tcp_pose(robot).position, simulator.state()["timestamp"]
    robot.send(SpeedL, "speed_l", twist=Twist(linear=Vector3(y=0.05)), time=0.5).succeeded()
    assert simulator.state()["timestamp"] - begin < 1.5
    assert simulator.state()["force_mode"], "force mode ends with its program"
    assert not is_at_rest(robot), "in the air, the force moves the arm"
    assert get_tcp_pose(robot).position.y - before.y == pytest.approx(0.025, abs=0.01)
    robot.send(Trigger, "force_mode_stop").succeeded()
    assert not simulator.state()["force_mode"] and is_at_rest(robot)


def test_canceling_a_motion_ends_force_mode(start_slow_robot):
    robot, driver, simulator = start_slow_robot("force_mode_start")
    robot.send(ForceMode, "force_mode_start", compliant=ALONG_Z, limits=[0.1, 0.1, 0.02, 0.5, 0.5, 0.5]).succeeded()
    motion = robot.send(MoveJ, "move_j", joint_positions=home_plus(1.0), speed=0.3)
    wait_until_moving(robot)
    log = len(driver.lines)
    motion.cancel()
    assert motion.wait_for_result()[0] == GoalStatus.STATUS_CANCELED
    assert not simulator.state()["force_mode"] and is_at_rest(robot)
    assert simulator.state()["program"]["state"] == "PLAYING"
    assert not any("program" in line for line in driver.lines[log:]), "the control program was started again"


def test_sets_damping_and_gain_scaling_within_their_ranges(robot):
    robot.send(SetForceModeParameter, "force_mode_set_damping", value=0.5).succeeded()
    robot.send(SetForceModeParameter, "force_mode_set_gain_scaling", value=1.5).succeeded()
    for name, value in (("force_mode_set_damping", 1.5), ("force_mode_set_gain_scaling", 2.5)):
        rejected = robot.send(SetForceModeParameter, name, value=value)
        assert not rejected.accepted and "value" in robot.rejection(rejected).message


@pytest.mark.parametrize("action,name", [(Freedrive, "freedrive"), (TeachMode, "teach_mode")])
def test_the_arm_yields_to_a_push_in_freedrive_and_is_at_rest_afterwards(robot, simulator, action, name):
    goal = robot.send(action, name)
    wait_for(lambda: goal.accepted and simulator.state()["freedrive"], 10.0, "freedrive")
    before = get_tcp_pose(robot).position
    simulator.control("push", force=[0.0, 60.0, 0.0], duration=3.0)
    wait_for(lambda: abs(get_tcp_pose(robot).position.y - before.y) > 0.02, 10.0, "the arm to yield to the push")
    goal.cancel()
    assert goal.wait_for_result()[0] == GoalStatus.STATUS_SUCCEEDED
    assert not simulator.state()["freedrive"]
    wait_for(lambda: is_at_rest(robot), 15.0, "standstill")


@pytest.mark.parametrize("start,stop,action", [("freedrive_start", "freedrive_stop", Freedrive),
                                               ("teach_mode_start", "end_teach_mode", TeachMode)])
def test_motions_are_rejected_in_freedrive(robot, simulator, start, stop, action):
    modes = robot.subscribe(ActiveModes, "active_modes", transient_local=True)
    robot.send(action, start).succeeded()
    assert simulator.state()["freedrive"]
    wait_for(lambda: modes and modes[-1].names == [stop.removesuffix("_stop").removeprefix("end_")], 10.0, "the mode on active_modes")
    rejected = robot.send(MoveJ, "move_j", joint_positions=home_plus(0.1))
    assert not rejected.accepted and robot.rejection(rejected).error_code == ErrorCode.BUSY
    rejected = robot.send(Trigger, "force_mode_stop")  # it would decelerate the arm in the hands of the operator
    assert not rejected.accepted and robot.rejection(rejected).error_code == ErrorCode.BUSY
    robot.send(Trigger, stop).succeeded()
    assert not simulator.state()["freedrive"]
    wait_for(lambda: not modes[-1].names, 10.0, "its end on active_modes")
    robot.send(MoveJ, "move_j", joint_positions=home_plus(0.1)).succeeded()


def test_the_end_of_teach_mode_does_not_end_freedrive(robot, simulator):
    robot.send(Freedrive, "freedrive_start").succeeded()
    goal = robot.send(Trigger, "end_teach_mode")
    assert not goal.accepted
    assert "the arm is in freedrive, which freedrive_stop ends" in robot.rejection(goal).message
    assert simulator.state()["freedrive"]
    robot.send(Trigger, "freedrive_stop").succeeded()


def test_teleoperation_leaves_freedrive_to_the_operator(robot, driver, simulator):
    robot.send(Freedrive, "freedrive_start").succeeded()
    publisher = robot.node.create_publisher(JointState, "servo_joint", 1)
    wait_for(lambda: publisher.get_subscription_count() > 0, 10.0, "a subscription of servo_joint")
    message = JointState(name=JOINTS, position=home_plus(0.1))
    wait_for(lambda: publisher.publish(message) or any("servo_joint: messages are ignored" in line for line in list(driver.lines)),
             10.0, "a rejection in the log")
    assert any("freedrive or teach mode" in line for line in driver.lines if "servo_joint" in line), driver.output()
    assert simulator.state()["freedrive"]
    assert simulator.is_at_rest()
    robot.node.destroy_publisher(publisher)
    robot.send(Trigger, "freedrive_stop").succeeded()
    assert not simulator.state()["freedrive"]


def test_direct_torque_moves_a_joint_and_stops(robot):
    before = get_joint_state(robot).position[0]
    robot.send(DirectTorque, "direct_torque", joint_torques=[15.0, 0.0, 0.0, 0.0, 0.0, 0.0], duration=0.3,
               max_joint_speed=3.0).succeeded()
    assert get_joint_state(robot).position[0] > before + 0.01 and is_at_rest(robot)


def test_direct_torque_aborts_when_a_joint_exceeds_max_joint_speed(robot):
    status, result = robot.send(DirectTorque, "direct_torque", joint_torques=[20.0, 0.0, 0.0, 0.0, 0.0, 0.0], duration=20.0,
                                max_joint_speed=0.3).wait_for_result()
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, ErrorCode.SAFETY_VIOLATION), result.message
    assert "max_joint_speed" in result.message
    wait_for(lambda: is_at_rest(robot), 15.0, "standstill")


def test_direct_torque_rejects_more_than_the_joints_of_this_arm_can_apply(robot):
    goal = robot.send(DirectTorque, "direct_torque", joint_torques=[0.0, 0.0, 0.0, 0.0, 0.0, 60.0], duration=0.1, max_joint_speed=1.0)
    assert not goal.accepted
    assert "wrist_3_joint" in robot.rejection(goal).message and "54 Nm" in robot.rejection(goal).message


# They are answered by the control program.
QUERIES = {"get_inverse_kinematics": GetInverseKinematics, "get_tcp_offset": GetPose, "is_steady": GetFlag}


def test_queries_are_rejected_during_direct_torque_and_answered_afterwards(robot, simulator):
    fields = {name: {} for name in QUERIES}
    fields["get_inverse_kinematics"] = {"pose": get_tcp_pose(robot)}
    for name, action in QUERIES.items():  # their servers are known from now on
        robot.send(action, name, **fields[name]).succeeded()
    torque = robot.send(DirectTorque, "direct_torque", joint_torques=[0.0] * 6, duration=30.0, max_joint_speed=3.0)
    torque.wait_until(lambda: torque.feedback, 10.0, "the torques")
    for name, action in QUERIES.items():
        rejected = robot.send(action, name, **fields[name])
        assert not rejected.accepted, f"{name}: {rejected.result().message}"
        rejection = robot.rejection(rejected)
        assert rejection.error_code == ErrorCode.BUSY and "direct_torque occupies every cycle" in rejection.message, rejection
    assert robot.send(GetFlag, "is_program_running").succeeded().value, "the driver knows this without the control program"
    assert not torque.is_finished() and simulator.state()["program"]["state"] == "PLAYING"
    torque.cancel()
    assert torque.wait_for_result()[0] == GoalStatus.STATUS_CANCELED

    def accepted():
        """The end of the torques has ended the control program, which is started again."""
        query = robot.send(GetFlag, "is_steady")
        assert query.accepted or robot.rejection(query).error_code != ErrorCode.BUSY, robot.rejection(query).message
        return query.accepted

    wait_for(accepted, 15.0, "the control program")
    for name, action in QUERIES.items():
        robot.send(action, name, **fields[name]).succeeded()


def test_uses_the_readings_of_an_external_sensor(robot, simulator):
    robot.send(EnableExternalFtSensor, "ft_rtde_input_enable", enable=True, sensor_mass=0.0).succeeded()
    assert simulator.state()["external_sensor"]
    robot.send(SetExternalForceTorque, "set_external_force_torque", wrench=Wrench(force=Vector3(z=12.0))).succeeded()
    wait_for(lambda: math.hypot(*simulator.state()["actual_tcp_force"][:3]) == pytest.approx(12.0, abs=2.0), 15.0,
             "the force of the external sensor")
    robot.send(EnableExternalFtSensor, "ft_rtde_input_enable", enable=False).succeeded()
    assert not simulator.state()["external_sensor"]
