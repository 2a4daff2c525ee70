"""Tests of execute_trajectory and execute_parametrized_trajectory on the simulator."""

import math

import pytest
from action_msgs.msg import GoalStatus
from arm_state import home_plus
from programs import Simulator, start_node
from robot_fixtures import make_ready
from ros_client import Client
from sensor_msgs.msg import JointState
from support import HOME, JOINTS, wait_for
from trajectories import TargetRecorder, distance_to_line, point, timed, wave, waypoints

from ur_ros_rtde_msgs.action import ExecuteParametrizedTrajectory, ExecuteTrajectory, MoveJ, Stop
from ur_ros_rtde_msgs.msg import ErrorCode

PLUGINS = "plugins:=[move_j,stop,execute_trajectory,execute_parametrized_trajectory]"
NAN = math.nan
FAST = {"max_velocity": [1.8] * 6, "max_acceleration": [5.0] * 6}
MIN_LOOKAHEAD = 0.03  # s, the smallest lookahead_time
# After a longer gap between setpoints, the driver slows the trajectory down, and returns to the planned rate in at most 0.5 s.
BRIDGED_CYCLES = 4
SLOWED_SETPOINTS = 250


def send(robot, positions, **fields):
    return robot.send(ExecuteTrajectory, "execute_trajectory", waypoints=waypoints(*positions), **fields)


def send_timed(robot, trajectory, **fields):
    return robot.send(ExecuteParametrizedTrajectory, "execute_parametrized_trajectory", trajectory=trajectory, **fields)


def min_deviation(states, positions):
    return min(max(abs(a - b) for a, b in zip(state.position, positions)) for state in states)


def wait_for_progress(goal, progress):
    goal.wait_until(lambda: any(f.motion.progress > progress for f in goal.feedback), 20.0, f"a progress of {progress}")


def test_passes_through_every_waypoint(robot):
    corners = [HOME, home_plus(0.3), home_plus(0.3, 0.2), home_plus(0.1, 0.1, -0.2), HOME]
    states = robot.subscribe(JointState, "joint_states")
    goal = send(robot, corners, lookahead_time=MIN_LOOKAHEAD)
    result = goal.succeeded()
    assert result.final_state.joint_positions == pytest.approx(HOME, abs=0.005)
    states = robot.messages_until_now(states)
    for corner in corners:
        assert min_deviation(states, corner) < 0.01
    assert 0.0 < result.max_tracking_error < 0.02


def test_takes_the_planned_time_and_reports_progress(robot, simulator):
    begin = simulator.state()["timestamp"]
    goal = send(robot, wave(200), lookahead_time=MIN_LOOKAHEAD)
    result = goal.succeeded()
    elapsed = simulator.state()["timestamp"] - begin
    assert result.duration < elapsed < 8.0 * result.duration + 2.0  # longer on a busy host
    feedback = goal.feedback
    progress = [f.motion.progress for f in feedback]
    indices = [f.waypoint for f in feedback]
    assert progress == sorted(progress) and indices == sorted(indices) and indices[-1] <= 199
    assert all(abs(f.tracking_error) < 0.05 for f in feedback)
    remaining = [f.time_left for f in feedback if f.time_left > 0.0]  # 0 during planning
    assert remaining == sorted(remaining, reverse=True) and remaining[0] <= result.duration


def test_speed_fraction_increases_the_duration(robot):
    fast = send(robot, [HOME, home_plus(0.3), HOME], **FAST).succeeded()
    slow = send(robot, [HOME, home_plus(0.3), HOME], speed_fraction=0.5, **FAST).succeeded()
    assert slow.duration == pytest.approx(2.0 * fast.duration, rel=1e-6)


def max_target_speed(simulator, goal):
    """Returns the maximum target speed of any joint until the goal has succeeded, in rad/s."""
    recorder = TargetRecorder(simulator)
    recorder.record_until_finished(goal)
    goal.succeeded()
    return recorder.max_joint_speed()


def test_default_limits_are_slow(robot, simulator):
    goal = send(robot, [HOME, home_plus(1.2)])
    assert max_target_speed(simulator, goal) < 1.05 * 1.03
    assert goal.succeeded().duration == pytest.approx(1.2 / 1.05 + 1.05 / 1.4 + 1.4 / 100.0, abs=0.01)


def test_given_limits_may_exceed_the_default_limits(robot, simulator):
    goal = send(robot, [HOME, home_plus(1.2)], max_velocity=[1.8] * 6, max_acceleration=[5.0] * 6)
    assert goal.succeeded().duration == pytest.approx(1.2 / 1.8 + 1.8 / 5.0 + 5.0 / 100.0, abs=0.01)


