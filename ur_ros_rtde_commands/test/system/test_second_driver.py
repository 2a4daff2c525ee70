"""Several drivers or another client on one robot: only one of them moves the arm, and the others report the conflict."""

import time

import pytest
from programs import start_node
from rclpy.qos import DurabilityPolicy, QoSProfile
from robot_fixtures import make_ready
from ros_client import Client
from std_msgs.msg import Header
from support import FEW_PLUGINS, HOME, wait_for

from ur_ros_rtde_msgs.action import MoveJ, SpeedJ
from ur_ros_rtde_msgs.msg import DriverState, ErrorCode

TARGET = [HOME[0] + 2.0, *HOME[1:]]


def wait_for_state(states, state, cause, limit=30.0):
    return wait_for(lambda: states and states[-1].state == state and states[-1].cause == cause and states[-1], limit,
                    f"state {state} with cause {cause}, not {states[-1:]}")


def client_in(namespace):
    client = Client(namespace)
    yield client
    client.close()


@pytest.fixture
def first_client():
    yield from client_in("first")


@pytest.fixture
def other_client():
    yield from client_in("other")


@pytest.fixture
def first(simulator, processes, first_client):
    driver = processes(start_node("driver", simulator.address, FEW_PLUGINS, namespace="first"))
    make_ready(first_client)
    return driver


@pytest.fixture
def states(other_client):
    return other_client.subscribe(DriverState, "driver_state", transient_local=True)


@pytest.fixture
def start_other(simulator, processes):
    """Returns a function that starts a driver in the namespace "other"."""
    return lambda *parameters: processes(start_node("driver", simulator.address, "plugins:=[move_j,speed_j]", *parameters,
                                                    namespace="other"))


def test_a_second_driver_with_the_same_names_does_not_start_and_the_first_continues(first, first_client, simulator):
    goal = first_client.send(MoveJ, "move_j", joint_positions=TARGET, speed=0.3)
    assert goal.accepted
    second = start_node("driver", simulator.address, FEW_PLUGINS, namespace="first")
    assert second.wait(30.0) == 2
    rejection = [line for line in second.lines if "is already running" in line]
    assert len(rejection) == 1, second.output()
    assert "/first/" in rejection[0] and f"process {first.pid} on " in rejection[0] and "__ns" in rejection[0]
    assert goal.succeeded().final_state.joint_positions[0] == pytest.approx(TARGET[0], abs=0.01)


@pytest.mark.parametrize("name", ["command_server", "dashboard_server", "robot_state_receiver"])
def test_a_node_does_not_start_if_its_name_is_taken(name, first, simulator):
    second = start_node(name, simulator.address, namespace="first")
    assert second.wait(30.0) == 2
    assert f"/first/{name} is already running" in second.output()


def test_an_older_process_whose_clock_is_ahead_is_older(simulator, first_client):
    message = Header(frame_id="running: process 7 on a host whose clock is an hour ahead")
    message.stamp.sec = int(time.time()) + 3600
    publisher = first_client.node.create_publisher(Header, "command_server/_instance",
                                                   QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
    publisher.publish(message)
    second = start_node("command_server", simulator.address, FEW_PLUGINS, namespace="first")
    assert second.wait(30.0) == 2 and "process 7 on a host whose clock" in second.output(), second.output()
    first_client.node.destroy_publisher(publisher)


def test_a_process_that_runs_tells_it_to_one_that_appears(simulator, processes, first_client):
    processes(start_node("command_server", simulator.address, FEW_PLUGINS, namespace="first"))
    qos = QoSProfile(depth=8, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    instances = []
    subscription = first_client.node.create_subscription(Header, "command_server/_instance", instances.append, qos)
    own = wait_for(lambda: instances and instances[-1], 10.0, "its message")
    time.sleep(max(0.0, own.stamp.sec + 11.0 - time.time()))  # until it counts as running
    publisher = first_client.node.create_publisher(Header, "command_server/_instance", qos)
    newcomer = Header(frame_id="process 8 on another host")
    publisher.publish(newcomer)
    wait_for(lambda: any(message.frame_id == f"running: {own.frame_id}" for message in instances), 10.0, f"the answer: {instances}")
    for endpoint, destroy in ((publisher, first_client.node.destroy_publisher), (subscription, first_client.node.destroy_subscription)):
        destroy(endpoint)


def test_a_killed_driver_can_be_restarted_at_once(first, simulator, processes):
    first.kill()
    second = processes(start_node("driver", simulator.address, FEW_PLUGINS, namespace="first"))
    second.wait_for_output("the robot is ready")
    assert second.running() and "is already running" not in second.output()


def test_a_driver_in_another_namespace_reports_the_conflict_and_takes_over_a_released_robot(
        first, first_client, start_other, other_client, states, simulator):
    second = start_other()
    state = wait_for_state(states, DriverState.STOPPED, ErrorCode.ROBOT_IN_USE)
    for part in ("in use", "input_int_register_23", "another driver", simulator.address):
        assert part in state.message, state.message
    second.wait_for_output("are in use")
    assert sum("are in use" in line for line in second.lines) == 1, second.output()
    goal = first_client.send(MoveJ, "move_j", joint_positions=TARGET, speed=0.5)
    rejected = other_client.send(MoveJ, "move_j", joint_positions=HOME, speed=0.5)
    assert not rejected.accepted
    assert other_client.rejection(rejected).error_code == ErrorCode.ROBOT_IN_USE
    goal.succeeded()
    first.stop()
    wait_for_state(states, DriverState.READY, ErrorCode.NONE)
    other_client.send(MoveJ, "move_j", joint_positions=HOME, speed=2.0, acceleration=5.0).succeeded()


def test_register_range_upper_avoids_the_registers_of_a_fieldbus(simulator, start_other, other_client, states):
    simulator.control("fieldbus")
    try:
        driver = start_other()
        assert "register_range:=upper" in wait_for_state(states, DriverState.STOPPED, ErrorCode.ROBOT_IN_USE).message
        driver.stop()
        start_other("register_range:=upper")
        make_ready(other_client)
    finally:
        simulator.control("fieldbus", on=False)


def test_a_wrong_ur_type_prevents_motion(start_other, other_client, states):
    start_other("ur_type:=ur5e")
    state = wait_for_state(states, DriverState.STOPPED, ErrorCode.MODEL_MISMATCH)
    assert "ur5e" in state.message and "ur_type:=ur10e" in state.message
    rejected = other_client.send(MoveJ, "move_j", joint_positions=HOME)
    assert not rejected.accepted and other_client.rejection(rejected).error_code == ErrorCode.MODEL_MISMATCH


def test_without_ur_type_the_limits_of_the_connected_arm_apply(start_other, other_client):
    start_other().wait_for_output("is a ur10e")
    make_ready(other_client)
    rejected = other_client.send(SpeedJ, "speed_j", joint_velocities=[3.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    assert not rejected.accepted
    assert "2.0944" in other_client.rejection(rejected).message


def test_the_result_of_an_unknown_goal_is_an_error(first, first_client):
    answer = first_client.call(MoveJ.Impl.GetResultService, "/first/move_j/_action/get_result")
    assert not answer.result.success and answer.result.error_code == ErrorCode.EXCEPTION
    assert "no such goal" in answer.result.message
