"""Tests the commands of the Robotiq gripper with the simulated URCap."""

import pytest
from programs import Simulator, start_node
from robot_fixtures import make_ready
from ros_client import Client
from support import wait_for
from ur_ros_rtde_gripper_commands.action import RobotiqActivate, RobotiqGetStatus, RobotiqGrip, RobotiqMove

from ur_ros_rtde_msgs.action import MoveJ
from ur_ros_rtde_msgs.msg import ErrorCode

PLUGINS = "plugins:=[move_j,stop,robotiq_activate,robotiq_move,robotiq_open,robotiq_close,robotiq_get_status]"
STROKE = 0.085  # m
CLOSED = 227  # register POS of the closed fingers
STEP = STROKE / CLOSED  # m, resolution of the gripper


def registers(simulator):
    return simulator.state()["robotiq_gripper"]


def open_and_active(simulator):
    """Returns whether the simulated gripper is open. Sends no command of the driver."""
    state = registers(simulator)
    return state["STA"] == 3 and state["POS"] == 0 and state["OBJ"] == 3


@pytest.fixture
def gripper(simulator, robot):
    """A client of a robot with an active, open and empty gripper."""
    simulator.control("robotiq_gripper", stuck=False, object=0.0, fault=0, activate=True)
    robot.send(RobotiqGrip, "robotiq_open").succeeded()
    return robot


def test_activation_moves_the_fingers_once(robot, simulator):
    simulator.control("robotiq_gripper", stuck=False, object=0.0, fault=0)
    goal = robot.send(RobotiqActivate, "robotiq_activate", reset=True)
    goal.succeeded()
    assert open_and_active(simulator) and max(feedback.position for feedback in goal.feedback) > 200
    again = robot.send(RobotiqActivate, "robotiq_activate")
    assert "active already" in again.succeeded().message
    wait_for(lambda: again.feedback, 10.0, "the feedback, which may come after the result")
    assert max(feedback.position for feedback in again.feedback) == 0


def test_moves_to_the_width_at_the_speed(gripper, simulator):
    begin = simulator.state()["timestamp"]
    result = gripper.send(RobotiqMove, "robotiq_move", width=0.025, speed_fraction=0.0).succeeded()
    duration = simulator.state()["timestamp"] - begin
    assert result.width == pytest.approx(0.025, abs=STEP) and not result.object_detected
    assert registers(simulator)["POS"] == result.position == 160
    assert duration > 0.06 / 0.02  # 60 mm at 20 mm/s, the slowest speed
    assert registers(simulator)["SPE"] == 0 and registers(simulator)["FOR"] == 128


def test_closes_completely(gripper, simulator):
    result = gripper.send(RobotiqGrip, "robotiq_close").succeeded()
    assert registers(simulator)["PRE"] == 255 and result.position == CLOSED
    assert result.width == 0.0 and not result.object_detected


def test_detects_an_object(gripper, simulator):
    simulator.control("robotiq_gripper", object=40.0)
    result = gripper.send(RobotiqGrip, "robotiq_close").succeeded()
    assert result.object_detected and result.width == pytest.approx(0.04, abs=STEP)
    # The contact of the motion before is not taken for the end of this one.
    opened = gripper.send(RobotiqGrip, "robotiq_open").succeeded()
    assert not opened.object_detected and opened.width == STROKE


def test_force_compresses_a_soft_object(gripper, simulator):
    simulator.control("robotiq_gripper", object=40.0, stiffness=20000.0)
    gentle = gripper.send(RobotiqGrip, "robotiq_close", force_fraction=0.0).succeeded().width
    firm = gripper.send(RobotiqGrip, "robotiq_close", force_fraction=1.0).succeeded().width
    assert gentle - firm == pytest.approx((235.0 - 20.0) / 20000.0, abs=2 * STEP)


