"""Events during the execution of a goal, and the conditions that must hold for each command."""

import time
from dataclasses import dataclass
from typing import Callable, Optional, Tuple

import action_files
import messages
from action_msgs.msg import GoalStatus
from cell import described

from ur_ros_rtde_msgs.msg import ErrorCode

MIDDLE = 0.35  # s after which a goal that has not ended counts as one in the middle
COMPLIANT = 0.6  # s without motion after which a compliant arm is expected to wait for a push
RESULT_LIMIT = 6.0  # s from a disturbance to the result
ATTEMPTS = 3  # to meet a goal in its middle
PATIENCE = 2.0  # s for a command that moves no arm and may wait for a state as long as its timeout says
MOVING = 0.02  # rad/s


@dataclass(frozen=True)
class Disturbance:
    name: str
    happen: Callable  # of the cell
    codes: Tuple[int, ...]  # of a goal that moves the arm
    recover: Callable  # of the cell, as its user would
    again: bool = False  # the same example once more, afterwards


def switches_mode_on(example):
    """Whether the goal ends at once and leaves a mode active, such as force mode."""
    return example.action.endswith("_start")


def moves_arm(example):
    """Whether the command moves the arm: its feedback has the progress of a motion, and it neither stops one nor starts a mode."""
    action = messages.load(example.type)
    return ("motion" in action.Feedback.get_fields_and_field_types()
            and "time_to_standstill" not in action.Result.get_fields_and_field_types() and not switches_mode_on(example))


def may_last(example):
    """A command that tells how far it is."""
    return bool(messages.load(example.type).Feedback.get_fields_and_field_types())


def cancel_counts_as_success(example):
    text = " ".join(field.comment for field in action_files.fields(example.type).values())
    return "counts as success" in text + " " + action_files.description(example.type)


def begin(cell, example):
    """Returns the example's goal while it is executed; None if its command ends at once, which a motion must not."""
    cell.prepare(example)
    goal = cell.send(example)
    assert goal.accepted, f"refused: {cell.refusal(goal)}"
    moves, start = moves_arm(example), time.monotonic()
    while not goal.is_finished():
        passed = time.monotonic() - start
        speeds = cell.simulator.state()["actual"]["velocity"] if moves else ()
        if passed > MIDDLE and (passed > COMPLIANT or not moves or max(map(abs, speeds)) > MOVING):
            return goal
        time.sleep(0.01)
    status, result = goal.wait_for_result()
    assert result.success, f"before anything happened: {described(status, result)}"
    assert not moves, f"the motion ended after {time.monotonic() - start:.2f} s, before it could be disturbed: make the example longer"
    if switches_mode_on(example):
        cell.stop()
    return None


def disturb(cell, example, disturbance) -> Optional[str]:
    """Its outcome in words; None for a command that ends at once."""
    for left in reversed(range(ATTEMPTS)):
        goal = begin(cell, example)
        if goal is None:
            return None
        disturbance.happen(cell)
        if not (left and moves_arm(example) and goal.wait_for_result(RESULT_LIMIT)[1].success):
            break
        disturbance.recover(cell)  # it was as good as there: once more
    outcome = check_end(cell, goal, example, disturbance)
    disturbance.recover(cell)
    cell.restore()
    if disturbance.again and moves_arm(example):
        cell.prepare(example)
        cell.send(example).succeeded()
    return outcome


def _give_up(cell, goal):
    """Cancels the goal if it is active and its server is available."""
    end = time.monotonic() + PATIENCE
    while not goal.is_finished() and time.monotonic() < end:
        time.sleep(0.01)
    if not goal.is_finished() and cell.driver.running():
        goal.cancel()


def check_end(cell, goal, example, disturbance):
    if not moves_arm(example):
        _give_up(cell, goal)
    status, result = goal.wait_for_result(RESULT_LIMIT)
    text = described(status, result)
    if moves_arm(example):
        assert status == GoalStatus.STATUS_ABORTED and result.error_code in disturbance.codes, text
    assert result.success == (status == GoalStatus.STATUS_SUCCEEDED) == (result.error_code == ErrorCode.NONE), text
    assert result.success or result.message, f"a failure without a reason: {text}"
    if cell.simulator.process.running():
        cell.wait_for_rest()
    assert cell.client.endings(goal) == {status}, f"it ended as {cell.client.endings(goal)}"
    return text
