"""Tests vacuum_pick on the simulated robot: a surface is the part, digital input 0 the vacuum switch."""

import pytest
from action_msgs.msg import GoalStatus
from programs import start_node
from support import wait_for
from ur_ros_rtde_tutorials.action import VacuumPick

from ur_ros_rtde_msgs.action import MoveJRelative, SetDigitalOutput
from ur_ros_rtde_msgs.msg import ErrorCode

PART = 0.01  # m, below the gripper


def height(simulator):
    return simulator.state()["actual_tcp_pose"][2]


def vacuum(simulator):
    return bool(simulator.state()["io"]["digital_outputs"] & 1)


def set_switch(simulator, value):
    simulator.control("set_digital_input", number=0, value=value)


@pytest.fixture
def part(robot, simulator):
    """A soft surface below the gripper, and a vacuum switch that is off."""
    simulator.control("clear_surfaces")
    set_switch(simulator, False)
    simulator.control("place_surface", z=height(simulator) - PART, stiffness=2000.0)
    yield
    set_switch(simulator, True)
    robot.send(SetDigitalOutput, "set_digital_output", pin=0, state=False).succeeded()
    set_switch(simulator, False)
    simulator.control("clear_surfaces")


def pick(client, **fields):
    return client.send(VacuumPick, "vacuum_pick", **fields)


def picked(client, simulator, **fields):
    """Picks the part, whose switch closes as soon as the vacuum is on."""
    goal = pick(client, **fields)
    wait_for(lambda: vacuum(simulator), 20.0, "the vacuum")
    set_switch(simulator, True)
    return goal


def test_the_part_is_lifted(robot, simulator, part):
    start = height(simulator)
    goal = picked(robot, simulator, lift=0.03)
    result = goal.succeeded(30.0)
    assert height(simulator) == pytest.approx(start - PART + 0.03, abs=0.005)
    assert result.final_state.tcp_pose.position.z == pytest.approx(height(simulator), abs=0.001)
    assert goal.feedback and vacuum(simulator) and simulator.is_at_rest()


def test_without_a_part_the_vacuum_is_switched_off(robot, simulator, part):
    result = pick(robot).result(30.0)
    assert result.error_code == ErrorCode.NOT_REACHED and result.message == "no vacuum within 2 s: there is no part"
    assert not vacuum(simulator) and simulator.is_at_rest()


def test_a_failure_names_the_command_that_was_called(robot, simulator, part):
    simulator.control("clear_surfaces")
    result = pick(robot, distance=0.02).result(30.0)
    assert result.error_code == ErrorCode.NOT_REACHED and result.message.startswith("move_until_force: "), result.message
    assert not vacuum(simulator) and simulator.is_at_rest()


def test_a_part_that_is_lost_stops_the_goal_of_another_command(robot, simulator, part):
    picked(robot, simulator).succeeded(30.0)
    goal = robot.send(MoveJRelative, "move_j_relative", joint_offsets=[1.5, 0.0, 0.0, 0.0, 0.0, 0.0], speed=0.5)
    wait_for(lambda: not simulator.is_at_rest(), 10.0, "a motion")
    set_switch(simulator, False)
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == ErrorCode.NOT_REACHED
    assert result.message == "the part was lost: the vacuum switch is off", result.message
    assert simulator.is_at_rest()
    # The operator can move the arm to the part, although the reason persists.
    robot.send(MoveJRelative, "move_j_relative", joint_offsets=[-0.05, 0.0, 0.0, 0.0, 0.0, 0.0]).succeeded(30.0)


def test_a_part_that_is_put_down_stops_nothing(robot, simulator, part):
    picked(robot, simulator).succeeded(30.0)
    goal = robot.send(MoveJRelative, "move_j_relative", joint_offsets=[0.2, 0.0, 0.0, 0.0, 0.0, 0.0])
    robot.send(SetDigitalOutput, "set_digital_output", pin=0, state=False).succeeded()
    set_switch(simulator, False)
    goal.succeeded(30.0)


def test_cancel_during_a_called_command_stops_the_arm(robot, simulator, part):
    simulator.control("clear_surfaces")
    goal = pick(robot, distance=0.2)
    wait_for(lambda: not simulator.is_at_rest(), 10.0, "the approach")
    goal.cancel()
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_CANCELED and result.error_code == ErrorCode.CANCELED, result.message
    assert simulator.is_at_rest()


def test_a_protective_stop_during_a_called_command_is_the_reason(robot, simulator, part):
    simulator.control("clear_surfaces")
    goal = pick(robot, distance=0.2)
    wait_for(lambda: not simulator.is_at_rest(), 10.0, "the approach")
    simulator.control("protective_stop", reason="of the test")
    assert goal.result().error_code == ErrorCode.PROTECTIVE_STOP


def test_a_parameter_out_of_range_leaves_the_plugin_out(addresses, processes):
    server = processes(start_node("command_server", addresses[3], "plugins:=[stop,vacuum_pick]", "vacuum_pick.output:=30"))
    line = server.wait_for_output("plugin vacuum_pick of package ur_ros_rtde_tutorials is left out")
    assert "on_load() threw" in line and "vacuum_pick.output" in line and "30" in line, line
    assert server.wait_for_output(" commands: ").endswith(" commands: stop")


def test_a_misspelled_parameter_prevents_the_start_and_is_named(addresses, processes):
    server = processes(start_node("command_server", addresses[3], "plugins:=[stop,vacuum_pick]", "vacuum_pick.outptu:=3"))
    line = server.wait_for_output("vacuum_pick.outptu")
    assert "vacuum_pick.output" in line.replace("vacuum_pick.outptu", ""), line
    assert server.wait(15.0) != 0
