"""Tests my_command on a simulated robot."""

import pytest
from ur_ros_rtde import Rejected
from ur_ros_rtde.command_tests import MovingCommandTests

pytest_plugins = ["ur_ros_rtde.testing"]


class TestMyCommand(MovingCommandTests):
    """What applies to every command that moves the arm: it can be stopped in every way, names the reason, and rejects NaN."""

    command = "my_command"
    goal = {"angle": 1.0}


def test_an_angle_out_of_range_is_rejected(arm):
    with pytest.raises(Rejected) as rejection:
        arm.my_command(angle=7.0)
    assert rejection.value.field == "angle"
