"""The arm follows a trajectory without delay, overshoot or a higher speed, with the default lookahead time and gain."""

import pytest
from arm_state import home_plus
from robot_fixtures import make_ready
from sensor_msgs.msg import JointState
from support import HOME
from trajectories import TargetRecorder, waypoints

from ur_ros_rtde_msgs.action import ExecuteTrajectory

PLUGINS = "plugins:=[move_j,stop,execute_trajectory]"
DISTANCE = 1.2  # rad
SPEED = 1.0  # rad/s
ACCELERATION = 4.0  # rad/s^2
JERK = 100.0  # rad/s^3
MAX_DELAY_ERROR = 0.03  # rad
BRIDGED_CYCLES = 4  # without a setpoint
SLOWED_CYCLES = 250  # after a longer gap, in which the driver slows the trajectory down, at most
ACTUAL_CYCLES = 50  # by which the actual position follows the target, at most


def is_regular(recorder, position):
    """Returns whether the host was on time when the base joint was at this position, and in the cycles before."""
    cycle = recorder.cycle_at_travel(position - HOME[0])
    return not recorder.has_gap(BRIDGED_CYCLES, cycle - SLOWED_CYCLES, cycle + ACTUAL_CYCLES)


def planned_position(duration, time):
    """Returns the planned position of the base joint. The plan is symmetric, so the middle is passed at half of its duration."""
    return HOME[0] + 0.5 * DISTANCE + SPEED * (time - 0.5 * duration)


def measure_errors(robot, simulator, parameters):
    """Moves along the trajectory. Returns the distance between planned and actual position by planned time, at SPEED, where the host was on
    time."""
    states = robot.subscribe(JointState, "joint_states")
    recorder = TargetRecorder(simulator)
    goal = robot.send(ExecuteTrajectory, "execute_trajectory", waypoints=waypoints(HOME, home_plus(DISTANCE)),
                      max_velocity=[SPEED] * 6, max_acceleration=[ACCELERATION] * 6, max_jerk=[JERK] * 6, **parameters)
    recorder.record_until_finished(goal)
    result = goal.succeeded()
    errors = {}
    for feedback in goal.feedback:
        time = result.duration - feedback.time_left
        position = feedback.motion.state.joint_positions[0]
        at_speed = SPEED / ACCELERATION + ACCELERATION / JERK
        if at_speed < time < result.duration - at_speed and is_regular(recorder, position):
            errors[time] = planned_position(result.duration, time) - position
    # After a gap that the control program does not bridge, the arm may overshoot.
    overshoot = 0.03 if recorder.gaps(BRIDGED_CYCLES) else 0.002
    assert max(state.position[0] for state in robot.messages_until_now(states)) < HOME[0] + DISTANCE + overshoot
    assert recorder.max_joint_speed() < 1.03 * SPEED
    return errors


@pytest.mark.parametrize("parameters", [{}, {"lookahead_time": 0.03, "gain": 2000.0}, {"lookahead_time": 0.2, "gain": 200.0}],
                         ids=["default", "close", "smooth"])
def test_follows_the_plan(robot, simulator, parameters):
    errors = {}
    for _ in range(8):
        errors.update(measure_errors(robot, simulator, parameters))
        if len(errors) > 5:
            break
        robot.destroy_subscriptions()
        make_ready(robot)
    assert len(errors) > 5, "the host delayed the setpoints nearly all the time"
    assert max(map(abs, errors.values())) < MAX_DELAY_ERROR, errors
