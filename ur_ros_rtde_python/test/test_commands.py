"""Sends goals with the methods of Robot."""

import asyncio
import contextlib
import os
import pickle
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest
from programs import Process, start_node
from support import FEW_PLUGINS, HOME, TIMEOUT_FACTOR, wait_for
from ur_ros_rtde import CommandFailed, NoDriver, Rejected, Robot, RobotError, Timeout, UnknownCommand, pose, trajectory
from ur_ros_rtde.commands import names
from ur_ros_rtde_cli.new import ROBOT_MEMBERS

PLUGINS = ("plugins:=[move_j,move_l,stop,make_ready,trigger_protective_stop,execute_trajectory,execute_parametrized_trajectory,"
           "execute_cartesian_path,set_digital_output,dashboard/robot_mode]")
AWAY = [1.0, *HOME[1:]]
SLOW = 0.2  # rad/s: takes 5 s to AWAY


def test_a_command_returns_its_result(arm):
    result = arm.move_j(AWAY, speed=2.0, acceleration=5.0)
    assert result.success and np.allclose(result.final_state.joint_positions, AWAY, atol=1e-3)


def test_the_fields_are_given_by_name_or_in_their_order(arm, simulator):
    arm.set_digital_output(3, True)
    assert arm.state.digital_outputs[3] and simulator.state()["io"]["digital_outputs"] >> 3 & 1
    arm.set_digital_output(state=False, pin=3)
    assert not arm.state.digital_outputs[3]


def test_commands_in_a_group(arm):
    assert arm.dashboard.robot_mode().answer == "RUNNING"


def test_the_documentation_comes_from_the_interface(arm):
    assert "Speed of the leading joint. Unit: rad/s." in arm.move_j.__doc__
    assert {"move_j", "dashboard", "spiral_search", "state"} <= set(dir(arm)) and "robot_mode" in dir(arm.dashboard)


def test_a_rejection_has_field_value_and_limit(arm):
    with pytest.raises(Rejected, match="speed is 9 rad/s") as rejected:
        arm.move_j(AWAY, speed=9)
    error = rejected.value
    assert (error.field, error.value, error.limit, error.name) == ("speed", 9.0, "above 0 and at most 3.14 rad/s", "INVALID_GOAL")


@pytest.mark.parametrize("values, fields, field, text", [
    ((), {"speeed": 1.0}, "speeed", "did you mean speed"),
    ((HOME,), {"speed": "fast"}, "speed", "expected a number"),
    ((HOME,), {"joint_positions": HOME}, "joint_positions", "given twice"),
    ((HOME, 1.0, 1.0, 1.0), {}, None, "the fields are: joint_positions, speed, acceleration"),
    (([[0.0] * 6],), {}, "joint_positions[0]", "expected a number")])
def test_a_wrong_field_is_rejected_before_it_is_sent(arm, values, fields, field, text):
    with pytest.raises(Rejected, match=text) as rejected:
        arm.move_j(*values, **fields)
    assert rejected.value.field == field


def test_an_unknown_command_raises_an_error_with_a_similar_name(arm):
    with pytest.raises(UnknownCommand, match="did you mean move_j"):
        arm.movej(HOME)
    with pytest.raises(UnknownCommand, match="did you mean dashboard/robot_mode"):
        arm.dashboard.robot_mod()
    assert not hasattr(arm, "_repr_html_")


def test_a_plugin_that_the_driver_has_not_loaded(arm):
    with Robot(timeout=0.5) as other, pytest.raises(NoDriver, match="runs without this plugin"):
        other.spiral_search()


def test_a_rejection_without_a_number_has_its_field(arm):
    with pytest.raises(Rejected, match="must be finite") as rejected:
        arm.move_l([np.nan, 0.0, 0.5, 0.0, 0.0, 0.0, 1.0])
    assert rejected.value.field == "pose.position"


def test_errors_reach_another_process(arm):
    with pytest.raises(Rejected) as rejected:
        arm.move_j(AWAY, speed=9)
    copy = pickle.loads(pickle.dumps(rejected.value))
    assert (copy.field, copy.value, str(copy)) == ("speed", 9.0, str(rejected.value))
    with pytest.raises(CommandFailed) as failed:
        raise CommandFailed("move_j", arm.move_j(HOME))
    assert pickle.loads(pickle.dumps(failed.value)).result == failed.value.result


