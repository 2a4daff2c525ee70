"""Topics of robot_state_receiver other than joint_states: modes, speeds, targets, tool data and configured fields."""

import pytest
from geometry_msgs.msg import TwistStamped
from programs import Simulator, start_node
from ros_client import Client
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float64
from support import FEW_PLUGINS, HOME, JOINTS, wait_for

from ur_ros_rtde_msgs.msg import DriverState, ErrorCode, RobotMode, RobotState, SafetyMode, ToolData

FIELDS = ["timestamp", "actual_q", "tool_temperature", "actual_digital_input_bits", "output_int_register_24", "robot_mode"]
FIELDS_PARAMETER = "robot_state_fields:=[" + ", ".join(f'"{name}"' for name in FIELDS) + "]"


@pytest.fixture(scope="module")
def receiver(simulator):
    receiver = start_node("robot_state_receiver", simulator.address, "tf_prefix:=left_", FIELDS_PARAMETER)
    yield receiver
    receiver.stop()
    print(receiver.output())


@pytest.fixture
def state(receiver, simulator, client):
    simulator.control("power", to="running")
    simulator.control("speed_slider", fraction=1.0)
    simulator.control("stop_program")
    modes = client.subscribe(RobotMode, "robot_mode", transient_local=True)
    wait_for(lambda: modes and modes[-1].mode == RobotMode.RUNNING, 15.0, "the robot mode RUNNING")
    return client


def wait_for_message(messages, condition, what):
    return wait_for(lambda: messages and condition(messages[-1]) and messages[-1], 10.0, what)


def test_late_subscribers_receive_the_modes_and_all_changes(state, simulator):
    modes = state.subscribe(RobotMode, "robot_mode", transient_local=True)
    safety = state.subscribe(SafetyMode, "safety_mode", transient_local=True)
    assert wait_for_message(modes, lambda m: True, "the robot mode").name == "RUNNING"
    assert wait_for_message(safety, lambda m: True, "the safety mode").name == "NORMAL"
    simulator.control("reduced_mode", on=True)
    assert wait_for_message(safety, lambda m: m.mode == SafetyMode.REDUCED, "REDUCED").name == "REDUCED"
    simulator.control("reduced_mode", on=False)
    wait_for_message(safety, lambda m: m.mode == SafetyMode.NORMAL, "NORMAL")
    simulator.control("power", to="off")
    assert wait_for_message(modes, lambda m: m.mode == RobotMode.POWER_OFF, "POWER_OFF").name == "POWER_OFF"
    # Only changes are published.
    assert [m.name for m in safety] == ["NORMAL", "REDUCED", "NORMAL"]


def test_publishes_whether_a_program_is_running(state, simulator):
    running = state.subscribe(Bool, "program_running", transient_local=True)
    wait_for_message(running, lambda m: not m.data, "no running program")
    simulator.control("run_script", script="def wait():\n  while True:\n    sync()\n  end\nend\n")
    wait_for_message(running, lambda m: m.data, "a running program")
    simulator.control("stop_program")
    wait_for_message(running, lambda m: not m.data, "no running program")


def test_speed_scaling_follows_the_speed_slider(state, simulator):
    scaling = state.subscribe(Float64, "speed_scaling", transient_local=True)
    simulator.control("run_script", script="def wait():\n  while True:\n    sync()\n  end\nend\n")
    simulator.control("speed_slider", fraction=0.5)
    wait_for_message(scaling, lambda m: m.data == pytest.approx(0.5, abs=1e-3), "a speed scaling of 0.5")
    simulator.control("speed_slider", fraction=1.0)
    wait_for_message(scaling, lambda m: m.data == pytest.approx(1.0, abs=1e-3), "a speed scaling of 1")


def test_target_joint_states_have_the_names_of_joint_states(state):
    targets = state.subscribe(JointState, "target_joint_states")
    target = wait_for_message(targets, lambda m: True, "a target")
    assert list(target.name) == [f"left_{name}" for name in JOINTS]
    assert list(target.position) == pytest.approx(HOME, abs=1e-6)  # targets have no noise
    assert list(target.velocity) == [0.0] * 6 and abs(target.effort[1]) > 20.0


def test_tcp_speed_is_in_the_base_frame(state, simulator):
    speeds = state.subscribe(TwistStamped, "tcp_speed")
    wait_for_message(speeds, lambda m: m.header.frame_id == "left_base", "a message on tcp_speed")
    simulator.control("run_script", script="def lift():\n  speedl([0, 0, 0.1, 0, 0, 0], 1.0, 0.6)\n  stopl(1.0)\nend\n")
    fast = wait_for_message(speeds, lambda m: m.twist.linear.z > 0.09, "0.1 m/s upwards").twist
    assert abs(fast.linear.x) < 0.02 and abs(fast.linear.y) < 0.02 and abs(fast.angular.z) < 0.05
    wait_for_message(speeds, lambda m: abs(m.twist.linear.z) < 0.002, "standstill")