@pytest.mark.parametrize("speed_fraction", [1.0, 0.3])
def test_the_approach_uses_the_default_limits(robot, simulator, speed_fraction):
    goal = send(robot, [home_plus(0.8), home_plus(0.83)], approach=True, speed_fraction=speed_fraction, max_velocity=[2.0] * 6,
                max_acceleration=[10.0] * 6)
    assert max_target_speed(simulator, goal) < 1.05 * speed_fraction * 1.05


def test_joint_limits_are_respected(robot, simulator):
    recorder = TargetRecorder(simulator)
    goal = send(robot, [HOME, home_plus(0.5)], max_velocity=[0.2] * 6, max_acceleration=[1.0] * 6, max_jerk=[10.0] * 6)
    recorder.record_until_finished(goal)
    assert goal.succeeded().duration == pytest.approx(0.5 / 0.2 + 0.2 / 1.0 + 1.0 / 10.0, abs=0.01)
    assert recorder.max_joint_speed() < 0.2 * 1.03


def test_blends_corners_within_the_tolerance(robot):
    corner = home_plus(0.4)
    states = robot.subscribe(JointState, "joint_states")
    through = send(robot, [HOME, corner, home_plus(0.4, 0.3)], lookahead_time=MIN_LOOKAHEAD).succeeded()
    send(robot, [home_plus(0.4, 0.3), HOME], lookahead_time=MIN_LOOKAHEAD).succeeded()
    robot.messages_until_now(states)
    states.clear()
    blended = send(robot, [HOME, corner, home_plus(0.4, 0.3)], blend_tolerance=0.05, lookahead_time=MIN_LOOKAHEAD).succeeded()
    assert blended.duration < 0.95 * through.duration
    assert min_deviation(robot.messages_until_now(states), corner) < 0.05 + 0.005


def test_a_distant_start_requires_approach(robot):
    distant = [home_plus(0.2), home_plus(0.3)]
    rejected = send(robot, distant)
    assert not rejected.accepted
    message = robot.rejection(rejected).message
    assert "shoulder_pan_joint" in message and "0.2000 rad away" in message and "start_tolerance is 0.0100" in message
    send(robot, distant, approach=True).succeeded()
    send(robot, [home_plus(0.3003), home_plus(0.25)]).succeeded()  # within start_tolerance
    send(robot, [HOME], approach=True).succeeded()


def test_handles_single_repeated_and_reversed_waypoints(robot):
    send(robot, [HOME]).succeeded()
    send(robot, [HOME, HOME, HOME]).succeeded()
    send(robot, [HOME, home_plus(0.1), home_plus(0.1), HOME, home_plus(1e-7), home_plus(0.1), HOME]).succeeded()


def test_planning_ten_thousand_waypoints_does_not_block_the_node(robot):
    goal = send(robot, wave(10000, 0.6), lookahead_time=MIN_LOOKAHEAD)
    assert goal.accepted
    assert not send(robot, [HOME]).accepted  # rejected as busy during planning
    result = goal.succeeded(60.0)
    assert result.duration > 1.0


@pytest.mark.parametrize("slider", [1.0, 0.3])
def test_cancel_decelerates_along_the_path(robot, simulator, slider):
    simulator.control("speed_slider", fraction=slider)
    end = home_plus(1.0, -0.4, 0.5)
    states = robot.subscribe(JointState, "joint_states")
    goal = send(robot, [HOME, end], max_velocity=[0.5] * 6, lookahead_time=MIN_LOOKAHEAD)
    wait_for_progress(goal, 0.2)
    goal.cancel()
    status, result = goal.wait_for_result(10.0)
    simulator.control("speed_slider", fraction=1.0)
    assert status == GoalStatus.STATUS_CANCELED and result.error_code == ErrorCode.CANCELED
    assert 0.0 < result.final_state.joint_positions[0] < 0.95
    assert max(distance_to_line(state.position, HOME, end) for state in robot.messages_until_now(states)) < 0.005
    wait_for(lambda: simulator.state()["at_rest"], 15.0, "standstill")


GENTLE = {"max_velocity": [0.5] * 6, "max_acceleration": [0.2] * 6, "max_jerk": [0.05] * 6}


def start_gentle_motion(robot, simulator):
    """Starts a motion of joint 0 that takes 6.3 s to brake within its limits; returns when it is fast."""
    make_ready(robot, joint_positions=[-2.8, *HOME[1:]])
    goal = send(robot, [[-2.8, *HOME[1:]], [2.8, *HOME[1:]]], **GENTLE)
    goal.wait_until(lambda: simulator.state()["target"]["velocity"][0] > 0.3, 60.0, "a fast motion")  # a busy host slows it down
    return goal


