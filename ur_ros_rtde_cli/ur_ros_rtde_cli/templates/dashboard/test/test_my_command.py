"""Tests my_command on a simulated robot."""

import pytest
from ur_ros_rtde import Rejected

pytest_plugins = ["ur_ros_rtde.testing"]


def test_succeeds(arm, simulator):
    assert arm.dashboard.my_command(text="hello").answer == "RUNNING"
    assert simulator.state()["popup"] == "hello"
    simulator.control("close_popup")


def test_a_text_of_two_lines_is_rejected(arm):
    with pytest.raises(Rejected) as rejection:
        arm.dashboard.my_command(text="two\nlines")
    assert "text" in rejection.value.message