def test_publishes_tool_data(state, simulator):
    tool = state.subscribe(ToolData, "tool_data")
    assert wait_for_message(tool, lambda m: m.mode == 253, "tool data").header.frame_id == "left_tool0"
    assert 10.0 < tool[-1].temperature < 60.0
    assert 5.0 < abs(tool[-1].acceleration.x) + abs(tool[-1].acceleration.y) + abs(tool[-1].acceleration.z) < 20.0
    simulator.control("set_digital_input", number=17, value=True)
    assert list(wait_for_message(tool, lambda m: m.digital_inputs[1], "the input of the tool").digital_inputs) == [False, True]
    simulator.control("set_digital_input", number=17, value=False)
    wait_for_message(tool, lambda m: not m.digital_inputs[1], "the tool input to be off")


def test_robot_state_contains_the_configured_fields_in_order(state, simulator):
    states = state.subscribe(RobotState, "robot_state")
    message = wait_for_message(states, lambda m: True, "a state")
    values = {field.name: list(field.values) for field in message.fields}
    assert list(values) == FIELDS
    assert [len(value) for value in values.values()] == [1, 6, 1, 1, 1, 1]
    assert values["actual_q"] == pytest.approx(simulator.state()["actual"]["position"], abs=0.01)
    assert values["robot_mode"] == [RobotMode.RUNNING]
    simulator.control("set_digital_input", number=9, value=True)
    wait_for_message(states, lambda m: m.fields[3].values[0] == float(1 << 9), "the input")
    simulator.control("set_digital_input", number=9, value=False)
    wait_for(lambda: len(states) > 1000, 30.0, "1000 states")
    stamps = [m.fields[0].values[0] for m in list(states)[:1000]]
    assert all(0.0 < b - a < 0.2 for a, b in zip(stamps, stamps[1:])), "states of successive control cycles"


def test_robot_state_is_not_published_without_configured_fields(simulator, state, processes):
    processes(start_node("robot_state_receiver", simulator.address, namespace="plain"))
    speeds = state.subscribe(TwistStamped, "/plain/tcp_speed")
    wait_for(lambda: speeds, 15.0, "tcp_speed")
    assert state.node.count_publishers("/plain/robot_state") == 0


@pytest.mark.parametrize("names, message", [('["actual_q", "actual_position"]', '"actual_position" is not an RTDE output'),
                                            ('["actual_q", "actual_q"]', '"actual_q" occurs twice'),
                                            ('["output_int_register_48"]', '"output_int_register_48" is not an RTDE output')])
def test_an_invalid_field_prevents_the_start_with_its_name(simulator, processes, names, message):
    receiver = processes(start_node("robot_state_receiver", simulator.address, f"robot_state_fields:={names}", namespace="wrong"))
    assert receiver.wait(15.0) == 2
    assert message in receiver.output() and "robot_state_fields" in receiver.output()


def test_a_field_unsupported_by_the_controller_is_reported(addresses, processes):
    processes(Simulator(addresses[1], model="ur10"))
    receiver = processes(start_node("robot_state_receiver", addresses[1], 'robot_state_fields:=["actual_current_as_torque"]',
                                    namespace="old"))
    client = Client("old")
    try:
        states, tool = client.subscribe(RobotState, "robot_state"), client.subscribe(ToolData, "tool_data")
        receiver.wait_for_output("this controller does not have actual_current_as_torque")
        wait_for_message(tool, lambda m: True, "tool_data")
        assert not states
    finally:
        client.close()


def test_robot_mode_is_no_controller_while_disconnected(addresses, processes):
    processes(start_node("robot_state_receiver", addresses[2], FIELDS_PARAMETER, namespace="early"))
    client = Client("early")
    try:
        modes = client.subscribe(RobotMode, "robot_mode", transient_local=True)
        wait_for_message(modes, lambda m: m.name == "NO_CONTROLLER", "no controller")
        simulator = Simulator(addresses[2])
        states = client.subscribe(RobotState, "robot_state")
        wait_for_message(modes, lambda m: m.name == "RUNNING", "the robot mode RUNNING")
        wait_for(lambda: states, 10.0, "robot_state")
        simulator.kill()
        wait_for_message(modes, lambda m: m.name == "NO_CONTROLLER", "the lost controller")
        processes(simulator.start())
        number = len(states)
        wait_for_message(modes, lambda m: m.name == "RUNNING", "the robot mode RUNNING after the reconnection")
        wait_for(lambda: len(states) > number, 10.0, "robot_state after the reconnection")
    finally:
        client.close()


def test_driver_state_reports_the_cause(addresses, processes):
    processes(start_node("driver", addresses[3], FEW_PLUGINS, namespace="whole"))
    client = Client("whole")
    try:
        states = client.subscribe(DriverState, "driver_state", transient_local=True)
        gone = wait_for_message(states, lambda m: m.state == DriverState.DISCONNECTED, "the state DISCONNECTED")
        assert gone.name == "DISCONNECTED" and gone.cause == ErrorCode.LINK_LOST and gone.message
        simulator = processes(Simulator(addresses[3]))
        ready = wait_for_message(states, lambda m: m.state == DriverState.READY, "the state READY")
        assert ready.name == "READY" and ready.cause == ErrorCode.NONE
        simulator.control("protective_stop", reason="a test")
        stopped = wait_for_message(states, lambda m: m.state == DriverState.STOPPED, "the state STOPPED")
        assert stopped.cause == ErrorCode.PROTECTIVE_STOP and "protective stop" in stopped.message.lower()
        numbers = [(m.state, m.cause, m.message) for m in states]
        assert all(a != b for a, b in zip(numbers, numbers[1:])), "only changes are published"
    finally:
        client.close()