def test_busy_is_rejected_with_its_remedy(arm):
    with arm.start.move_j(AWAY, SLOW), pytest.raises(Rejected) as rejected:
        arm.move_j(HOME)
    assert rejected.value.name == "BUSY" and "stop()" in rejected.value.remedy


def test_a_failure_has_code_remedy_and_final_state(arm):
    goal = arm.start.move_j(AWAY, SLOW)
    arm.trigger_protective_stop()
    with pytest.raises(CommandFailed, match="the robot is in a protective stop") as failed:
        goal.result(TIMEOUT_FACTOR * 10.0)
    error = failed.value
    assert (error.code, error.name) == (7, "PROTECTIVE_STOP") and "make_ready()" in error.remedy
    assert len(error.result.final_state.joint_positions) == 6
    arm.make_ready()


def test_progress_is_reported_in_the_thread_of_the_call(arm):
    reports = []
    arm.move_j(AWAY, 2.0, 5.0, on_progress=lambda feedback: reports.append((threading.current_thread(), feedback.motion.progress)))
    threads, progress = zip(*reports, strict=True)
    assert set(threads) == {threading.current_thread()} and sorted(progress) == list(progress) and progress[-1] > 0.5


def assert_stopped_early(arm, simulator):
    assert simulator.is_at_rest() and arm.state.joint_positions[0] < 0.9


def test_an_exception_in_a_callback_stops_the_arm_before_it_propagates(arm, simulator):
    def fail(feedback):
        if feedback.motion.progress > 0.05:
            raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        arm.move_j(AWAY, SLOW, on_progress=fail)
    assert_stopped_early(arm, simulator)


def test_ctrl_c_stops_the_arm_before_it_propagates(arm, simulator):
    def interrupt(feedback):
        if feedback.motion.progress > 0.05:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        arm.move_j(AWAY, SLOW, on_progress=interrupt)
    assert_stopped_early(arm, simulator)


def test_a_goal_that_takes_too_long_is_canceled(arm, simulator):
    with pytest.raises(Timeout, match="move_j has not ended within 0.5 s"):
        arm.move_j(AWAY, SLOW, result_timeout=0.5)
    assert_stopped_early(arm, simulator)


def test_a_started_goal_can_be_watched_and_canceled(arm, simulator):
    goal = arm.start.move_j(AWAY, SLOW)
    assert not goal.wait(0.1)
    wait_for(lambda: goal.feedback and goal.feedback.motion.progress > 0.02, 10.0, "feedback")
    result = goal.cancel()
    assert result.error_code == 4 and goal.is_finished
    assert_stopped_early(arm, simulator)
    with pytest.raises(CommandFailed, match="CANCELED"):
        goal.result()


def test_stop_ends_a_started_goal(arm, simulator):
    goal = arm.start.move_j(AWAY, SLOW)
    arm.stop()
    with pytest.raises(CommandFailed) as failed:
        goal.result(TIMEOUT_FACTOR * 10.0)
    assert failed.value.name == "PREEMPTED" and simulator.is_at_rest()


def test_leaving_a_robot_cancels_its_goals(arm, simulator):
    with Robot(timeout=TIMEOUT_FACTOR * 20.0) as other:
        goal = other.start.move_j(AWAY, SLOW)
    assert goal.is_finished
    assert_stopped_early(arm, simulator)


def test_goals_can_be_awaited(arm):
    async def move():
        return await arm.start.move_j(AWAY, 2.0, 5.0)

    assert asyncio.run(move()).success


def test_a_canceled_task_stops_the_arm(arm, simulator):
    async def move():
        await arm.start.move_j(AWAY, SLOW)

    async def cancel():
        await asyncio.wait_for(move(), 0.5)

    with pytest.raises(asyncio.TimeoutError):
        asyncio.run(cancel())
    assert_stopped_early(arm, simulator)


