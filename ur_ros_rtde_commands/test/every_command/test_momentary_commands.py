"""Disturbances while all commands that end immediately are sent at once."""

import disturbances
import pytest
from conftest import examples
from documentation import Setup
from scenarios import RESULT_LIMIT, describe_result, has_feedback
from support import wait_for

from ur_ros_rtde_msgs.msg import ErrorCode

GROUP = "goals"

RESPONSE_LIMIT = 10.0  # s


def momentary_examples():
    """Returns the examples that end immediately. Of the dashboard, only queries, because the order of commands matters."""
    return [example for example in examples().values() if not has_feedback(example) and example.setup == Setup()
            and ("/" not in example.action or example.type.endswith("DashboardQuery"))]


def is_query(example):
    return example.action.split("/")[-1].startswith(("get_", "is_"))


def scenario(cell, disturbance):
    cell.prepare()
    goals = [(example, cell.send(example)) for example in momentary_examples()]
    disturbance.cause(cell)
    for example, goal in goals:
        _check_response(cell, example, goal)
    disturbance.recover(cell)
    cell.unlock_protective_stop()  # one of the commands triggers a protective stop
    cell.restore()
    for example in filter(is_query, momentary_examples()):
        cell.send(example).succeeded()
    return len(goals)


def _check_response(cell, example, goal):
    wait_for(lambda: goal.answered() or not cell.driver.running(), RESPONSE_LIMIT, f"the response to {example.action}")
    if not goal.answered():
        return  # the node exited before it handled the goal
    if not goal.accepted:
        assert cell.rejection(goal), f"{example.action}: rejected without a message"
        return
    wait_for(lambda: goal.is_finished() or not cell.driver.running(), RESULT_LIMIT, f"the result of {example.action}")
    if not goal.is_finished():
        return  # the node exited before this client, which is late, asked for the result
    status, result = goal.wait_for_result()
    text = f"{example.action}: {describe_result(status, result)}"
    assert result.success == (result.error_code == ErrorCode.NONE) and (result.success or result.message), text
    assert cell.client.get_terminal_states(goal) == {status}, text


@pytest.mark.parametrize("disturbance", disturbances.ALL, ids=lambda disturbance: disturbance.name)
def test_each_command_gets_one_response(disturbance, cell_pool):
    assert cell_pool.submit(scenario, disturbance).result(120.0) > 0
