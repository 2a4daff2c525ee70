"""Measures when the targets of a trajectory arrive at the simulator, and the tracking error of the arm.

Intervals are in the robot's time: the host's time multiplied by the simulator's real-time factor.
"""

import sys
import time
from collections import Counter

import rclpy
from latency import percentile
from rclpy.action import ActionClient
from rclpy.node import Node

from ur_ros_rtde_msgs.action import ExecuteTrajectory
from ur_ros_rtde_msgs.msg import JointWaypoint

SERVO_J = 11  # command number of ur_rtde
INTERVAL = 2.0  # ms, in the robot's time
TOLERANCE = 0.2  # ms, in the robot's time
POLL = 0.5  # s


def _path(start, seconds):
    """Returns waypoints of two round trips of the base joint that take this time at 0.4 rad/s."""
    target = list(start)
    target[0] += 0.4 * seconds / 4.0
    return [JointWaypoint(positions=list(positions)) for positions in (start, target, start, target, start)]


def _trace(control, node, outcome):
    """Waits for the result. Returns (cycle, host time in ns) of the arrival of each target, and the host time in ns of each cycle."""
    arrivals = []
    cycles: dict[int, int] = {}
    last = control.request("state")["state"]["cycle"]
    while not outcome.done():
        end = time.monotonic() + POLL
        while time.monotonic() < end and not outcome.done():
            rclpy.spin_once(node, timeout_sec=0.02)
        trace = control.request("trace", after=last)
        cycles.update((number, published) for number, published, *_ in trace["cycles"])
        last = max(cycles, default=last)
        # The newest cycle is requested again: more targets may arrive in it.
        arrivals += [(cycle, when) for cycle, when, code, _is_held in trace["repeats"] if code == SERVO_J and cycle < last]
    return arrivals, cycles


def _beyond_tolerance(deviations):
    """Returns the percentage of deviations (ms) beyond the tolerance."""
    return 100.0 * sum(abs(value) > TOLERANCE for value in deviations) / len(deviations)


def _intervals(moments, factor):
    """Returns the intervals in ms of the robot's time between moments in ns of the host's time."""
    return [(end - begin) * 1e-6 * factor for begin, end in zip(moments, moments[1:])]


def _deviations_from_packages(arrivals, cycles, factor):
    """Returns how much longer the intervals of targets are than those of the packages that they answer, ms."""
    known = [(when, cycles[cycle]) for cycle, when in arrivals if cycle in cycles]
    return [a - b for a, b in zip(*(_intervals(moments, factor) for moments in zip(*known)))]


def _cycles_without_single_target(arrivals):
    """Returns the percentage of cycles that received no target, or several."""
    count = Counter(cycle for cycle, _ in arrivals)
    cycles = range(min(count), max(count) + 1)
    return 100.0 * sum(count[cycle] != 1 for cycle in cycles) / len(cycles)


def _answers(arrivals, cycles):
    """Returns [(time of arrival in s, ms since the package), ...] of the targets. Times begin at 0."""
    begin = arrivals[0][1]
    return [(round((when - begin) * 1e-9, 6), round((when - cycles[number]) * 1e-6, 4))
            for number, when in arrivals if number in cycles]


def figures(arrivals, cycles, factor):
    """Returns the figures of a stream, in % and ms, from [(cycle, ns of arrival)] and {cycle: ns of its package}."""
    answers = [(when - cycles[number]) * 1e-6 for number, when in arrivals if number in cycles]
    deviations = [ms - INTERVAL for ms in _intervals([when for _, when in arrivals], factor)]
    cycle_deviations = [ms - INTERVAL for ms in _intervals([cycles[number] for number in sorted(cycles)], factor)]
    return {"answer p50": percentile(answers, 0.5), "answer p99.9": percentile(answers, 0.999), "count": len(answers),
            "off package": _beyond_tolerance(_deviations_from_packages(arrivals, cycles, factor)),
            "off 2 ms": _beyond_tolerance(deviations),
            "cycles off 2 ms": _beyond_tolerance(cycle_deviations), "not once a cycle": _cycles_without_single_target(arrivals)}


def servo_stream(control, seconds, factor):
    """Executes a trajectory. Returns its figures, None if it fails, and [(s, ms from the package to its target), ...]."""
    node = Node("bench_stream")
    client = ActionClient(node, ExecuteTrajectory, "execute_trajectory")
    if not client.wait_for_server(timeout_sec=15.0):
        raise SystemExit("bench: the action execute_trajectory was not found")
    start = list(control.request("state")["state"]["target"]["position"])
    goal = ExecuteTrajectory.Goal(waypoints=_path(start, seconds), max_velocity=[0.4] * 6, max_acceleration=[5.0] * 6,
                                  lookahead_time=0.03, gain=2000.0)
    sending = client.send_goal_async(goal)
    rclpy.spin_until_future_complete(node, sending, timeout_sec=10.0)
    if not sending.done() or not sending.result().accepted:
        raise SystemExit("bench: the trajectory was rejected; see the topic goal_rejections")
    outcome = sending.result().get_result_async()
    arrivals, cycles = _trace(control, node, outcome)
    result = outcome.result().result
    node.destroy_node()
    if not result.success or len(arrivals) < 10:
        print(f"bench: the trajectory failed: {result.message}", file=sys.stderr)
        return None, []
    return {**figures(arrivals, cycles, factor), "tracking error": result.max_tracking_error}, _answers(arrivals, cycles)
