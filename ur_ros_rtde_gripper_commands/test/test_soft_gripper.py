"""Tests the soft gripper commands with the simulated URCap."""

import pytest
from programs import Simulator, start_node
from robot_fixtures import make_ready
from ros_client import Client
from support import wait_for
from ur_ros_rtde_gripper_commands.action import SgGetWidth, SgGrip, SgRelease

from ur_ros_rtde_msgs.msg import ErrorCode


@pytest.fixture
def gripper(simulator, robot):
    """A client of a robot with an open, empty gripper."""
    simulator.control("gripper", stuck=False, powered=True, object=0.0)
    robot.send(SgRelease, "sg_release", target_width=0.075).succeeded()
    return robot


def width(simulator):
    return simulator.control("gripper")["width"] / 1000.0


def test_closes_to_the_target_width(gripper, simulator):
    result = gripper.send(SgGrip, "sg_grip", target_width=0.03).succeeded()
    assert result.width == pytest.approx(0.03, abs=0.0005) and width(simulator) == pytest.approx(0.03, abs=0.0005)


def test_stops_at_the_held_object(gripper, simulator):
    simulator.control("gripper", object=42.0)
    result = gripper.send(SgGrip, "sg_grip", target_width=0.02, gentle=True).succeeded()
    assert result.width == pytest.approx(0.042, abs=0.0005)


def test_opens_and_reports_the_width(gripper):
    gripper.send(SgGrip, "sg_grip", target_width=0.02).succeeded()
    assert gripper.send(SgRelease, "sg_release", target_width=0.05).succeeded().width == pytest.approx(0.05, abs=0.0005)
    assert gripper.send(SgGetWidth, "sg_get_width").succeeded().width == pytest.approx(0.05, abs=0.0005)


@pytest.mark.parametrize("fields, mentions", [
    ({"target_width": 0.005}, ["target_width is 0.005 m", "0.011"]),
    ({"target_width": 0.12}, ["target_width is 0.12 m", "0.117"]),
    ({"target_width": float("nan")}, ["target_width is nan"]),
    ({"target_width": 0.03, "timeout": 0.0}, ["timeout is 0"]),
])
def test_a_value_out_of_range_is_rejected_with_the_limit(gripper, fields, mentions):
    goal = gripper.send(SgGrip, "sg_grip", **fields)
    assert not goal.accepted
    rejection = gripper.rejection(goal)
    assert rejection.error_code == ErrorCode.INVALID_GOAL and all(part in rejection.message for part in mentions), rejection.message


@pytest.mark.parametrize("action, name, fields", [
    (SgGrip, "sg_grip", {"target_width": 0.02}), (SgRelease, "sg_release", {"target_width": 0.06}), (SgGetWidth, "sg_get_width", {})])
def test_a_gripper_without_power_ends_the_program(gripper, simulator, action, name, fields):
    simulator.control("gripper", powered=False)
    result = gripper.send(action, name, **fields).result()
    simulator.control("gripper", powered=True)
    assert result.error_code == ErrorCode.PROGRAM_STOPPED, result.message
    assert any("Communication problem with a Soft Gripper" in entry["text"] for entry in simulator.control("log")["entries"])
    make_ready(gripper, 10.0)
    gripper.send(action, name, **fields).succeeded()


def test_a_width_that_the_fingers_do_not_have_ends_the_program(gripper):
    result = gripper.send(SgGrip, "sg_grip", target_width=0.08).result()
    assert result.error_code == ErrorCode.PROGRAM_STOPPED, result.message
    make_ready(gripper, 10.0)


def test_a_stuck_gripper_times_out_and_the_driver_stays_ready(gripper, simulator):
    simulator.control("gripper", stuck=True)
    result = gripper.send(SgGrip, "sg_grip", target_width=0.02, timeout=1.0).result()
    assert not result.success and result.error_code == ErrorCode.TIMEOUT, result.message
    simulator.control("gripper", stuck=False)
    make_ready(gripper, 10.0)
    gripper.send(SgRelease, "sg_release", target_width=0.06).succeeded()


def test_cancel_ends_the_goal_and_the_driver_stays_ready(gripper, simulator):
    simulator.control("gripper", stuck=True)
    goal = gripper.send(SgGrip, "sg_grip", target_width=0.02, timeout=30.0)
    wait_for(lambda: simulator.control("gripper")["busy"], 10.0, "the gripper to move")
    goal.cancel()
    assert goal.result().error_code == ErrorCode.CANCELED
    simulator.control("gripper", stuck=False)
    make_ready(gripper, 10.0)


def test_a_robot_without_the_urcap_rejects_gripper_commands_and_stays_ready(client, addresses):
    bare = Simulator(addresses[1], urcaps=())
    driver = start_node("driver", bare.address, "ur_type:=ur10e", namespace="bare")
    other = Client("bare")
    try:
        make_ready(other)
        start = list(driver.lines)
        goal = other.send(SgGetWidth, "sg_get_width")
        assert not goal.accepted
        rejection = other.rejection(goal)
        assert rejection.error_code == ErrorCode.NOT_SUPPORTED, rejection.message
        assert "get_sg_Width" in rejection.message and "install the OnRobot URCap" in rejection.message, rejection.message
        reported = [line for line in start if "OnRobot" in line]
        assert len(reported) == 1 and "INFO" in reported[0], driver.output()
        assert all(name in reported[0] for name in ("sg_get_width", "sg_grip", "sg_release")), reported
        names = ("OnRobot", "sg_", "extension")
        assert not [line for line in start if ("ERROR" in line or "WARN" in line) and any(name in line for name in names)], start
    finally:
        other.close()
        driver.stop()
        bare.stop()
