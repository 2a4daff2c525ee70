"""Settings: the controller applies them, and their effect."""

import math

import pytest
from action_msgs.msg import GoalStatus
from arm_state import get_tcp_pose
from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from robot_fixtures import make_ready
from support import wait_for

from ur_ros_rtde_msgs.action import (
    GetPose,
    MoveJ,
    SendScript,
    SetAnalogOutput,
    SetDigitalOutput,
    SetGravity,
    SetPayload,
    SetRegister,
    SetTargetPayload,
    SetTcp,
    SetToolAnalogInputDomain,
    SetToolCommunication,
    SetToolDigitalOutputMode,
    SetToolOutputMode,
    SetToolVoltage,
    SetWatchdog,
)
from ur_ros_rtde_msgs.msg import ErrorCode


def test_set_tcp_changes_the_tcp_pose_and_get_tcp_offset_returns_it(robot, simulator):
    flange = get_tcp_pose(robot).position
    quarter = Quaternion(z=math.sqrt(0.5), w=math.sqrt(0.5))
    robot.send(SetTcp, "set_tcp", pose=Pose(position=Point(z=0.2), orientation=quarter)).succeeded()
    offset = robot.send(GetPose, "get_tcp_offset").succeeded()
    assert (offset.pose.position.z, offset.pose.orientation.z) == pytest.approx((0.2, math.sqrt(0.5)), abs=1e-6)
    assert simulator.state()["tcp_offset"] == pytest.approx([0.0, 0.0, 0.2, 0.0, 0.0, math.pi / 2], abs=1e-6)

    def distance():
        tcp = get_tcp_pose(robot).position
        return math.dist((tcp.x, tcp.y, tcp.z), (flange.x, flange.y, flange.z))

    wait_for(lambda: distance() == pytest.approx(0.2, abs=1e-3), 15.0, "tcp_pose to follow")
    robot.send(SetTcp, "set_tcp", pose=Pose()).succeeded()


def test_set_target_payload_sets_mass_center_of_gravity_and_inertia(robot, simulator):
    inertia = [0.02, 0.03, 0.01, 0.001, 0.0, -0.002]
    robot.send(SetTargetPayload, "set_target_payload", mass=2.0, center_of_gravity=Vector3(x=0.01, z=0.06),
               inertia=inertia).succeeded()
    payload = simulator.state()["payload"]
    assert payload["mass"] == 2.0 and payload["center_of_gravity"] == pytest.approx([0.01, 0.0, 0.06])
    output = robot.send(SendScript, "send_secondary_script", script="textmsg(get_target_payload_inertia())").succeeded().output
    assert [float(value) for value in output[0].strip("[] ").split(",")] == pytest.approx(inertia, abs=1e-9)
    robot.send(SetPayload, "set_payload", mass=0.0).succeeded()
    assert simulator.state()["payload"]["center_of_gravity"] == pytest.approx([0.0, 0.0, 0.0], abs=1e-6)


@pytest.mark.parametrize("name,first,count", [("set_standard_digital_output", 0, 8), ("set_configurable_digital_output", 8, 8),
                                              ("set_tool_digital_output", 16, 2)])
def test_sets_standard_configurable_and_tool_digital_outputs(robot, simulator, name, first, count):
    for pin in (0, count - 1):
        for state in (True, False):
            robot.send(SetDigitalOutput, name, pin=pin, state=state).succeeded()
            assert bool(simulator.state()["io"]["digital_outputs"] >> (first + pin) & 1) == state
    rejected = robot.send(SetDigitalOutput, name, pin=count)
    assert not rejected.accepted and "pin" in robot.rejection(rejected).message


def test_sets_analog_outputs_as_voltage_and_current(robot, simulator):
    robot.send(SetAnalogOutput, "set_analog_output_voltage", pin=1, fraction=0.25).succeeded()
    assert simulator.state()["io"]["analog_outputs"][1] == pytest.approx(2.5)
    robot.send(SetAnalogOutput, "set_analog_output_current", pin=1, fraction=0.25).succeeded()
    assert simulator.state()["io"]["analog_outputs"][1] == pytest.approx(0.008)


def test_programs_read_the_input_registers(robot, simulator):
    robot.send(SetRegister, "set_input_int_register", index=19, value=-7.0).succeeded()
    robot.send(SetRegister, "set_input_double_register", index=22, value=0.125).succeeded()
    script = "textmsg(read_input_integer_register(19))\ntextmsg(read_input_float_register(22))"
    wait_for(lambda: robot.send(SendScript, "send_secondary_script", script=script).succeeded().output == ["-7", "0.125"],
             5.0, "the registers")
    for value in (0.5, 2.0**31):
        rejected = robot.send(SetRegister, "set_input_int_register", index=19, value=value)
        assert not rejected.accepted and robot.rejection(rejected).error_code == ErrorCode.INVALID_GOAL


def test_gravity_has_to_be_about_9_82(robot):
    robot.send(SetGravity, "set_gravity", direction=Vector3(y=9.82 * math.sin(0.5), z=9.82 * math.cos(0.5))).succeeded()
    robot.send(SetGravity, "set_gravity", direction=Vector3(z=9.82)).succeeded()
    rejected = robot.send(SetGravity, "set_gravity", direction=Vector3(z=1.0))
    assert not rejected.accepted and "direction" in robot.rejection(rejected).message


