"""Tests my_command on a simulated robot."""

import pytest
from ur_ros_rtde import CommandFailed, Rejected

pytest_plugins = ["ur_ros_rtde.testing"]


def moves(state):
    return max(abs(velocity) for velocity in state["actual"]["velocity"]) > 0.02


def test_succeeds(arm, simulator):
    assert arm.my_command(angle=0.2).success
    assert simulator.is_at_rest()


def test_an_invalid_goal_is_rejected(arm):
    with pytest.raises(Rejected) as rejection:
        arm.my_command(angle=7.0)
    assert rejection.value.field == "angle"


def test_cancel_stops_the_arm(arm, simulator):
    goal = arm.start.my_command(angle=1.0)
    simulator.wait_for(moves)
    goal.cancel()
    assert simulator.is_at_rest()


def test_a_protective_stop_is_the_reason_of_the_failure(arm, simulator):
    goal = arm.start.my_command(angle=1.0)
    simulator.wait_for(moves)
    simulator.control("protective_stop", reason="of the test")
    with pytest.raises(CommandFailed) as failure:
        goal.result()
    assert failure.value.name == "PROTECTIVE_STOP"