def test_cancel_stops_the_fingers(gripper, simulator):
    goal = gripper.send(RobotiqGrip, "robotiq_close", speed_fraction=0.0)
    wait_for(lambda: registers(simulator)["POS"] > 50, 20.0, "the fingers to move")
    goal.cancel()
    assert goal.result().error_code == ErrorCode.CANCELED
    stopped = registers(simulator)
    assert stopped["GTO"] == 0 and stopped["POS"] < CLOSED
    assert goal.result().width == pytest.approx(STROKE - stopped["POS"] * STEP, abs=0.005)


def test_after_a_cancel_it_is_unknown_whether_an_object_is_held(gripper, simulator):
    simulator.control("robotiq_gripper", object=40.0)
    gripper.send(RobotiqGrip, "robotiq_close").succeeded()
    assert gripper.send(RobotiqGetStatus, "robotiq_get_status").succeeded().object_detected
    opening = gripper.send(RobotiqGrip, "robotiq_open", speed_fraction=0.0)
    wait_for(lambda: registers(simulator)["POS"] < 100, 20.0, "the fingers to move")
    opening.cancel()
    assert opening.result().error_code == ErrorCode.CANCELED
    assert not gripper.send(RobotiqGetStatus, "robotiq_get_status").succeeded().object_detected


def test_the_range_of_the_fingers_is_that_of_the_gripper_in_use(gripper, simulator):
    result = gripper.send(RobotiqMove, "robotiq_move", width=0.02, stroke=0.05, closed_position=255).succeeded()
    assert registers(simulator)["PRE"] == result.position == 153
    assert result.width == pytest.approx(0.02)


def test_gripper_and_arm_move_together_but_not_two_gripper_goals(gripper, simulator):
    arm = gripper.send(MoveJ, "move_j", joint_positions=[0.5, -1.57, 1.57, -1.57, -1.57, 0.0], speed=0.3)
    closing = gripper.send(RobotiqGrip, "robotiq_close", speed_fraction=0.0)
    assert arm.accepted and closing.accepted
    second = gripper.send(RobotiqGrip, "robotiq_open")
    assert not second.accepted
    rejection = gripper.rejection(second)
    assert rejection.error_code == ErrorCode.BUSY and "robotiq_close" in rejection.message, rejection.message
    assert gripper.send(RobotiqGetStatus, "robotiq_get_status").succeeded().active
    closing.succeeded()
    arm.succeeded()


def test_a_motion_of_an_inactive_gripper_names_the_remedy(gripper, simulator):
    simulator.control("power", to="off")
    wait_for(lambda: not registers(simulator)["powered"], 10.0, "the gripper to lose its supply")
    status = gripper.send(RobotiqGetStatus, "robotiq_get_status")
    result = status.result()
    assert result.error_code == ErrorCode.NOT_READY and "powered on" in result.message, result.message
    simulator.control("power", to="running")
    wait_for(lambda: registers(simulator)["powered"], 10.0, "the supply of the gripper")
    make_ready(gripper)
    result = gripper.send(RobotiqGrip, "robotiq_close").result()
    assert result.error_code == ErrorCode.NOT_READY and "send robotiq_activate" in result.message, result.message
    assert registers(simulator)["POS"] == 0


@pytest.mark.parametrize("fault, mentions", [(8, "cool down"), (10, "24 V"), (14, "overcurrent"), (13, "blocks the fingers")])
def test_a_fault_during_a_motion_is_reported_with_cause_and_remedy(gripper, simulator, fault, mentions):
    goal = gripper.send(RobotiqGrip, "robotiq_close", speed_fraction=0.0)
    wait_for(lambda: registers(simulator)["POS"] > 20, 20.0, "the fingers to move")
    simulator.control("robotiq_gripper", fault=fault)
    result = goal.result()
    assert result.error_code == ErrorCode.REJECTED_BY_ROBOT, result.message
    assert f"fault {fault} " in result.message and mentions in result.message, result.message
    status = gripper.send(RobotiqGetStatus, "robotiq_get_status").succeeded()
    assert status.fault == fault and mentions in status.fault_text
    if fault < 10:
        simulator.control("robotiq_gripper", fault=0)
    gripper.send(RobotiqActivate, "robotiq_activate", reset=True).succeeded()
    gripper.send(RobotiqGrip, "robotiq_close").succeeded()


