"""Topics of robot_state_receiver besides the joints: modes, speeds, setpoints, tool data and the configured fields."""

import pytest
from geometry_msgs.msg import TwistStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float64
from support import HOME, JOINTS, Client, Simulator, start_node, wait_for

from ur_ros_rtde_msgs.msg import DriverState, ErrorCode, RobotMode, RobotState, SafetyMode, ToolData

FIELDS = ["timestamp", "actual_q", "tool_temperature", "actual_digital_input_bits", "output_int_register_24", "robot_mode"]
NAMED = "robot_state_fields:=[" + ", ".join(f'"{name}"' for name in FIELDS) + "]"


@pytest.fixture(scope="module")
def receiver(simulator):
    receiver = start_node("robot_state_receiver", simulator.address, "tf_prefix:=left_", NAMED)
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


def last(messages, condition, what):
    return wait_for(lambda: messages and condition(messages[-1]) and messages[-1], 10.0, what)


def test_modes_are_told_to_those_who_come_late_and_when_they_change(state, simulator):
    modes = state.subscribe(RobotMode, "robot_mode", transient_local=True)
    safety = state.subscribe(SafetyMode, "safety_mode", transient_local=True)
    assert last(modes, lambda m: True, "the robot mode").name == "RUNNING"
    assert last(safety, lambda m: True, "the safety mode").name == "NORMAL"
    simulator.control("reduced_mode", on=True)
    assert last(safety, lambda m: m.mode == SafetyMode.REDUCED, "REDUCED").name == "REDUCED"
    simulator.control("reduced_mode", on=False)
    last(safety, lambda m: m.mode == SafetyMode.NORMAL, "NORMAL")
    simulator.control("power", to="off")
    assert last(modes, lambda m: m.mode == RobotMode.POWER_OFF, "POWER_OFF").name == "POWER_OFF"
    # Changes only: none between those.
    assert [m.name for m in safety] == ["NORMAL", "REDUCED", "NORMAL"]


def test_whether_a_program_runs_is_told(state, simulator):
    running = state.subscribe(Bool, "program_running", transient_local=True)
    last(running, lambda m: not m.data, "that none runs")
    simulator.control("run_script", script="def wait():\n  while True:\n    sync()\n  end\nend\n")
    last(running, lambda m: m.data, "that one runs")
    simulator.control("stop_program")
    last(running, lambda m: not m.data, "that none runs")


def test_the_speed_scaling_follows_the_slider_while_a_program_runs(state, simulator):
    scaling = state.subscribe(Float64, "speed_scaling", transient_local=True)
    simulator.control("run_script", script="def wait():\n  while True:\n    sync()\n  end\nend\n")
    simulator.control("speed_slider", fraction=0.5)
    last(scaling, lambda m: m.data == pytest.approx(0.5, abs=1e-3), "a half")
    simulator.control("speed_slider", fraction=1.0)
    last(scaling, lambda m: m.data == pytest.approx(1.0, abs=1e-3), "all")


def test_targets_are_joint_states_of_the_same_names(state):
    targets = state.subscribe(JointState, "target_joint_states")
    target = last(targets, lambda m: True, "a target")
    assert list(target.name) == [f"left_{name}" for name in JOINTS]
    assert list(target.position) == pytest.approx(HOME, abs=1e-6)  # what is aimed at has no noise
    assert list(target.velocity) == [0.0] * 6 and abs(target.effort[1]) > 20.0


def test_the_speed_of_the_tcp_is_in_the_base_frame(state, simulator):
    speeds = state.subscribe(TwistStamped, "tcp_speed")
    last(speeds, lambda m: m.header.frame_id == "left_base", "a speed")
    simulator.control("run_script", script="def lift():\n  speedl([0, 0, 0.1, 0, 0, 0], 1.0, 0.6)\n  stopl(1.0)\nend\n")
    fast = last(speeds, lambda m: m.twist.linear.z > 0.09, "0.1 m/s upwards").twist
    assert abs(fast.linear.x) < 0.02 and abs(fast.linear.y) < 0.02 and abs(fast.angular.z) < 0.05
    last(speeds, lambda m: abs(m.twist.linear.z) < 0.002, "the rest after it")


def test_the_tool_is_told_to_whoever_listens(state, simulator):
    tool = state.subscribe(ToolData, "tool_data")
    assert last(tool, lambda m: m.mode == 253, "tool data").header.frame_id == "left_tool0"
    assert 10.0 < tool[-1].temperature < 60.0
    assert 5.0 < abs(tool[-1].acceleration.x) + abs(tool[-1].acceleration.y) + abs(tool[-1].acceleration.z) < 20.0
    simulator.control("set_digital_input", number=17, value=True)
    assert list(last(tool, lambda m: m.digital_inputs[1], "the input of the tool").digital_inputs) == [False, True]
    simulator.control("set_digital_input", number=17, value=False)
    last(tool, lambda m: not m.digital_inputs[1], "it to go off")


