"""Death of the controller during each command. test_momentary_commands.py tests commands that end immediately."""

import pytest
from disturbances import CONTROLLER_DEATH
from scenarios import disturb
from scenarios import has_feedback as applies_to  # noqa: F401

GROUP = "losses"


def scenario(cell, example):
    return disturb(cell, example, CONTROLLER_DEATH)


def test_controller_death_aborts_the_goal(plugin, outcome):
    if outcome is None:
        pytest.skip("ends immediately")