def test_waypoints_and_trajectories_are_arrays(arm):
    result = arm.execute_trajectory(np.linspace(HOME, AWAY, 5), max_velocity=np.full(6, 2.0))
    assert np.allclose(result.final_state.joint_positions, AWAY, atol=1e-2)
    times = np.linspace(0.0, 3.0, 31)
    blend = (1.0 + np.cos(np.pi * times / 3.0)) / 2.0
    positions = np.outer(blend, AWAY) + np.outer(1.0 - blend, HOME)
    result = arm.execute_parametrized_trajectory(trajectory(times, positions), start_tolerance=0.05)
    assert result.duration == pytest.approx(3.0) and np.allclose(result.final_state.joint_positions, HOME, atol=1e-2)


def test_poses_are_arrays(arm):
    start = arm.state.tcp_pose
    arm.move_l(start + [0.0, 0.0, 0.05, 0.0, 0.0, 0.0, 0.0], speed=1.0)
    assert np.allclose(arm.state.tcp_pose, start + [0.0, 0.0, 0.05, 0.0, 0.0, 0.0, 0.0], atol=1e-3)
    arm.move_l(pose(start[:3], start[3:]), speed=1.0)
    arm.execute_cartesian_path([start, start + [0.0, 0.05, 0.0, 0.0, 0.0, 0.0, 0.0]])
    assert np.allclose(arm.state.tcp_pose[:3], start[:3] + [0.0, 0.05, 0.0], atol=1e-3)


@contextlib.contextmanager
def signaled(code, number, simulator):
    """A Python program that gets the signal as soon as it moves the arm, and is killed at the end."""
    program = Process([sys.executable, "-c", code])
    try:
        wait_for(lambda: not simulator.is_at_rest(), 30.0, "the arm to move")
        program.signal(number)
        yield program
    finally:
        program.kill()


@pytest.mark.parametrize("number, code", [(signal.SIGTERM, 128 + signal.SIGTERM), (signal.SIGHUP, 128 + signal.SIGHUP),
                                          (signal.SIGINT, -signal.SIGINT)])
def test_a_signal_stops_the_arm_before_the_program_ends(arm, simulator, number, code):
    moving = f"from ur_ros_rtde import Robot\nwith Robot(timeout=20.0) as arm: arm.move_j({AWAY}, {SLOW})"
    with signaled(moving, number, simulator) as program:
        assert program.wait(20.0) == code, program.output()
    assert_stopped_early(arm, simulator)


@pytest.mark.parametrize("before, after", [("rclpy.init()", ""), ("", "rclpy.init()")], ids=["before", "after"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=["SIGINT", "SIGTERM"])
def test_a_signal_stops_the_arm_of_a_program_that_uses_rclpy_itself(arm, simulator, before, after, number):
    """rclpy's handlers would close the connection first. The program survives, so that no lost client stops the arm."""
    code = f"""
import time
import rclpy
from ur_ros_rtde import Robot
{before}
with Robot(timeout=20.0) as arm:
    {after}
    try:
        arm.move_j({AWAY}, {SLOW})
    except (KeyboardInterrupt, SystemExit):
        print("stopped", arm.state.joint_velocities.max() < 0.01, flush=True)
        time.sleep(30.0)
"""
    with signaled(code, number, simulator) as program:
        wait_for(lambda: "stopped" in program.output(), 20.0, f"the end of the goal: {program.output()}")
        assert "stopped True" in program.output()
        assert_stopped_early(arm, simulator)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=["SIGINT", "SIGTERM"])
def test_a_signal_stops_the_arm_of_a_program_that_spins(arm, simulator, number):
    """rclpy's handlers end rclpy.spin(), and shut down the context of the Robot, too."""
    code = f"""
import time
import rclpy
from rclpy.executors import ExternalShutdownException
from ur_ros_rtde import Robot
rclpy.init()
node = rclpy.create_node("own_node")
try:
    with Robot(timeout=20.0) as arm:
        goal = arm.start.move_j({AWAY}, {SLOW})
        rclpy.spin(node)
except (KeyboardInterrupt, SystemExit, ExternalShutdownException):
    pass
print("closed", flush=True)
time.sleep(30.0)
"""
    with signaled(code, number, simulator) as program:
        wait_for(lambda: "closed" in program.output(), 20.0, f"the end of the Robot: {program.output()}")
        assert simulator.is_at_rest()
        assert_stopped_early(arm, simulator)


