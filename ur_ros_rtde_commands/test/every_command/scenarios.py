"""Events during the execution of a goal, and the conditions that must hold for each command."""

import time
from dataclasses import dataclass
from typing import Callable, Optional, Tuple

import messages
from action_msgs.msg import GoalStatus
from cell import describe_result
from ur_ros_rtde_cli import interface_files

from ur_ros_rtde_msgs.msg import ErrorCode

IN_PROGRESS = 0.35  # s, time after which a goal without a result counts as in progress
COMPLIANT = 0.6  # s, time without motion after which the arm counts as compliant and waiting for a push
RESULT_LIMIT = 6.0  # s, from a disturbance to the result
ATTEMPTS = 3  # to disturb a goal in progress
WAIT_LIMIT = 2.0  # s, for a command that waits for a state without moving the arm
MOVING = 0.02  # rad/s


@dataclass(frozen=True)
class Disturbance:
    name: str
    cause: Callable  # function of the cell
    codes: Tuple[int, ...]  # possible error codes of a goal that moves the arm
    recover: Callable  # function of the cell, recovers as an operator would
    repeat: bool = False  # whether the example is repeated after the recovery


def activates_mode(example):
    """Returns whether the goal ends immediately and leaves a mode active, such as force mode."""
    return example.action.endswith("_start")


def moves_arm(example):
    """Returns whether the command moves the arm: its feedback contains progress, and it neither stops a motion nor starts a mode."""
    action = messages.load(example.type)
    return ("motion" in action.Feedback.get_fields_and_field_types()
            and "time_to_standstill" not in action.Result.get_fields_and_field_types() and not activates_mode(example))


def has_feedback(example):
    """Returns whether the action has feedback. Actions without feedback end immediately."""
    return bool(messages.load(example.type).Feedback.get_fields_and_field_types())


def cancel_counts_as_success(example):
    text = " ".join(field.comment for field in interface_files.fields(example.type).values())
    return "counts as success" in text + " " + interface_files.description(example.type)


def start_goal(cell, example):
    """Returns the example's goal during its execution. None if the command ends immediately, which is an error for motions."""
    cell.prepare(example)
    goal = cell.send(example)
    assert goal.accepted, f"rejected: {cell.rejection(goal)}"
    moves, begin = moves_arm(example), time.monotonic()
    while not goal.is_finished():
        elapsed = time.monotonic() - begin
        speeds = cell.simulator.state()["actual"]["velocity"] if moves else ()
        if elapsed > IN_PROGRESS and (elapsed > COMPLIANT or not moves or max(map(abs, speeds)) > MOVING):
            return goal
        time.sleep(0.01)
    status, result = goal.wait_for_result()
    assert result.success, f"before the disturbance: {describe_result(status, result)}"
    assert not moves, f"the motion ended after {time.monotonic() - begin:.2f} s, before it could be disturbed: make the example longer"
    if activates_mode(example):
        cell.stop_arm()
    return None


def disturb(cell, example, disturbance) -> Optional[str]:
    """Disturbs the example's goal. Returns the result as text. None if the command ends immediately."""
    for remaining in reversed(range(ATTEMPTS)):
        goal = start_goal(cell, example)
        if goal is None:
            return None
        disturbance.cause(cell)
        if not (remaining and moves_arm(example) and goal.wait_for_result(RESULT_LIMIT)[1].success):
            break
        disturbance.recover(cell)  # the motion was almost finished: try again
    outcome = check_result(cell, goal, example, disturbance)
    disturbance.recover(cell)
    cell.restore()
    if disturbance.repeat and moves_arm(example):
        cell.prepare(example)
        cell.send(example).succeeded()
    return outcome


def _cancel_if_active(cell, goal):
    """Cancels the goal if it is active and its server is available."""
    end = time.monotonic() + WAIT_LIMIT
    while not goal.is_finished() and time.monotonic() < end:
        time.sleep(0.01)
    if not goal.is_finished() and cell.driver.running():
        goal.cancel()


def check_result(cell, goal, example, disturbance):
    if not moves_arm(example):
        _cancel_if_active(cell, goal)
    status, result = goal.wait_for_result(RESULT_LIMIT)
    text = describe_result(status, result)
    if moves_arm(example):
        assert status == GoalStatus.STATUS_ABORTED and result.error_code in disturbance.codes, text
    assert result.success == (status == GoalStatus.STATUS_SUCCEEDED) == (result.error_code == ErrorCode.NONE), text
    assert result.success or result.message, f"a failure without a message: {text}"
    if cell.simulator.process.running():
        cell.wait_for_rest()
    assert cell.client.get_terminal_states(goal) == {status}, f"terminal states {cell.client.get_terminal_states(goal)}"
    return text
