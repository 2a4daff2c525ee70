"""Emergency stop during each command. test_momentary_commands.py tests commands that end immediately."""

import pytest
from disturbances import EMERGENCY_STOP
from scenarios import disturb
from scenarios import has_feedback as applies_to  # noqa: F401

GROUP = "stops"


def scenario(cell, example):
    return disturb(cell, example, EMERGENCY_STOP)


def test_emergency_stop_aborts_the_goal_with_the_arm_at_rest(plugin, outcome):
    if outcome is None:
        pytest.skip("ends immediately")
