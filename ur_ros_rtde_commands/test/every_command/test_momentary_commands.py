"""Commands that end at once, all of them at the moment at which something happens."""

import disturbances
import pytest
from conftest import examples
from documentation import Setup
from scenarios import RESULT_LIMIT, described, may_last
from support import wait_for

from ur_ros_rtde_msgs.msg import ErrorCode

ANSWER_LIMIT = 10.0  # s


def momentary():
    """Of the dashboard what only asks: nothing whose order would matter."""
    return [example for example in examples().values() if not may_last(example) and example.setup == Setup()
            and ("/" not in example.action or example.type.endswith("DashboardQuery"))]


def is_question(example):
    return example.action.split("/")[-1].startswith(("get_", "is_"))


def scenario(cell, disturbance):
    cell.prepare()
    goals = [(example, cell.send(example)) for example in momentary()]
    disturbance.happen(cell)
    for example, goal in goals:
        _check_answer(cell, example, goal)
    disturbance.recover(cell)
    cell.unlock()  # one of them triggers a protective stop
    cell.restore()
    for example in filter(is_question, momentary()):
        cell.send(example).succeeded()
    return len(goals)


def _check_answer(cell, example, goal):
    wait_for(lambda: goal.answered() or not cell.driver.running(), ANSWER_LIMIT, f"the answer to {example.action}")
    if not goal.answered():
        return  # the node had ended before it looked at it
    if not goal.accepted:
        assert cell.refusal(goal), f"{example.action}: refused without a reason"
        return
    status, result = goal.wait_for_result(RESULT_LIMIT)
    text = f"{example.action}: {described(status, result)}"
    assert result.success == (result.error_code == ErrorCode.NONE) and (result.success or result.message), text
    assert cell.client.endings(goal) == {status}, text


@pytest.mark.parametrize("disturbance", disturbances.ALL, ids=lambda disturbance: disturbance.name)
def test_each_of_them_gets_one_answer(disturbance, cells):
    assert cells.submit(scenario, disturbance).result(120.0) > 0
