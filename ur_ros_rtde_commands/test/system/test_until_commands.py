"""Motions that end on contact, force or torque, and contact detection."""

import functools

import pytest
from action_msgs.msg import GoalStatus
from arm_state import get_joint_speed
from geometry_msgs.msg import Twist, Vector3
from robot_fixtures import send_after_stop
from support import HOME, wait_for

from ur_ros_rtde_msgs.action import ContactDetection, MoveJ, MoveUntilContact, MoveUntilForce, SpeedL, ToolContact
from ur_ros_rtde_msgs.msg import ErrorCode
from ur_ros_rtde_msgs.srv import GetTcpPose

TABLE = 0.6  # m, height of the table; the TCP is at 0.677 m at home
DOWN = Twist(linear=Vector3(z=-0.05))
SLOWLY_DOWN = Twist(linear=Vector3(z=-0.02))  # slow enough to push the arm during the motion


def height_now(client):
    return client.call(GetTcpPose, "get_tcp_pose").tcp_pose.pose.position.z


@pytest.fixture
def table(simulator, robot):
    simulator.control("place_surface", z=TABLE)
    yield TABLE
    simulator.control("clear_surfaces")


def test_move_until_contact_retracts_to_the_contact(robot, table):
    result = robot.send(MoveUntilContact, "move_until_contact", twist=DOWN, distance=0.3, timeout=15.0).succeeded()
    assert result.contact
    assert result.contact_state.tcp_pose.position.z == pytest.approx(table, abs=0.002)
    assert result.final_state.tcp_pose.position.z == pytest.approx(table, abs=0.002)
    assert list(result.contact_state.joint_positions) == pytest.approx(list(result.final_state.joint_positions), abs=0.01)
    assert result.contact_state.tcp_pose.orientation.x == pytest.approx(result.final_state.tcp_pose.orientation.x, abs=0.01)


def test_move_until_contact_without_retract_stays_at_the_stop_position(robot, table):
    result = robot.send(MoveUntilContact, "move_until_contact", twist=DOWN, distance=0.3, timeout=15.0,
                        retract=False).succeeded()
    assert result.contact
    assert result.final_state.tcp_pose.position.z < result.contact_state.tcp_pose.position.z


def test_move_until_contact_ignores_contacts_in_other_directions(robot, simulator):
    goal = robot.send(MoveUntilContact, "move_until_contact", twist=SLOWLY_DOWN, direction=Vector3(x=1.0), distance=0.1,
                      timeout=15.0)
    wait_for(lambda: get_joint_speed(robot) > 0.01, 10.0, "the arm to move")
    simulator.control("push", force=[0, 0, 30], duration=0.3)
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_ABORTED and not result.contact
    assert result.error_code == ErrorCode.NOT_REACHED, result.message


# The arm of move_until_force goes on while the host is late, in 0.75 s by 15 mm.
@pytest.mark.parametrize("fields, code", [({"distance": 0.05, "timeout": 20.0}, ErrorCode.NOT_REACHED),
                                          ({"distance": 0.5, "timeout": 2.0}, ErrorCode.TIMEOUT)])
@pytest.mark.parametrize("action, name, more", [(MoveUntilContact, "move_until_contact", {}),
                                                (MoveUntilForce, "move_until_force", {"threshold": 50.0})])
def test_without_contact_the_motion_stops_after_distance_or_timeout(robot, action, name, more, fields, code):
    start = height_now(robot)
    status, result = robot.send(action, name, twist=SLOWLY_DOWN, **fields, **more).wait_for_result()
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == code, result.message
    assert get_joint_speed(robot) < 0.01
    expected = min(fields["distance"], -SLOWLY_DOWN.linear.z * fields["timeout"])
    assert start - result.final_state.tcp_pose.position.z == pytest.approx(expected, abs=0.015)
    # The search of move_until_contact is a script: the control program is restored before its result, however late the host is.
    send = robot.send if action is MoveUntilContact else functools.partial(send_after_stop, robot)
    send(MoveJ, "move_j", joint_positions=HOME, speed=1.0).succeeded()