def shortest_stop(recorder, jerk):
    """Returns the time in s and the travel in rad that a stop from the first recorded state takes at least: it may still accelerate."""
    speeds = list(recorder.joint_speeds.values())
    acceleration = max(speeds[50] - speeds[0], 0.0) / 0.1
    rise, fastest = acceleration / jerk, speeds[0] + acceleration**2 / (2.0 * jerk)
    fall = 2.0 * math.sqrt(fastest / jerk)
    return rise + fall, (speeds[0] + acceleration * rise / 3.0) * rise + fastest * fall / 2.0


def test_cancel_brakes_a_gentle_motion_within_its_limits(robot, simulator):
    goal = start_gentle_motion(robot, simulator)
    recorder = TargetRecorder(simulator)
    goal.cancel()
    begin = simulator.state()
    recorder.record_until_finished(goal)
    status, result = goal.wait_for_result(30.0)
    assert status == GoalStatus.STATUS_CANCELED, result.message
    shortest, least_travel = shortest_stop(recorder, jerk=0.05)
    assert simulator.state()["timestamp"] - begin["timestamp"] < 1.15 * shortest + 0.5
    travel = result.final_state.joint_positions[0] - begin["target"]["position"][0]
    assert travel < 1.15 * least_travel + 0.25, "it goes on to its target"
    assert recorder.max_joint_speed() < 0.5 * 1.03


def test_stop_after_cancel_stops_a_gentle_motion_at_once(robot, simulator):
    goal = start_gentle_motion(robot, simulator)
    recorder = TargetRecorder(simulator)
    goal.cancel()
    robot.send(Stop, "stop").succeeded()
    at_rest = simulator.state()
    assert abs(at_rest["target"]["velocity"][0]) == 0.0
    _, result = goal.wait_for_result(15.0)
    assert result.error_code in (ErrorCode.CANCELED, ErrorCode.PREEMPTED), result.message
    deceleration = recorder.update().max_deceleration()
    assert deceleration > 0.5, f"it brakes as gently as the cancel, at most at {deceleration:.2f} rad/s²"
    cycle = at_rest["cycle"]
    wait_for(lambda: simulator.state()["cycle"] > cycle + 250, 10.0, "half a second")
    assert simulator.state()["target"]["position"] == pytest.approx(at_rest["target"]["position"], abs=1e-6), "it creeps on"


@pytest.mark.parametrize("is_canceled", [False, True], ids=["running", "canceled"])
def test_a_goal_that_preempts_a_gentle_motion_does_not_wait_for_its_end(addresses, processes, is_canceled):
    simulator = processes(Simulator(addresses[1]))
    processes(start_node("driver", simulator.address, PLUGINS, "ur_type:=ur10e", "on_busy:=preempt", namespace="preempts"))
    client = Client("preempts")
    try:
        make_ready(client)
        goal = start_gentle_motion(client, simulator)
        if is_canceled:
            goal.cancel()
        next_goal = client.send(MoveJ, "move_j", joint_positions=HOME, speed=1.0)
        next_goal.succeeded(40.0)
        assert goal.wait_for_result(10.0)[1].error_code == (ErrorCode.CANCELED if is_canceled else ErrorCode.PREEMPTED)
    finally:
        client.close()


def test_ctrl_c_after_cancel_stops_a_gentle_motion_in_time(addresses, processes):
    simulator = processes(Simulator(addresses[1]))
    driver = processes(start_node("driver", simulator.address, PLUGINS, "ur_type:=ur10e", namespace="ends"))
    client = Client("ends")
    try:
        make_ready(client)
        goal = start_gentle_motion(client, simulator)
        goal.cancel()
        recorder = TargetRecorder(simulator)
        wait_for(lambda: len(recorder.update().joint_speeds) > 50, 10.0, "the motion to go on")
        driver.interrupt()
        _, result = goal.wait_for_result(10.0)
        assert result.error_code == ErrorCode.CANCELED, result.message
        assert driver.wait(15.0) == 0, driver.output()
        assert simulator.state()["target"]["velocity"] == [0.0] * 6
    finally:
        client.close()


