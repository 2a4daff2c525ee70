"""Goals that preempt others with on_busy: preempt, and what ends those that still wait for the arm or the control program."""

import time

import pytest
from action_msgs.msg import GoalStatus
from programs import start_node
from robot_fixtures import make_ready, send_after_stop
from support import FEW_PLUGINS, HOME, wait_for

from ur_ros_rtde_msgs.action import DashboardCommand, DirectTorque, MoveJ, SendScript, ServoJ, Stop
from ur_ros_rtde_msgs.msg import ErrorCode

FAR_TARGET = [2.5, *HOME[1:]]
# Goals whose stop ends the control program.
PROGRAM_ENDING = {
    "direct_torque": (DirectTorque, {"joint_torques": [8.0, 0.0, 0.0, 0.0, 0.0, 0.0], "duration": 5.0, "max_joint_speed": 2.5}),
    "send_script": (SendScript, {"script": "q = get_actual_joint_positions()\nq[0] = q[0] + 1.5\nmovej(q, a=1, v=0.3)"}),
}


def test_with_on_busy_preempt_a_new_goal_preempts_the_running_motion(simulator, client, processes):
    processes(start_node("driver", simulator.address, FEW_PLUGINS, "on_busy:=preempt"))
    make_ready(client)
    first = client.send(MoveJ, "move_j", joint_positions=FAR_TARGET, speed=0.3)
    wait_for(lambda: first.feedback and first.feedback[-1].motion.progress > 0.05, 10.0, "the motion")
    second = client.send(MoveJ, "move_j", joint_positions=HOME, speed=0.6)
    status, result = first.wait_for_result()
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == ErrorCode.PREEMPTED
    assert "move_j" in result.message
    second.succeeded()


@pytest.fixture
def preempting(simulator, client, processes):
    """A driver with on_busy: preempt. Returns a function that starts a goal of PROGRAM_ENDING and waits until it moves the arm."""
    plugins = "plugins:=[move_j,stop,direct_torque,send_script,dashboard/stop]"
    processes(start_node("driver", simulator.address, plugins, "on_busy:=preempt"))
    make_ready(client)

    def start(name):
        action, fields = PROGRAM_ENDING[name]
        goal = client.send(action, name, **fields)
        wait_for(lambda: abs(simulator.state()["actual"]["velocity"][0]) > 0.05, 10.0, "a motion")
        return goal

    return start


@pytest.mark.parametrize("name", PROGRAM_ENDING)
def test_a_goal_preempts_one_whose_stop_ends_the_control_program(client, preempting, name):
    first = preempting(name)
    client.send(MoveJ, "move_j", joint_positions=HOME, speed=0.6).succeeded()
    assert first.wait_for_result()[1].error_code == ErrorCode.PREEMPTED


def test_a_servo_motion_is_checked_where_the_arm_has_come_to_rest(simulator, client, processes):
    processes(start_node("driver", simulator.address, "plugins:=[move_j,servo_j,stop]", "on_busy:=preempt"))
    make_ready(client)
    client.send(ServoJ, "servo_j", joint_positions=HOME).succeeded()  # so that the next one is sent at once
    fast = client.send(MoveJ, "move_j", joint_positions=FAR_TARGET, speed=2.0, acceleration=5.0)
    wait_for(lambda: simulator.state()["actual"]["velocity"][0] > 1.9, 10.0, "a fast motion")
    # Within reach in this time, in passing. The arm comes to rest about 1 rad further.
    ahead = simulator.state()["actual"]["position"]
    ahead[0] += 0.3
    _, result = client.send(ServoJ, "servo_j", joint_positions=ahead, time=0.3).wait_for_result()
    assert result.error_code == ErrorCode.INVALID_GOAL and "use a time of at least" in result.message, result.message
    assert fast.wait_for_result()[1].error_code == ErrorCode.PREEMPTED


@pytest.mark.parametrize("name", PROGRAM_ENDING)
def test_a_goal_that_preempts_the_program_does_not_outlast_a_safeguard_stop(simulator, client, preempting, name):
    preempting(name)
    waiting = client.send(MoveJ, "move_j", joint_positions=HOME, speed=0.6)
    assert waiting.accepted
    simulator.control("safeguard")
    status, result = waiting.wait_for_result()
    simulator.control("safeguard", open=False)
    assert status == GoalStatus.STATUS_ABORTED, result
    make_ready(client)