def test_a_faster_watchdog_stops_the_program_only_if_the_driver_is_silent(robot, driver, simulator):
    robot.send(SetWatchdog, "set_watchdog", min_frequency=4.0).succeeded()
    simulator.wait(1.0)
    assert simulator.state()["program"]["state"] == "PLAYING"
    driver.pause()
    try:
        wait_for(lambda: simulator.state()["program"]["state"] == "STOPPED", 15.0, "the watchdog to stop the program")
    finally:
        driver.resume()


def test_a_watchdog_faster_than_the_heartbeat_is_rejected(robot):
    rejected = robot.send(SetWatchdog, "set_watchdog", min_frequency=60.0)
    assert not rejected.accepted
    message = robot.rejection(rejected).message
    assert "min_frequency" in message and "50" in message


def test_set_output_without_received_packages_fails_with_link_lost(robot, simulator):
    simulator.control("stall_links", which="rtde")
    try:
        goal = robot.send(SetDigitalOutput, "set_standard_digital_output", pin=2, state=True)
        outcome = goal.wait_for_result(10.0)[1] if goal.accepted else robot.rejection(goal)  # rejected if the loss was detected first
        assert outcome.error_code == ErrorCode.LINK_LOST, outcome.message
    finally:
        simulator.control("drop_links", which="rtde")
    wait_for(lambda: robot.send(SetDigitalOutput, "set_standard_digital_output", pin=2, state=True).accepted, 10.0, "the reconnection")


# Settings of the control program, which would otherwise be blamed on it.
PROGRAM_SETTINGS = {"set_payload": (SetPayload, {"mass": 1.0}), "set_target_payload": (SetTargetPayload, {"mass": 1.0}),
                    "set_tcp": (SetTcp, {"pose": Pose(position=Point(z=0.1))})}


@pytest.mark.parametrize("name", PROGRAM_SETTINGS)
def test_a_setting_on_a_silent_link_fails_with_link_lost(robot, simulator, name):
    """The goal is accepted before the silence is noticed: the control program does not answer, but it has rejected nothing."""
    action, fields = PROGRAM_SETTINGS[name]
    robot.send(action, name).succeeded()  # the server is known from now on; mass 0, no offset
    simulator.control("stall_links", which="rtde")
    try:
        goal = robot.send(action, name, **fields)
        assert goal.accepted, f"the silence was noticed before the goal: {robot.rejection(goal).message}"
        status, result = goal.wait_for_result(20.0)
    finally:
        simulator.control("drop_links", which="rtde")
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, ErrorCode.LINK_LOST), result.message
    cause = result.message.split("; standstill")[0]
    assert "connection" in cause and "did not set" not in cause and "teach pendant" not in cause, result.message
    make_ready(robot)
    robot.send(action, name).succeeded()


@pytest.mark.parametrize("name, kind, fields, output, expected", [
    ("set_tool_voltage", SetToolVoltage, {"voltage": 12}, "tool_output_voltage", 12),
    ("set_tool_output_mode", SetToolOutputMode, {"mode": SetToolOutputMode.Goal.DUAL_PIN_POWER}, "tool_output_mode", 1),
    ("set_tool_digital_output_mode", SetToolDigitalOutputMode, {"pin": 1, "mode": SetToolDigitalOutputMode.Goal.PUSH_PULL},
     "tool_digital_output_modes", [1, 3]),
    ("set_tool_analog_input_domain", SetToolAnalogInputDomain, {"pin": 1, "domain": SetToolAnalogInputDomain.Goal.VOLTAGE},
     "tool_analog_input_types", 2),
    ("set_tool_communication", SetToolCommunication, {"baud_rate": 1000000, "parity": 2, "stop_bits": 2, "rx_idle_chars": 2.5},
     "tool_communication", {"enabled": True, "baud_rate": 1000000, "parity": 2, "stop_bits": 2, "rx_idle_chars": 2.5,
                            "tx_idle_chars": 3.5}),
])
def test_sets_the_tool_connector(robot, simulator, name, kind, fields, output, expected):
    robot.send(kind, name, **fields).succeeded()
    assert simulator.state()["io"][output] == expected


def test_the_tool_voltage_can_be_set_during_a_motion(robot, simulator):
    goal = robot.send(MoveJ, "move_j", joint_positions=[0.8, -1.57, 1.57, -1.57, -1.57, 0.0], speed=0.3)
    wait_for(lambda: not simulator.is_at_rest(), 10.0, "the motion")
    robot.send(SetToolVoltage, "set_tool_voltage", voltage=24).succeeded()
    assert simulator.state()["io"]["tool_output_voltage"] == 24 and not goal.is_finished()
    goal.succeeded()


@pytest.mark.parametrize("name, kind, fields, mentions", [
    ("set_tool_voltage", SetToolVoltage, {"voltage": 5}, "voltage is 5 V, it must be 0, 12 or 24"),
    ("set_tool_output_mode", SetToolOutputMode, {"mode": 2}, "mode is 2"),
    ("set_tool_digital_output_mode", SetToolDigitalOutputMode, {"pin": 0, "mode": 0}, "mode is 0"),
    ("set_tool_analog_input_domain", SetToolAnalogInputDomain, {"pin": 2}, "pin is 2"),
    ("set_tool_communication", SetToolCommunication, {"baud_rate": 14400}, "baud_rate is 14400, it must be one of 9600"),
])
def test_invalid_settings_of_the_tool_connector_are_rejected(robot, name, kind, fields, mentions):
    rejected = robot.send(kind, name, **fields)
    assert not rejected.accepted and mentions in robot.rejection(rejected).message
