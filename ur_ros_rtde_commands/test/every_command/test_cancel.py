"""A canceled command has exactly one result and leaves the arm at rest."""

import pytest
from action_msgs.msg import GoalStatus
from cell import describe_result
from scenarios import ATTEMPTS, RESULT_LIMIT, cancel_counts_as_success, moves_arm, start_goal
from scenarios import has_feedback as applies_to  # noqa: F401

from ur_ros_rtde_msgs.msg import ErrorCode

GROUP = "stops"


def scenario(cell, example):
    for _attempt in range(ATTEMPTS):
        goal = start_goal(cell, example)
        if goal is None:
            return None
        goal.cancel()
        status, result = goal.wait_for_result(RESULT_LIMIT)
        if not (moves_arm(example) and result.success):
            break  # otherwise the motion was almost finished
    text = describe_result(status, result)
    if cancel_counts_as_success(example):
        assert result.success, text
    elif moves_arm(example):
        assert status == GoalStatus.STATUS_CANCELED and result.error_code == ErrorCode.CANCELED, text
    assert status != GoalStatus.STATUS_ABORTED, text
    cell.wait_for_rest(0.5)
    assert cell.client.get_terminal_states(goal) == {status}
    cell.restore()
    return text


def test_cancel_ends_the_goal_with_the_arm_at_rest(plugin, outcome):
    if outcome is None:
        pytest.skip("ends immediately")