@pytest.mark.parametrize("name", PROGRAM_ENDING)
def test_dashboard_stop_ends_a_goal_that_waits_for_the_control_program(simulator, client, preempting, name):
    client.send(DashboardCommand, "dashboard/stop").succeeded()  # so that the next one is sent at once
    make_ready(client)
    preempting(name)
    simulator.control("remote_control", on=False)  # so that the control program is not started again
    waiting = client.send(MoveJ, "move_j", joint_positions=FAR_TARGET, speed=0.6)
    wait_for(lambda: simulator.state()["program"]["state"] == "STOPPED", 10.0, "the end of the program")
    simulator.control("remote_control")
    client.send(DashboardCommand, "dashboard/stop").succeeded()
    _, result = waiting.wait_for_result()
    assert result.error_code == ErrorCode.PREEMPTED and "the arm was stopped" in result.message, result.message


def test_stop_ends_a_goal_that_waits_for_the_control_program_at_once(simulator, client, preempting):
    preempting("direct_torque")
    simulator.control("remote_control", on=False)  # so that the control program is not started again
    waiting = client.send(MoveJ, "move_j", joint_positions=FAR_TARGET, speed=0.6)
    wait_for(lambda: simulator.state()["program"]["state"] == "STOPPED", 10.0, "the end of the program")
    client.send(Stop, "stop").succeeded()
    try:
        _, result = waiting.wait_for_result(3.0)  # without the stop, it waits for the program for 6 s
    finally:
        simulator.control("remote_control")
    assert result.error_code == ErrorCode.PREEMPTED and "the arm was stopped" in result.message, result.message


@pytest.fixture
def fast_goal_and_one_that_preempts_it(simulator, client, processes):
    """The second goal has been accepted, and waits until the arm stands, which takes 1 s."""
    processes(start_node("driver", simulator.address, FEW_PLUGINS, "on_busy:=preempt"))
    make_ready(client)
    first = client.send(MoveJ, "move_j", joint_positions=FAR_TARGET, speed=2.0, acceleration=10.0)
    wait_for(lambda: simulator.state()["actual"]["velocity"][0] > 1.9, 10.0, "the speed from which the arm stops in 1 s")
    waiting = client.send(MoveJ, "move_j", joint_positions=HOME, speed=2.0)
    assert waiting.accepted
    return first, waiting


def test_a_goal_that_was_received_before_a_stop_does_not_move_the_arm_after_it(simulator, client, fast_goal_and_one_that_preempts_it):
    first, waiting = fast_goal_and_one_that_preempts_it
    assert client.send(Stop, "stop").wait_for_result()[1].success
    for goal in (first, waiting):
        status, result = goal.wait_for_result()
        assert status == GoalStatus.STATUS_ABORTED and result.error_code == ErrorCode.PREEMPTED, result.message
    position = simulator.state()["actual"]["position"]
    time.sleep(0.3)
    assert simulator.state()["actual"]["position"] == pytest.approx(position, abs=1e-3)
    send_after_stop(client, MoveJ, "move_j", joint_positions=HOME, speed=2.0).succeeded()


@pytest.mark.parametrize("event, end, code", [
    (("safeguard", {}), ("safeguard", {"open": False}), ErrorCode.SAFEGUARD_STOP),
    (("stop_program", {}), None, ErrorCode.PROGRAM_STOPPED),
])
def test_a_goal_that_waits_to_preempt_does_not_outlast_the_end_of_the_program(simulator, client, fast_goal_and_one_that_preempts_it,
                                                                              event, end, code):
    first, waiting = fast_goal_and_one_that_preempts_it
    simulator.control(event[0], **event[1])
    first.wait_for_result()
    if end:
        simulator.control(end[0], **end[1])
    assert waiting.wait_for_result()[1].error_code == code, waiting.wait_for_result()[1].message
    make_ready(client)
    position = simulator.state()["actual"]["position"]
    time.sleep(0.3)
    assert simulator.state()["actual"]["position"] == pytest.approx(position, abs=1e-3)
    client.send(MoveJ, "move_j", joint_positions=HOME, speed=2.0).succeeded()