def test_the_speed_slider_scales_the_duration(robot, simulator):
    simulator.control("speed_slider", fraction=0.4)
    begin = simulator.state()["timestamp"]
    result = send(robot, [HOME, home_plus(0.5), HOME], lookahead_time=MIN_LOOKAHEAD, **FAST).succeeded(60.0)
    assert simulator.state()["timestamp"] - begin > result.duration / 0.4
    simulator.control("speed_slider", fraction=1.0)


def test_a_delayed_host_skips_no_part_of_the_trajectory(robot, simulator, driver):
    recorder = TargetRecorder(simulator)
    goal = send(robot, [HOME, home_plus(0.8), HOME], max_velocity=[0.5] * 6, lookahead_time=MIN_LOOKAHEAD)
    for progress in (0.1, 0.3, 0.6):
        wait_for_progress(goal, progress)
        cycle = simulator.state()["cycle"]
        driver.pause()
        wait_for(lambda cycle=cycle: simulator.state()["cycle"] > cycle + 30, 10.0, "30 cycles without the host")
        driver.resume()
        recorder.update()
    recorder.record_until_finished(goal)
    goal.succeeded()
    assert recorder.max_joint_speed() < 0.5 * 1.03


def test_aborts_and_stops_if_the_tracking_error_is_too_large(robot, simulator):
    goal = send(robot, [HOME, home_plus(1.0)], max_tracking_error=0.0005, gain=100.0, lookahead_time=0.2)
    status, result = goal.wait_for_result(20.0)
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == ErrorCode.NOT_REACHED
    assert "behind the trajectory" in result.message and "0.000" in result.message
    wait_for(lambda: simulator.state()["at_rest"], 15.0, "standstill")


def test_a_protective_stop_aborts_the_goal(robot, simulator):
    goal = send(robot, [HOME, home_plus(1.0)])
    wait_for_progress(goal, 0.1)
    simulator.control("protective_stop")
    _, result = goal.wait_for_result(10.0)
    assert result.error_code == ErrorCode.PROTECTIVE_STOP
    wait_for(simulator.unlock_protective_stop, 10.0, "the protective stop to be unlocked")
    make_ready(robot)


INVALID_PATHS = [
    ({"waypoints": []}, "waypoints is empty"),
    ({"waypoints": waypoints(HOME, HOME[:5])}, "waypoint 1 has 5 values"),
    ({"waypoints": waypoints(HOME, home_plus(NAN))}, "waypoint 1 of shoulder_pan_joint is nan"),
    ({"waypoints": waypoints(HOME, home_plus(0.0, -5.0))}, "waypoint 1: position of shoulder_lift_joint is -6.57"),
    ({"max_velocity": [1.0] * 5}, "max_velocity has 5 values"),
    ({"max_velocity": [1.0, 0.0, 1.0, 1.0, 1.0, 1.0]}, "max_velocity[1] (shoulder_lift_joint) is 0"),
    ({"max_velocity": [3.0] * 6}, "max_velocity[0] (shoulder_pan_joint) is 3 rad/s"),
    ({"max_acceleration": [-1.0] * 6}, "max_acceleration[0] (shoulder_pan_joint) is -1"),
    ({"max_acceleration": [41.0] * 6}, "at most 40"),
    ({"max_jerk": [math.inf] * 6}, "max_jerk[0]"),
    ({"max_jerk": [1.0] * 5 + [NAN]}, "max_jerk[5] (wrist_3_joint) is nan"),
    ({"speed_fraction": 0.0}, "speed_fraction is 0"),
    ({"blend_tolerance": -0.1}, "blend_tolerance is -0.1"),
    ({"start_tolerance": 0.0}, "start_tolerance is 0"),
    ({"lookahead_time": 0.01}, "lookahead_time is 0.01"),
    ({"gain": NAN}, "gain is nan"),
    ({"max_tracking_error": 0.0}, "max_tracking_error is 0"),
    ({"waypoints": waypoints(*[HOME] * 10001)}, "10001 entries"),
]


@pytest.mark.parametrize("fields, what", INVALID_PATHS, ids=[what for _, what in INVALID_PATHS])
def test_an_invalid_path_is_rejected_with_the_reason(driver, client, fields, what):
    goal = client.send(ExecuteTrajectory, "execute_trajectory", **{"waypoints": waypoints(HOME), **fields})
    assert not goal.accepted
    rejection = client.rejection(goal)
    assert rejection.error_code == ErrorCode.INVALID_GOAL and what in rejection.message, rejection.message


def arc(times, size=0.3):
    """Returns points of a motion from rest to rest, with velocities and accelerations."""
    end = times[-1]
    w = math.pi / end
    return [point(t, home_plus(0.5 * size * (1 - math.cos(w * t))), [0.5 * size * w * math.sin(w * t)] + [0.0] * 5,
                  [0.5 * size * w * w * math.cos(w * t)] + [0.0] * 5) for t in times]