def test_robot_state_has_the_fields_that_are_wanted_in_their_order(state, simulator):
    states = state.subscribe(RobotState, "robot_state")
    message = last(states, lambda m: True, "a state")
    values = {field.name: list(field.values) for field in message.fields}
    assert list(values) == FIELDS
    assert [len(value) for value in values.values()] == [1, 6, 1, 1, 1, 1]
    assert values["actual_q"] == pytest.approx(simulator.state()["actual"]["position"], abs=0.01)
    assert values["robot_mode"] == [RobotMode.RUNNING]
    simulator.control("set_digital_input", number=9, value=True)
    last(states, lambda m: m.fields[3].values[0] == float(1 << 9), "the input")
    simulator.control("set_digital_input", number=9, value=False)
    wait_for(lambda: len(states) > 1000, 30.0, "1000 states")
    stamps = [m.fields[0].values[0] for m in list(states)[:1000]]
    assert all(0.0 < b - a < 0.2 for a, b in zip(stamps, stamps[1:])), "of one control cycle after the other"


def test_there_is_no_robot_state_without_fields(simulator, state, processes):
    processes(start_node("robot_state_receiver", simulator.address, namespace="plain"))
    speeds = state.subscribe(TwistStamped, "/plain/tcp_speed")
    wait_for(lambda: speeds, 15.0, "it to run")
    assert state.node.count_publishers("/plain/robot_state") == 0


@pytest.mark.parametrize("names, said", [('["actual_q", "actual_position"]', '"actual_position" is not an RTDE output'),
                                         ('["actual_q", "actual_q"]', '"actual_q" occurs twice'),
                                         ('["output_int_register_48"]', '"output_int_register_48" is not an RTDE output')])
def test_a_field_that_there_is_not_ends_the_start_with_its_name(simulator, processes, names, said):
    receiver = processes(start_node("robot_state_receiver", simulator.address, f"robot_state_fields:={names}", namespace="wrong"))
    assert receiver.wait(15.0) == 2
    assert said in receiver.output() and "robot_state_fields" in receiver.output()


def test_a_field_that_this_controller_does_not_have_is_named(addresses, processes):
    processes(Simulator(addresses[1], model="ur10"))
    receiver = processes(start_node("robot_state_receiver", addresses[1], 'robot_state_fields:=["actual_current_as_torque"]', namespace="old"))
    receiver.wait_for_output("this controller does not have actual_current_as_torque")


def test_a_controller_that_is_gone_has_the_mode_no_controller(addresses, processes):
    processes(start_node("robot_state_receiver", addresses[2], NAMED, namespace="early"))
    client = Client("early")
    try:
        modes = client.subscribe(RobotMode, "robot_mode", transient_local=True)
        last(modes, lambda m: m.name == "NO_CONTROLLER", "that there is none")
        simulator = Simulator(addresses[2])
        states = client.subscribe(RobotState, "robot_state")
        last(modes, lambda m: m.name == "RUNNING", "that it runs")
        wait_for(lambda: states, 10.0, "its fields")
        simulator.kill()
        last(modes, lambda m: m.name == "NO_CONTROLLER", "that it is gone")
        processes(simulator.start())
        number = len(states)
        last(modes, lambda m: m.name == "RUNNING", "that it is back")
        wait_for(lambda: len(states) > number, 10.0, "its fields again")
    finally:
        client.close()


def test_the_state_of_the_driver_is_told_with_its_cause(addresses, processes):
    processes(start_node("driver", addresses[3], namespace="whole"))
    client = Client("whole")
    try:
        states = client.subscribe(DriverState, "driver_state", transient_local=True)
        gone = last(states, lambda m: m.state == DriverState.DISCONNECTED, "that there is no robot")
        assert gone.name == "DISCONNECTED" and gone.cause == ErrorCode.LINK_LOST and gone.message
        simulator = processes(Simulator(addresses[3]))
        ready = last(states, lambda m: m.state == DriverState.READY, "that it is ready")
        assert ready.name == "READY" and ready.cause == ErrorCode.NONE
        simulator.control("protective_stop", reason="a test")
        stopped = last(states, lambda m: m.state == DriverState.STOPPED, "that it is stopped")
        assert stopped.cause == ErrorCode.PROTECTIVE_STOP and "protective stop" in stopped.message.lower()
        numbers = [(m.state, m.cause, m.message) for m in states]
        assert all(a != b for a, b in zip(numbers, numbers[1:])), "changes only"
    finally:
        client.close()
