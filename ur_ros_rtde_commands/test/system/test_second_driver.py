"""More than one driver, or something else, on one robot: what is said, and that only one of them moves the arm."""

import pytest
from robot_fixtures import make_ready
from support import HOME, Client, start_node, wait_for

from ur_ros_rtde_msgs.action import MoveJ, SpeedJ
from ur_ros_rtde_msgs.msg import DriverState, ErrorCode

AWAY = [HOME[0] + 2.0, *HOME[1:]]


def comes_to(states, state, cause, limit=30.0):
    return wait_for(lambda: states and states[-1].state == state and states[-1].cause == cause and states[-1], limit,
                    f"state {state} with cause {cause}, not {states[-1:]}")


def a_client(namespace):
    client = Client(namespace)
    yield client
    client.close()


@pytest.fixture
def first_client():
    yield from a_client("first")


@pytest.fixture
def other_client():
    yield from a_client("other")


@pytest.fixture
def first(simulator, processes, first_client):
    driver = processes(start_node("driver", simulator.address, namespace="first"))
    make_ready(first_client)
    return driver


@pytest.fixture
def states(other_client):
    return other_client.subscribe(DriverState, "driver_state", transient_local=True)


@pytest.fixture
def other(simulator, processes):
    """Starts a driver in another namespace."""
    return lambda *parameters: processes(start_node("driver", simulator.address, *parameters, namespace="other"))


def test_a_second_driver_with_the_same_names_refuses_to_start_and_the_first_moves_on(first, first_client, simulator):
    goal = first_client.send(MoveJ, "move_j", joint_positions=AWAY, speed=0.3)
    assert goal.accepted
    second = start_node("driver", simulator.address, namespace="first")
    assert second.wait(30.0) == 2
    refusal = [line for line in second.lines if "is already running" in line]
    assert len(refusal) == 1, second.output()
    assert "/first/" in refusal[0] and f"process {first.pid} on " in refusal[0] and "__ns" in refusal[0]
    assert goal.succeeded().final_state.joint_positions[0] == pytest.approx(AWAY[0], abs=0.01)


@pytest.mark.parametrize("name", ["command_server", "dashboard_server", "robot_state_receiver"])
def test_each_node_whose_name_another_process_has_refuses_to_start(name, first, simulator):
    second = start_node(name, simulator.address, namespace="first")
    assert second.wait(30.0) == 2
    assert f"/first/{name} is already running" in second.output()


def test_a_driver_starts_again_at_once_after_it_was_killed(first, simulator, processes):
    first.kill()
    second = processes(start_node("driver", simulator.address, namespace="first"))
    second.wait_for_output("the robot is ready")
    assert second.running() and "is already running" not in second.output()


def test_a_driver_in_another_namespace_says_who_has_the_robot_and_gets_it_when_it_is_free(
        first, first_client, other, other_client, states, simulator):
    second = other()
    state = comes_to(states, DriverState.STOPPED, ErrorCode.ROBOT_IN_USE)
    for part in ("in use", "input_int_register_23", "another driver", simulator.address):
        assert part in state.message, state.message
    assert sum("are in use" in line for line in second.lines) == 1, second.output()
    goal = first_client.send(MoveJ, "move_j", joint_positions=AWAY, speed=0.5)
    refused = other_client.send(MoveJ, "move_j", joint_positions=HOME, speed=0.5)
    assert not refused.accepted
    assert other_client.refusal(refused).error_code == ErrorCode.ROBOT_IN_USE
    goal.succeeded()
    first.stop()
    comes_to(states, DriverState.READY, ErrorCode.NONE)
    other_client.send(MoveJ, "move_j", joint_positions=HOME, speed=2.0, acceleration=5.0).succeeded()


def test_a_fieldbus_has_the_lower_registers_and_register_range_upper_is_the_way_out(simulator, other, other_client, states):
    simulator.control("fieldbus")
    try:
        driver = other()
        assert "register_range:=upper" in comes_to(states, DriverState.STOPPED, ErrorCode.ROBOT_IN_USE).message
        driver.stop()
        other("register_range:=upper")
        make_ready(other_client)
    finally:
        simulator.control("fieldbus", on=False)


def test_a_ur_type_that_contradicts_the_controller_keeps_the_arm_from_being_moved(other, other_client, states):
    other("ur_type:=ur5e")
    state = comes_to(states, DriverState.STOPPED, ErrorCode.MODEL_MISMATCH)
    assert "ur5e" in state.message and "ur_type:=ur10e" in state.message
    refused = other_client.send(MoveJ, "move_j", joint_positions=HOME)
    assert not refused.accepted and other_client.refusal(refused).error_code == ErrorCode.MODEL_MISMATCH


def test_without_a_ur_type_the_limits_are_those_of_the_arm(other, other_client):
    other().wait_for_output("is a ur10e")
    make_ready(other_client)
    refused = other_client.send(SpeedJ, "speed_j", joint_velocities=[3.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    assert not refused.accepted
    assert "2.0944" in other_client.refusal(refused).message


def test_the_result_of_a_goal_that_a_driver_does_not_know_is_no_empty_one(first, first_client):
    answer = first_client.call(MoveJ.Impl.GetResultService, "/first/move_j/_action/get_result")
    assert not answer.result.success and answer.result.error_code == ErrorCode.EXCEPTION
    assert "no such goal" in answer.result.message
