"""Tests digital_gripper with the simulated pneumatic gripper at the digital outputs of the tool."""

import pytest
from support import wait_for
from ur_ros_rtde_gripper_commands.action import DigitalGripper

from ur_ros_rtde_msgs.action import SetToolVoltage
from ur_ros_rtde_msgs.msg import ErrorCode

PLUGINS = "plugins:=[move_j,stop,digital_gripper,set_tool_voltage]"
SIMULATOR_ARGUMENTS = ("--digital-gripper", "double")
VALVES = {"close_output": 16, "open_output": 17}
OBJECT_SENSOR, OPEN_SENSOR = 16, 17
STROKE = 40.0  # mm
SPEED = 100.0  # mm/s


def width(simulator):
    return simulator.control("digital_gripper")["width"]


@pytest.fixture
def gripper(simulator, robot):
    """A client of a robot with an open, empty gripper that has supply voltage and air."""
    robot.send(SetToolVoltage, "set_tool_voltage", voltage=24).succeeded()
    simulator.control("digital_gripper", air=True, object=0.0)
    robot.send(DigitalGripper, "digital_gripper", close=False, sensor_input=OPEN_SENSOR, time=10.0, **VALVES).succeeded()
    return robot


def test_grips_an_object_and_ends_with_its_sensor(gripper, simulator):
    simulator.control("digital_gripper", object=10.0)
    goal = gripper.send(DigitalGripper, "digital_gripper", sensor_input=OBJECT_SENSOR, time=10.0, **VALVES)
    result = goal.succeeded()
    assert width(simulator) == 10.0
    assert (STROKE - 10.0) / SPEED - 0.05 < result.duration < 5.0
    wait_for(lambda: goal.feedback, 10.0, "the feedback, which may come after the result")
    assert [feedback.sensor_reached for feedback in goal.feedback] == [True]


def test_without_a_sensor_the_goal_takes_the_given_time(gripper, simulator):
    begin = simulator.state()["timestamp"]
    result = gripper.send(DigitalGripper, "digital_gripper", time=0.8, **VALVES).succeeded()
    assert result.duration >= 0.8 and simulator.state()["timestamp"] - begin >= 0.8
    assert width(simulator) == 0.0
    outputs = simulator.state()["io"]["digital_outputs"]
    assert outputs >> 16 & 3 == 1


def test_opens_with_the_second_output_and_the_state_of_the_sensor(gripper, simulator):
    gripper.send(DigitalGripper, "digital_gripper", sensor_input=OPEN_SENSOR, sensor_state=False, time=10.0, **VALVES).succeeded()
    gripper.send(DigitalGripper, "digital_gripper", close=False, sensor_input=OPEN_SENSOR, time=10.0, **VALVES).succeeded()
    assert width(simulator) == STROKE
    assert simulator.state()["io"]["digital_outputs"] >> 16 & 3 == 2


@pytest.mark.parametrize("fault", ["no object", "no air", "no voltage"])
def test_a_sensor_that_does_not_respond_is_reported_with_the_remedies(gripper, simulator, fault):
    simulator.control("digital_gripper", air=fault != "no air", object=0.0 if fault == "no object" else 10.0)
    if fault == "no voltage":
        gripper.send(SetToolVoltage, "set_tool_voltage", voltage=0).succeeded()
    result = gripper.send(DigitalGripper, "digital_gripper", sensor_input=OBJECT_SENSOR, time=0.6, **VALVES).result()
    assert result.error_code == ErrorCode.NOT_REACHED and result.duration >= 0.6
    assert all(part in result.message for part in ("input 16 is still off", "set_tool_voltage", "compressed air")), result.message


def test_cancel_keeps_the_outputs(gripper, simulator):
    goal = gripper.send(DigitalGripper, "digital_gripper", sensor_input=OBJECT_SENSOR, time=60.0, **VALVES)
    wait_for(lambda: width(simulator) == 0.0, 20.0, "the fingers to close")
    goal.cancel()
    assert goal.result().error_code == ErrorCode.CANCELED
    assert simulator.state()["io"]["digital_outputs"] >> 16 & 3 == 1


@pytest.mark.parametrize("fields, mentions", [
    ({"close_output": 18}, ["close_output is 18", "17"]),
    ({"open_output": -2}, ["open_output is -2", "-1"]),
    ({"open_output": 16}, ["close_output and open_output are both 16"]),
    ({"close_output": -1}, ["close_output and open_output are both -1"]),
    ({"sensor_input": 18}, ["sensor_input is 18", "17"]),
    ({"time": 0.0}, ["time is 0"]),
])
def test_a_value_out_of_range_is_rejected_with_the_limit(gripper, fields, mentions):
    goal = gripper.send(DigitalGripper, "digital_gripper", **fields)
    assert not goal.accepted
    rejection = gripper.rejection(goal)
    assert rejection.error_code == ErrorCode.INVALID_GOAL and all(part in rejection.message for part in mentions), rejection.message
