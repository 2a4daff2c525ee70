"""Shutdown of the driver during each command. test_momentary_commands.py tests commands that end immediately."""

import pytest
from disturbances import SHUTDOWN
from scenarios import disturb
from scenarios import has_feedback as applies_to  # noqa: F401

GROUP = "losses"


def scenario(cell, example):
    cell.load_plugins(example.action)  # because the driver starts again for each example
    return disturb(cell, example, SHUTDOWN)


def test_shutdown_aborts_the_goal_with_the_arm_at_rest(plugin, outcome):
    if outcome is None:
        pytest.skip("ends immediately")
