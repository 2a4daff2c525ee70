"""Every bad goal that follows from a command's types and comments is refused before acceptance, naming the field."""

import re

import bad_goals

from ur_ros_rtde_msgs.msg import ErrorCode

CODES = (ErrorCode.INVALID_GOAL, ErrorCode.UNREACHABLE, ErrorCode.SAFETY_VIOLATION)
SHOWN = 20
AT_ONCE = 8  # ROS services keep the last 10 requests, and the last 10 answers


def scenario(cell, example):
    """What is wrong with the answers to the bad goals: one line each."""
    kind, good = cell.good_goal(example)
    wrong = []
    cases = bad_goals.make(example.action, example.type, good)
    for begin in range(0, len(cases), AT_ONCE):
        part = cases[begin:begin + AT_ONCE]
        goals = [cell.client.send_goal(kind, example.action, case.goal) for case in part]
        wrong += [text for case, goal in zip(part, goals) for text in _wrong(cell, case, goal)]
        if any(goal.accepted for goal in goals):
            cell.restart_simulator()  # what it switched on would be in the way of the next
    assert cell.driver.running(), cell.driver.output()
    return len(cases), wrong


def _wrong(cell, case, goal):
    if goal.accepted:
        goal.cancel()
        goal.wait_for_result()
        return [f"{case.what}: accepted"]
    refusal = cell.client.refusal(goal)
    if refusal.error_code not in CODES:
        return [f"{case.what}: refused with {refusal.error_code} instead of INVALID_GOAL: {refusal.message}"]
    return [] if re.search(case.named, refusal.message) else [f"{case.what}: the reason does not name {case.named}: {refusal.message}"]


def test_bad_goals_are_refused_with_the_field(plugin, outcome):
    number, wrong = outcome
    assert not wrong, f"{len(wrong)} of {number} bad goals:\n" + "\n".join(wrong[:SHOWN])
