"""The documented example of each command succeeds on the simulator."""

from action_msgs.msg import GoalStatus
from cell import CODES, EXAMPLE_LIMIT, describe_result

GROUP = "goals"

# The effects of these commands are not part of Cell.settings(). The simulator is restarted after them.
PERSISTENT = ("set_", "enable_", "force_mode_start", "force_mode_set", "dashboard/shutdown")


def scenario(cell, example):
    cell.prepare(example)
    before = cell.settings()
    goal = cell.send(example)
    assert goal.accepted, f"rejected: {cell.rejection(goal)}"
    status, result = goal.wait_for_result(EXAMPLE_LIMIT)
    assert status == GoalStatus.STATUS_SUCCEEDED and result.success and CODES[result.error_code] == "NONE", \
        describe_result(status, result)
    if "/" not in example.action and hasattr(result, "final_state"):
        cell.wait_for_rest(0.5)
    if not cell.simulator.process.running() or cell.settings() != before or example.action.startswith(PERSISTENT):
        cell.restart_simulator()
    return result


def test_the_documented_example_succeeds(plugin, outcome):
    assert outcome.success
