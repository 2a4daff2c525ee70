"""What every command does in the middle of the end of the node. Those that end at once are in test_momentary_commands.py."""

import pytest
from disturbances import SHUTDOWN
from scenarios import disturb
from scenarios import may_last as concerns  # noqa: F401


def scenario(cell, example):
    return disturb(cell, example, SHUTDOWN)


def test_shutdown_ends_the_goal_and_the_arm_stands_still(plugin, outcome):
    if outcome is None:
        pytest.skip("ends at once")