def test_a_gripper_that_is_too_slow_times_out_and_stops(gripper, simulator):
    result = gripper.send(RobotiqGrip, "robotiq_close", speed_fraction=0.0, timeout=0.5).result()
    assert result.error_code == ErrorCode.TIMEOUT and "speed_fraction" in result.message, result.message
    assert registers(simulator)["GTO"] == 0


def test_an_activation_that_is_blocked_times_out(gripper, simulator):
    simulator.control("robotiq_gripper", fault=13)
    result = gripper.send(RobotiqActivate, "robotiq_activate", timeout=15.0).succeeded()
    assert result.success  # the reset clears the fault
    goal = gripper.send(RobotiqActivate, "robotiq_activate", reset=True)
    wait_for(lambda: registers(simulator)["STA"] == 1, 10.0, "the activation")
    simulator.control("robotiq_gripper", fault=13)
    result = goal.result()
    assert result.error_code == ErrorCode.REJECTED_BY_ROBOT and "fault 13" in result.message, result.message


@pytest.mark.parametrize("fields, mentions", [
    ({"width": 0.09}, ["width is 0.09 m", "0.085"]),
    ({"width": -0.01}, ["width is -0.01 m"]),
    ({"width": float("nan")}, ["width is nan"]),
    ({"width": 0.0, "stroke": 0.0}, ["stroke is 0", "0.01"]),
    ({"width": 0.0, "closed_position": 0}, ["closed_position is 0", "255"]),
    ({"width": 0.0, "speed_fraction": 1.1}, ["speed_fraction is 1.1"]),
    ({"width": 0.0, "force_fraction": -0.1}, ["force_fraction is -0.1"]),
    ({"width": 0.0, "timeout": 0.0}, ["timeout is 0"]),
])
def test_a_value_out_of_range_is_rejected_with_the_limit(gripper, fields, mentions):
    goal = gripper.send(RobotiqMove, "robotiq_move", **fields)
    assert not goal.accepted
    rejection = gripper.rejection(goal)
    assert rejection.error_code == ErrorCode.INVALID_GOAL and all(part in rejection.message for part in mentions), rejection.message


@pytest.mark.parametrize("fault", [5, 7])
def test_a_fault_that_ends_with_the_activation_does_not_prevent_it(gripper, simulator, fault):
    simulator.control("robotiq_gripper", fault=fault)
    gripper.send(RobotiqActivate, "robotiq_activate", reset=True).succeeded()


def test_a_lost_connection_ends_the_goal(gripper, simulator):
    goal = gripper.send(RobotiqGrip, "robotiq_close", speed_fraction=0.0)
    wait_for(lambda: registers(simulator)["POS"] > 20, 20.0, "the fingers to move")
    simulator.control("drop_links", which="robotiq")
    result = goal.result()
    assert result.error_code == ErrorCode.LINK_LOST and "may still move" in result.message, result.message


def test_a_robot_without_the_urcap_rejects_the_commands(client, addresses):
    bare = Simulator(addresses[1], urcaps=())
    driver = start_node("driver", bare.address, "ur_type:=ur10e", PLUGINS, namespace="bare")
    other = Client("bare")
    try:
        make_ready(other)
        goal = other.send(RobotiqGrip, "robotiq_close")
        assert not goal.accepted
        rejection = other.rejection(goal)
        assert rejection.error_code == ErrorCode.NOT_SUPPORTED, rejection.message
        assert "63352" in rejection.message and "install Robotiq's URCap" in rejection.message, rejection.message
    finally:
        other.close()
        driver.stop()
        bare.stop()


def test_cancel_stops_an_activation(gripper, simulator):
    goal = gripper.send(RobotiqActivate, "robotiq_activate", reset=True)
    wait_for(lambda: 20 < registers(simulator)["POS"] < 200, 20.0, "the fingers to move")
    goal.cancel()
    assert goal.result().error_code == ErrorCode.CANCELED
    stopped = registers(simulator)
    assert stopped["ACT"] == 0 and 0 < stopped["POS"] < CLOSED