def test_a_robot_that_is_closed_leaves_the_signals_to_the_others(arm):
    own = lambda number, frame: None  # noqa: E731
    first, second = Robot("first", timeout=1.0), Robot("second", timeout=1.0)
    handler = signal.getsignal(signal.SIGTERM)
    first.close()
    assert signal.getsignal(signal.SIGTERM) is handler is not signal.SIG_DFL
    before = signal.signal(signal.SIGTERM, own)
    second.close()
    assert signal.signal(signal.SIGTERM, before) is own


def test_the_arguments_of_the_program_do_not_move_a_robot_with_a_namespace(monkeypatch):
    monkeypatch.setattr(sys, "argv", ["program", "--ros-args", "-r", "__ns:=/left"])
    with Robot("right") as right, Robot() as moved:
        assert repr(right) == "Robot(namespace='/right')" and repr(moved) == "Robot(namespace='/left')"


def test_the_members_of_a_robot_are_no_names_of_new_commands(arm):
    own = {name for name in [*vars(arm), *vars(Robot)] if not name.startswith("_")}
    commands = {name.partition("/")[0] for name in names()}  # and their groups
    assert own - commands == set(ROBOT_MEMBERS)


def test_a_closed_robot_says_so(arm):
    robot = Robot()
    robot.close()
    for use in (lambda: robot.move_j(HOME), lambda: robot.state.joint_positions, lambda: robot.state.robot_mode):
        with pytest.raises(RobotError, match="the Robot is closed"):
            use()


def test_a_canceled_task_does_not_wait_for_other_jobs(arm, simulator):
    ends = threading.Event()

    async def cancel():
        loop = asyncio.get_running_loop()
        others = [loop.run_in_executor(None, ends.wait, 60.0) for _ in range(64)]
        task = asyncio.ensure_future(goal._await())
        await asyncio.sleep(0.5)
        task.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await task
        assert simulator.is_at_rest(), "although all threads are busy"
        ends.set()
        await asyncio.gather(*others)

    goal = arm.start.move_j(AWAY, SLOW)
    asyncio.run(cancel())
    assert_stopped_early(arm, simulator)


def test_rclpy_is_imported_only_by_a_robot():
    code = "import sys, ur_ros_rtde; sys.exit('rclpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


def test_a_missing_driver_is_reported_with_the_remedy():
    with Robot("nobody", timeout=0.5) as nobody:
        with pytest.raises(NoDriver, match="no driver serves /nobody/move_j.*namespace"):
            nobody.move_j(HOME)
        with pytest.raises(UnknownCommand, match="there is no command movej; did you mean move_j"):
            nobody.movej(HOME)


def test_a_driver_that_is_killed_ends_the_wait(lost_robot):
    with lost_robot("killed") as (robot, driver, simulator):
        goal = robot.start.move_j(AWAY, SLOW)
        driver.kill()
        with pytest.raises(NoDriver, match="while move_j was running"):
            goal.result(TIMEOUT_FACTOR * 60.0)
        wait_for(simulator.is_at_rest, 10.0, "the watchdog to stop the arm")


def test_a_driver_that_is_started_again_at_once_does_not_hide_its_loss(lost_robot):
    with lost_robot("again") as (robot, driver, simulator):
        assert robot.state.driver_state == "READY"
        goal = robot.start.move_j(AWAY, SLOW)
        driver.kill()
        again = start_node("driver", simulator.address, FEW_PLUGINS, namespace="again")
        try:
            with pytest.raises(NoDriver, match="while move_j was running"):
                goal.result(TIMEOUT_FACTOR * 60.0)
            assert robot.state.wait_until(lambda state: state.driver_state == "READY", TIMEOUT_FACTOR * 30.0), again.output()
        finally:
            again.stop()


def test_the_state_of_a_driver_that_has_ended_is_not_reported(lost_robot):
    with lost_robot("gone") as (robot, driver, _simulator):
        assert robot.state.driver_state == "READY"
        driver.kill()

        def is_reported():
            try:
                return robot.state.driver_state
            except NoDriver:
                return None

        wait_for(lambda: is_reported() is None, 40.0, "the loss of the driver")
