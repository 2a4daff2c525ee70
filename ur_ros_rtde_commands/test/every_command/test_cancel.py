"""Every command that is canceled in the middle ends once, with the arm at rest."""

import pytest
from action_msgs.msg import GoalStatus
from cell import described
from scenarios import RESULT_LIMIT, begin, cancel_counts_as_success
from scenarios import may_last as concerns  # noqa: F401
from scenarios import moves_arm

from ur_ros_rtde_msgs.msg import ErrorCode


def scenario(cell, example):
    goal = begin(cell, example)
    if goal is None:
        return None
    goal.cancel()
    status, result = goal.wait_for_result(RESULT_LIMIT)
    text = described(status, result)
    if cancel_counts_as_success(example):
        assert result.success, text
    elif moves_arm(example):
        assert status == GoalStatus.STATUS_CANCELED and result.error_code == ErrorCode.CANCELED, text
    assert status != GoalStatus.STATUS_ABORTED, text
    cell.wait_for_rest(0.5)
    assert cell.client.endings(goal) == {status}
    cell.restore()
    return text


def test_cancel_ends_the_goal_and_the_arm_stands_still(plugin, outcome):
    if outcome is None:
        pytest.skip("ends at once")