def test_canceling_move_until_contact_stops_the_arm(robot):
    goal = robot.send(MoveUntilContact, "move_until_contact", twist=DOWN, distance=0.5, timeout=30.0)
    wait_for(lambda: get_joint_speed(robot) > 0.01, 10.0, "the arm to move")
    goal.cancel()
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_CANCELED and result.error_code == ErrorCode.CANCELED
    assert get_joint_speed(robot) < 0.01 and height_now(robot) > 0.4


def test_move_until_force_ignores_other_axes(robot, simulator):
    goal = robot.send(MoveUntilForce, "move_until_force", twist=SLOWLY_DOWN, axes=[True, False, False], frame=0, threshold=15.0,
                      distance=0.1, timeout=15.0)
    wait_for(lambda: get_joint_speed(robot) > 0.01, 10.0, "the arm to move")
    simulator.control("push", force=[0, 40, 0], duration=0.4)
    assert goal.wait_for_result()[1].error_code == ErrorCode.NOT_REACHED


def test_move_until_torque_stops_at_the_threshold(robot, simulator):
    goal = robot.send(MoveUntilForce, "move_until_torque", twist=SLOWLY_DOWN, threshold=3.0,
                      distance=0.3, timeout=15.0)
    wait_for(lambda: get_joint_speed(robot) > 0.01, 10.0, "the arm to move")
    simulator.control("push", wrench=[0, 0, 0, 6, 0, 0], duration=2.0)
    result = goal.succeeded()
    magnitude = (result.measured.x ** 2 + result.measured.y ** 2 + result.measured.z ** 2) ** 0.5
    assert magnitude == pytest.approx(3.0, abs=0.7)


def test_move_until_force_measures_relative_to_the_initial_force(robot, simulator):
    simulator.control("push", force=[0, 0, 60], duration=60.0)
    # At 8 s of a half-sine over 60 s: about 24 N, rising by 3 N/s.
    simulator.wait(8.0, 30.0)
    status, result = robot.send(MoveUntilForce, "move_until_force", twist=DOWN, threshold=15.0, distance=0.03,
                                timeout=10.0).wait_for_result()
    assert result.error_code == ErrorCode.NOT_REACHED, result.message


@pytest.mark.parametrize("fields", [{"axes": [False, False, False]}, {"threshold": 0.0}, {"distance": float("nan")},
                                    {"frame": 2}])
def test_move_until_force_rejects_goals_that_could_not_end(robot, fields):
    goal = robot.send(MoveUntilForce, "move_until_force", twist=DOWN, **fields)
    assert not goal.accepted and next(iter(fields)) in robot.rejection(goal).message


def test_tool_contact_reports_a_contact_in_its_direction(robot, simulator):
    down = Twist(linear=Vector3(z=-1.0))
    assert not robot.send(ToolContact, "tool_contact", direction=down).succeeded().contact
    simulator.control("push", force=[0, 0, 60], duration=4.0)

    def find_contact():
        result = robot.send(ToolContact, "tool_contact", direction=down).succeeded()
        return result if result.contact else None

    assert wait_for(find_contact, 3.0, "the contact").steps > 0
    assert not robot.send(ToolContact, "tool_contact", direction=Twist(linear=Vector3(z=1.0))).succeeded().contact


def test_contact_detection_detects_a_contact_during_another_goal(robot, table):
    detection = robot.send(ContactDetection, "contact_detection", timeout=20.0)
    motion = robot.send(SpeedL, "speed_l", twist=DOWN, time=1.7)
    result = detection.succeeded()
    assert 0.5 < result.after < 20.0
    motion.wait_for_result()


def test_contact_detection_times_out(robot):
    status, result = robot.send(ContactDetection, "contact_detection", timeout=0.5).wait_for_result()
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == ErrorCode.TIMEOUT
