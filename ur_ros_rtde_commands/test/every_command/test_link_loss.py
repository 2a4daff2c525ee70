"""What every command does in the middle of the loss of all links. Those that end at once are in test_momentary_commands.py."""

import pytest
from disturbances import LINK_LOSS
from scenarios import disturb
from scenarios import may_last as concerns  # noqa: F401


def scenario(cell, example):
    return disturb(cell, example, LINK_LOSS)


def test_link_loss_ends_the_goal_and_the_arm_stands_still(plugin, outcome):
    if outcome is None:
        pytest.skip("ends at once")
