"""The example of each command's documentation, carried out on the simulator."""

from cell import CODES, EXAMPLE_LIMIT, described
from action_msgs.msg import GoalStatus

# What these leave behind does not show in the simulator's state: the next example gets a fresh simulator.
LASTING = ("set_", "enable_", "force_mode_start", "force_mode_set", "dashboard/shutdown")


def scenario(cell, example):
    cell.prepare(example)
    before = cell.settings()
    goal = cell.send(example)
    assert goal.accepted, f"refused: {cell.refusal(goal)}"
    status, result = goal.wait_for_result(EXAMPLE_LIMIT)
    assert status == GoalStatus.STATUS_SUCCEEDED and result.success and CODES[result.error_code] == "NONE", \
        described(status, result)
    if "/" not in example.action and hasattr(result, "final_state"):
        cell.wait_for_rest(0.5)
    if not cell.simulator.process.running() or cell.settings() != before or example.action.startswith(LASTING):
        cell.restart_simulator()
    return result


def test_the_documented_example_succeeds(plugin, outcome):
    assert outcome.success
