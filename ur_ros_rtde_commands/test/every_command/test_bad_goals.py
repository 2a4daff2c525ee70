"""Each invalid goal derived from types and comments is rejected before acceptance, with the name of the field."""

import re

import bad_goals

from ur_ros_rtde_msgs.msg import ErrorCode

GROUP = "goals"

CODES = (ErrorCode.INVALID_GOAL, ErrorCode.UNREACHABLE, ErrorCode.SAFETY_VIOLATION)
MAX_SHOWN = 20
BATCH = 8  # goals at a time, because ROS services queue at most 10 requests and 10 responses


def scenario(cell, example):
    """Returns the number of invalid goals, and one line for each errors response."""
    kind, good = cell.good_goal(example)
    errors = []
    cases = bad_goals.generate(example.action, example.type, good)
    for begin in range(0, len(cases), BATCH):
        batch = cases[begin:begin + BATCH]
        goals = [cell.client.send_goal(kind, example.action, case.goal) for case in batch]
        errors += [text for case, goal in zip(batch, goals) for text in _find_errors(cell, case, goal)]
        if any(goal.accepted for goal in goals):
            cell.restart_simulator()  # a mode that the goal activated would affect the next one
    assert cell.driver.running(), cell.driver.output()
    return len(cases), errors


def _find_errors(cell, case, goal):
    if goal.accepted:
        goal.cancel()
        goal.wait_for_result()
        return [f"{case.what}: accepted"]
    rejection = cell.client.rejection(goal)
    if rejection.error_code not in CODES:
        return [f"{case.what}: rejected with {rejection.error_code} instead of INVALID_GOAL: {rejection.message}"]
    if not re.search(case.named, rejection.message):
        return [f"{case.what}: the message does not match {case.named}: {rejection.message}"]
    return []


def test_invalid_goals_are_rejected_with_the_field(plugin, outcome):
    count, errors = outcome
    assert not errors, f"{len(errors)} of {count} invalid goals:\n" + "\n".join(errors[:MAX_SHOWN])
