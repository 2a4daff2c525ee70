"""The tests that every command which moves the arm has to pass. In a test module:

    from ur_ros_rtde.command_tests import MovingCommandTests

    pytest_plugins = ["ur_ros_rtde.testing"]


    class TestWag(MovingCommandTests):
        command = "wag"
        goal = {"angle": 1.0}
"""

import inspect
import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any, ClassVar

import numpy
import pytest
from ur_simulator import SimulatedRobot

from .errors import CommandFailed, NoDriver, Rejected
from .goal import Goal
from .robot import Robot
from .testing import Driver

MOVES = 0.02  # rad/s, more than the noise of the sensors
NOT_FINITE = (math.nan, math.inf, -math.inf)
# Events of the simulated robot, their fields, and the reasons with which a goal ends.
EVENTS = [("protective_stop", {"reason": "of the test"}, "PROTECTIVE_STOP"), ("drop_links", {}, "LINK_LOST")]
STOP_LIMIT = 2.0  # s, simulated, of stops that the driver cannot confirm; its watchdog takes 0.5 s, the deceleration the rest


class MovingCommandTests:
    """Base class of the tests of one command. The goal is valid, and its motion takes at least 1 s from the arm's home position.

    `unused` are fields of the goal that the command ignores for this goal: they may have any value."""

    command: ClassVar[str]
    goal: ClassVar[Mapping[str, Any]]
    unused: ClassVar[Collection[str]] = ()

    def test_succeeds_with_the_arm_at_rest(self, arm: Robot, simulator: SimulatedRobot) -> None:
        assert self._moving(arm, simulator).result().success
        assert simulator.is_at_rest()

    def test_cancel_stops_the_arm(self, arm: Robot, simulator: SimulatedRobot) -> None:
        result = self._moving(arm, simulator).cancel()
        assert simulator.is_at_rest()
        assert not result.success, "the goal had ended before it was canceled: give it a longer motion"

    def test_stop_stops_the_arm(self, arm: Robot, simulator: SimulatedRobot) -> None:
        goal = self._moving(arm, simulator)
        arm.stop()
        assert simulator.is_at_rest()
        assert _reason(goal) == "PREEMPTED"

    @pytest.mark.parametrize(("event", "fields", "reason"), EVENTS, ids=[event for event, _fields, _reason in EVENTS])
    def test_an_event_ends_the_goal_with_its_reason(self, arm: Robot, simulator: SimulatedRobot, event: str, fields: Mapping[str, Any],
                                                    reason: str) -> None:
        goal = self._moving(arm, simulator)
        simulator.control(event, **fields)
        assert _reason(goal) == reason
        simulator.wait_for(lambda state: not _moves(state), STOP_LIMIT)

    def test_the_arm_stops_before_the_driver_ends(self, arm: Robot, simulator: SimulatedRobot, driver: Driver) -> None:
        goal = self._moving(arm, simulator)
        driver.stop()
        try:
            assert simulator.is_at_rest()
            assert _reason(goal) == "SHUTDOWN"
        finally:
            driver.start()

    def test_the_watchdog_stops_the_arm_of_a_driver_that_is_killed(self, arm: Robot, simulator: SimulatedRobot, driver: Driver) -> None:
        goal = self._moving(arm, simulator)
        driver.kill()
        try:
            simulator.wait_for(lambda state: not _moves(state), STOP_LIMIT)
            with pytest.raises(NoDriver):
                goal.result()
        finally:
            driver.start()

    def test_numbers_that_are_not_finite_are_rejected(self, arm: Robot, simulator: SimulatedRobot) -> None:
        start = getattr(arm.start, self.command)
        accepted = []
        for field, value in self._complete_goal(arm).items():
            for invalid in _not_finite(value) if field not in self.unused else ():
                try:
                    start(**{**self.goal, field: invalid}).cancel()
                    accepted.append(f"{field} = {invalid}")
                except Rejected as rejection:
                    assert field in rejection.message, f"the rejection of {field} = {invalid} does not name the field"
        assert not accepted, f"accepted: {'; '.join(accepted)}"
        assert simulator.is_at_rest()

    def _complete_goal(self, arm: Robot) -> dict[str, Any]:
        """Returns the goal with the default values of the fields that it does not give."""
        parameters = inspect.signature(getattr(arm.start, self.command)).parameters
        return {**{name: parameter.default for name, parameter in parameters.items()}, **self.goal}

    def _moving(self, arm: Robot, simulator: SimulatedRobot) -> Goal:
        """Returns the goal, accepted, when the arm moves."""
        goal: Goal = getattr(arm.start, self.command)(**self.goal)
        simulator.wait_for(lambda state: _moves(state) or goal.is_finished)
        assert not goal.is_finished, f"{self.command} has ended without a motion: {goal.result()}"
        return goal


def _moves(state: Mapping[str, Any]) -> bool:
    return max(abs(velocity) for velocity in state["actual"]["velocity"]) > MOVES


def _not_finite(value: Any) -> Iterator[Any]:
    """Yields copies of the value of a field in each of which one number is not finite."""
    if isinstance(value, numpy.ndarray):
        value = value.tolist()
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        yield from NOT_FINITE
    elif isinstance(value, Mapping):
        for name, item in value.items():
            yield from ({**value, name: invalid} for invalid in _not_finite(item))
    elif isinstance(value, Sequence) and not isinstance(value, (str, bytes)):
        for index, item in enumerate(value):
            yield from ([*value[:index], invalid, *value[index + 1:]] for invalid in _not_finite(item))


def _reason(goal: Goal) -> str:
    with pytest.raises(CommandFailed) as failure:
        goal.result()
    return failure.value.name
