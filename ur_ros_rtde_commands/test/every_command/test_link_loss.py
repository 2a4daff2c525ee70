"""Loss of all connections during each command. test_momentary_commands.py tests commands that end immediately."""

import pytest
from disturbances import LINK_LOSS
from scenarios import disturb
from scenarios import has_feedback as applies_to  # noqa: F401

GROUP = "losses"


def scenario(cell, example):
    return disturb(cell, example, LINK_LOSS)


def test_link_loss_aborts_the_goal_with_the_arm_at_rest(plugin, outcome):
    if outcome is None:
        pytest.skip("ends immediately")
