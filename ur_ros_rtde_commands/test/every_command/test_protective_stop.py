"""What every command does in the middle of a protective stop. Those that end at once are in test_momentary_commands.py."""

import pytest
from disturbances import PROTECTIVE_STOP
from scenarios import disturb
from scenarios import may_last as concerns  # noqa: F401


def scenario(cell, example):
    return disturb(cell, example, PROTECTIVE_STOP)


def test_protective_stop_ends_the_goal_and_the_arm_stands_still(plugin, outcome):
    if outcome is None:
        pytest.skip("ends at once")