def test_keeps_the_given_times(robot, simulator):
    times = [0.0, 0.4, 0.5, 1.3, 2.0]
    points = arc(times)
    points[-1].velocities = [0.0] * 6
    recorder = TargetRecorder(simulator)
    goal = send_timed(robot, timed(*points), lookahead_time=MIN_LOOKAHEAD, gain=2000.0, max_jerk=[1e5] * 6)
    recorder.record_until_finished(goal)
    assert goal.succeeded().duration == pytest.approx(2.0)
    # The planned times are 2/3, 1 and 4/3 s. A delayed host prolongs the motion.
    quarter, half, three_quarters = (recorder.cycle_at_travel(0.3 * part) for part in (0.25, 0.5, 0.75))
    for begin, end in ((quarter, half), (half, three_quarters)):
        assert end - begin > 500.0 * (1.0 / 3.0 - 0.03)
        slowed = SLOWED_SETPOINTS * len(recorder.gaps(BRIDGED_CYCLES, begin - SLOWED_SETPOINTS, end))
        assert recorder.cycles_with_setpoint(begin, end) < 500.0 * (1.0 / 3.0 + 0.03) + slowed


def test_accepts_positions_without_velocities_and_names_in_any_order(robot):
    order = (5, 3, 1, 0, 2, 4)

    def reordered(values):
        return [values[i] for i in order]

    target = home_plus(0.2, 0.1, 0.0, -0.1)
    points = [point(0.0, reordered(HOME)), point(1.0, reordered(home_plus(0.1, 0.05, 0.0, -0.05))), point(2.0, reordered(target))]
    send_timed(robot, timed(*points, names=reordered(JOINTS))).succeeded()
    result = send_timed(robot, timed(point(2.0, target), point(2.5, target), names=[])).succeeded()
    assert result.final_state.joint_positions == pytest.approx(target, abs=0.005)


def test_a_trajectory_that_exceeds_a_limit_is_aborted_before_the_arm_moves(robot, simulator):
    before = simulator.state()["target"]
    goal = send_timed(robot, timed(point(0.0, HOME), point(0.1, home_plus(0.5)), point(0.5, home_plus(0.5))))
    status, result = goal.wait_for_result(10.0)
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == ErrorCode.INVALID_GOAL
    assert " of shoulder_pan_joint is " in result.message and "its limit" in result.message
    assert simulator.state()["target"] == before


INVALID_TIMINGS = [
    (timed(point(0.0, HOME)), "trajectory.points has 1 points"),
    (timed(), "trajectory.points has 0 points"),
    (timed(point(0.0, HOME), point(0.0, HOME)), "times[1] is 0"),
    (timed(point(0.0, HOME), point(2.0, HOME), point(1.0, HOME)), "times[2] is 1"),
    (timed(point(0.0, HOME), point(1.0, HOME[:4])), "points[1].positions has 4 values"),
    (timed(point(0.0, HOME), point(1.0, home_plus(NAN))), "positions[1] of shoulder_pan_joint is nan"),
    (timed(point(0.0, HOME), point(1.0, home_plus(7.0))), "positions[1] of shoulder_pan_joint is 7"),
    (timed(point(0.0, HOME, [0.0] * 6), point(1.0, HOME)), "points[1].velocities has 0 values"),
    (timed(point(0.0, HOME, [0.0] * 6), point(1.0, HOME, [0.5] * 6)), "begins and ends at rest"),
    (timed(point(0.0, HOME), point(1.0, HOME), names=JOINTS[:5]), "joint_names has 5 names"),
    (timed(point(0.0, HOME), point(1.0, HOME), names=[*JOINTS[:5], "elbow"]), "joint_names has no wrist_3_joint"),
    (timed(point(0.0, HOME), point(1.0, HOME), names=["a_" + JOINTS[0], *["b_" + n for n in JOINTS[1:]]]), "several arms"),
]


@pytest.mark.parametrize("trajectory, what", INVALID_TIMINGS, ids=[what for _, what in INVALID_TIMINGS])
def test_an_invalid_timing_is_rejected_with_the_reason(driver, client, trajectory, what):
    goal = client.send(ExecuteParametrizedTrajectory, "execute_parametrized_trajectory", trajectory=trajectory)
    assert not goal.accepted
    rejection = client.rejection(goal)
    assert rejection.error_code == ErrorCode.INVALID_GOAL and what in rejection.message, rejection.message
