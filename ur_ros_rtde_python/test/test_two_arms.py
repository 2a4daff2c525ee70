"""Goals of two arms, each with a driver of its own, that belong together."""

import contextlib
import time

import numpy as np
import pytest
from programs import Simulator, start_node
from stops.stalls import Stalls
from support import HOME, TIMEOUT_FACTOR, wait_for
from ur_ros_rtde import CommandFailed, NoDriver, Rejected, Robot, Timeout, trajectory, wait_for_all

PLUGINS = "plugins:=[move_j,stop,follow_joint_trajectory,trigger_protective_stop,make_ready]"
AWAY = [1.0, *HOME[1:]]
SLOW = 0.2  # rad/s: takes 5 s to AWAY
SLOWER = 0.02  # takes 50 s: a driver counts as lost some seconds after its last message
CYCLE = 0.002  # s


class Arm:
    """A simulated robot with its driver and its Robot."""

    def __init__(self, address, namespace, resources):
        self.simulator = Simulator(address)
        resources.callback(self.simulator.stop)
        self.driver = start_node("driver", address, "ur_type:=ur10e", PLUGINS, namespace=namespace)
        resources.callback(self.driver.stop)
        self.robot = resources.enter_context(Robot(namespace, timeout=TIMEOUT_FACTOR * 20.0))

    def move_home(self):
        assert self.robot.state.wait_until(lambda state: state.driver_state == "READY", TIMEOUT_FACTOR * 30.0), self.driver.output()
        self.robot.move_j(HOME, speed=3.0, acceleration=15.0)

    def is_stopped_early(self):
        return self.simulator.is_at_rest() and self.robot.state.joint_positions[0] < 0.9

    def start_time(self, after):
        """Returns when the first cycle in which the target moves was published, s since the epoch; None if it does not move."""
        cycles = self.simulator.control("trace", after=after)["cycles"]
        return next((1e-9 * published for _cycle, published, joint_speed, _tcp_speed in cycles if joint_speed > 1e-4), None)


@pytest.fixture(scope="module")
def both(addresses):
    with contextlib.ExitStack() as resources:
        yield [Arm(address, namespace, resources) for address, namespace in zip(addresses[1:3], ("left", "right"), strict=True)]


@pytest.fixture
def arms(both):
    for arm in both:
        arm.move_home()
    return both


def test_the_results_come_in_the_order_of_the_goals(arms):
    first, second = (arm.robot.start.move_j(AWAY, speed) for arm, speed in zip(arms, (1.0, 3.0), strict=True))
    assert [result.success for result in wait_for_all(first, second, timeout=TIMEOUT_FACTOR * 20.0)] == [True, True]


def test_a_failure_of_one_arm_stops_the_other(arms):
    goals = [arm.robot.start.move_j(AWAY, SLOW) for arm in arms]
    arms[1].robot.trigger_protective_stop()
    with pytest.raises(CommandFailed, match="the robot is in a protective stop"):
        wait_for_all(*goals)
    assert all(arm.is_stopped_early() for arm in arms) and all(goal.is_finished for goal in goals)
    arms[1].robot.make_ready()


def test_a_rejection_stops_the_arm_that_has_started(arms):
    with pytest.raises(Rejected, match="speed"), arms[0].robot.start.move_j(AWAY, SLOW), arms[1].robot.start.move_j(AWAY, 9.0):
        pytest.fail("the block was executed")
    assert arms[0].is_stopped_early()


def test_the_timeout_stops_both_arms(arms):
    goals = [arm.robot.start.move_j(AWAY, SLOW) for arm in arms]
    with pytest.raises(Timeout, match="not ended within 0.5 s: move_j, move_j"):
        wait_for_all(*goals, timeout=0.5)
    assert all(arm.is_stopped_early() for arm in arms)


def test_both_arms_start_at_the_same_time(arms):
    times = np.linspace(0.0, 2.0, 21)
    swing = 0.1 * (1.0 - np.cos(np.pi * times))
    paths = [{"positions": arm.robot.state.joint_positions + np.outer(swing, [sign, 0, 0, 0, 0, 0]),
              "joint_names": arm.robot.state.joint_names} for arm, sign in zip(arms, (1, -1), strict=True)]
    cycles = [arm.simulator.state()["cycle"] for arm in arms]
    start_at = time.time() + 2.0 * TIMEOUT_FACTOR
    plans = [trajectory(times, **path, start_at=start_at) for path in paths]

    def start_times():
        found = [arm.start_time(cycle) for arm, cycle in zip(arms, cycles, strict=True)]
        return found if None not in found else None

    with contextlib.closing(Stalls([process.pid for arm in arms for process in (arm.driver, arm.simulator.process)])) as stalls:
        goals = [arm.robot.start.follow_joint_trajectory(plan) for arm, plan in zip(arms, plans, strict=True)]
        wait_for(lambda: time.time() > start_at, 20.0, "the time of the start")
        late = [start - start_at for start in wait_for(start_times, 20.0, "both arms to move")]
    stall = stalls.between(0, time.time_ns())  # for which the host did not let drivers and simulators run
    wait_for_all(*goals)
    assert min(late) > -CYCLE and max(late) < 0.1 * TIMEOUT_FACTOR + stall, (late, stall)


def test_a_lost_driver_stops_the_other_arm(arms, addresses):
    with contextlib.ExitStack() as resources:
        lost = Arm(addresses[3], "lost", resources)
        lost.move_home()
        goals = [arm.robot.start.move_j(AWAY, SLOWER) for arm in (lost, arms[0])]
        lost.driver.kill()
        with pytest.raises(NoDriver, match="while move_j was running"):
            wait_for_all(*goals)
        assert arms[0].is_stopped_early()
        wait_for(lost.simulator.is_at_rest, 10.0, "the watchdog to stop the arm")
