"""Script commands: output, errors, and the restart of the control program after a script."""

import time

import pytest
from action_msgs.msg import GoalStatus
from arm_state import get_joint_state, home_plus, is_at_rest, wait_until_moving
from support import HOME, wait_for

from ur_ros_rtde_msgs.action import DashboardCommand, MoveJ, SendScript, Stop, Trigger
from ur_ros_rtde_msgs.msg import ErrorCode


def send(robot, script="", name="send_script", **fields):
    return robot.send(SendScript, name, script=script, **fields)


def accepts_motions(robot):
    goal = robot.send(MoveJ, "move_j", joint_positions=HOME, speed=1.0)
    return goal.accepted and goal.result().success


def test_a_script_moves_the_arm_and_its_output_is_returned(robot):
    goal = send(robot, f'def turn():\n  textmsg("first")\n  movej({home_plus(0.2)}, a=2, v=1)\n  textmsg("last: ", 1 + 1)\nend\n')
    result = goal.succeeded()
    assert list(result.output) == ["first", "last: 2"] and result.line == 0 and result.run_time > 0.1
    assert [feedback.output for feedback in goal.feedback] == ["first", "last: 2"]
    assert get_joint_state(robot).position[0] == pytest.approx(0.2, abs=0.01)
    assert accepts_motions(robot)


def test_reads_a_script_from_a_file(robot, tmp_path):
    file = tmp_path / "hello.script"
    file.write_text('textmsg("from a file")\n')
    assert list(send(robot, path=str(file)).succeeded().output) == ["from a file"]


@pytest.mark.parametrize("script,line", [("def bad():\n  sync()\n  x = = 3\nend\n", 3), ("sync()\nno_such_function()\n", 2)])
def test_a_compile_error_is_returned_with_its_line(robot, script, line):
    status, result = send(robot, script).wait_for_result()
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, ErrorCode.REJECTED_BY_ROBOT), result.message
    assert result.line in (line, line + 1) and str(result.line) in result.message
    assert accepts_motions(robot)


def test_a_runtime_error_is_returned_with_its_line_and_the_output(robot):
    status, result = send(robot, 'textmsg("before")\nx = [1, 2]\ny = x[5]\ntextmsg("never")\n').wait_for_result()
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, ErrorCode.REJECTED_BY_ROBOT), result.message
    assert list(result.output) == ["before"] and result.line == 3
    assert accepts_motions(robot)


def test_cancel_stops_a_moving_script(robot):
    goal = send(robot, f"movej({home_plus(1.5)}, a=1, v=0.5)")
    wait_until_moving(robot)
    goal.cancel()
    status, result = goal.wait_for_result()
    assert (status, result.error_code) == (GoalStatus.STATUS_CANCELED, ErrorCode.CANCELED)
    assert is_at_rest(robot) and get_joint_state(robot).position[0] < 1.4
    assert accepts_motions(robot)


def test_timeout_stops_a_script(robot):
    status, result = send(robot, "while True:\n  sync()\nend", timeout=0.5).wait_for_result()
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, ErrorCode.TIMEOUT), result.message
    assert accepts_motions(robot)


def test_stop_preempts_a_script(robot):
    goal = send(robot, f"movej({home_plus(1.5)}, a=1, v=0.5)")
    wait_until_moving(robot)
    robot.send(Stop, "stop").succeeded()
    assert goal.wait_for_result()[1].error_code == ErrorCode.PREEMPTED and is_at_rest(robot)


@pytest.mark.parametrize("delay", [0.0, 0.005, 0.01, 0.015, 0.02, 0.03])
def test_dashboard_stop_ends_a_script_that_has_not_begun(robot, driver, simulator, delay):
    """The driver has ended its control program; until the script begins, the dashboard server has nothing to stop."""
    goal = send(robot, f"movej({home_plus(1.5)}, a=1, v=0.5)")
    assert goal.accepted
    time.sleep(delay)
    robot.send(DashboardCommand, "dashboard/stop").succeeded()
    assert goal.wait_for_result(5.0)[1].error_code == ErrorCode.PROGRAM_STOPPED
    assert simulator.state()["target"]["position"][0] < 0.2
    assert accepts_motions(robot), driver.output()


def test_a_motion_is_rejected_while_a_script_runs(robot):
    goal = send(robot, 'while True:\n  textmsg("on")\n  sleep(0.05)\nend')
    wait_for(lambda: goal.feedback, 10.0, "the script to run")
    rejected = robot.send(MoveJ, "move_j", joint_positions=HOME)
    assert not rejected.accepted and robot.rejection(rejected).error_code == ErrorCode.BUSY
    assert "send_script" in robot.rejection(rejected).message
    goal.cancel()
    goal.wait_for_result()


def test_a_secondary_script_does_not_interrupt_a_motion(robot, simulator):
    motion = robot.send(MoveJ, "move_j", joint_positions=home_plus(1.0), speed=0.5)
    wait_until_moving(robot)
    send(robot, "sec light():\n  set_standard_digital_out(5, True)\nend\n", name="send_secondary_script").succeeded()
    assert simulator.state()["io"]["digital_outputs"] >> 5 & 1 and not is_at_rest(robot)
    status, result = send(robot, "no_such_function()", name="send_secondary_script").wait_for_result()
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, ErrorCode.REJECTED_BY_ROBOT), result.message
    motion.succeeded()


@pytest.mark.parametrize("fields,field", [({}, "script"), ({"script": "sync()", "path": "/nowhere/x"}, "script"),
                                          ({"path": "relative.script"}, "path"), ({"path": "/no/such/file"}, "path"),
                                          ({"script": "sync()", "timeout": 0.0}, "timeout"), ({"script": "#" * 1_000_001}, "script")])
def test_a_goal_without_exactly_one_script_is_rejected(robot, fields, field):
    goal = robot.send(SendScript, "send_script", **fields)
    assert not goal.accepted
    rejection = robot.rejection(goal)
    assert rejection.error_code == ErrorCode.INVALID_GOAL and field in rejection.message


def test_reupload_script_restarts_the_control_program(robot, simulator):
    robot.send(Trigger, "reupload_script").succeeded()
    assert accepts_motions(robot)
