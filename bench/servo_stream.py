"""A trajectory on the simulator: when its targets arrive, by the simulator's trace, and how far the arm is behind them.

Intervals are in the robot's time: the host's, times the simulator's real-time factor.
"""

import sys
import time
from collections import Counter

import rclpy
from rclpy.action import ActionClient
from rclpy.node import Node
from stream_latency import percentile
from ur_ros_rtde_msgs.action import ExecuteTrajectory
from ur_ros_rtde_msgs.msg import JointWaypoint

SERVO_J = 11  # ur_rtde's command
INTERVAL = 2.0  # ms, of the robot
TOLERANCE = 0.2  # ms, of the robot
POLL = 0.5  # s; the trace holds the last 1024 repeated commands, two seconds of the robot


def _path(start, seconds):
    """There and back twice, that long at 0.4 rad/s."""
    there = list(start)
    there[0] += 0.4 * seconds / 4.0
    return [JointWaypoint(positions=list(positions)) for positions in (start, there, start, there, start)]


def _trace(control, node, outcome):
    """Until the goal has ended: (cycle, ns by the host's clock) of each target's arrival, and ns of each cycle by its number."""
    arrivals, cycles, last = [], {}, 0
    while not outcome.done():
        end = time.monotonic() + POLL
        while time.monotonic() < end and not outcome.done():
            rclpy.spin_once(node, timeout_sec=0.02)
        trace = control.request("trace", after=max(0, control.request("state")["state"]["cycle"] - 900))
        cycles.update((number, published) for number, published, *_ in trace["cycles"])
        new = [(cycle, when) for cycle, when, code in trace["repeats"] if code == SERVO_J and when > last]
        arrivals += new
        last = new[-1][1] if new else last
    return arrivals, cycles


def _beyond(off):
    """% of these ms."""
    return 100.0 * sum(abs(value) > TOLERANCE for value in off) / len(off)


def _intervals(moments, factor):
    """ms of the robot, from each of these ns of the host to the next."""
    return [(end - begin) * 1e-6 * factor for begin, end in zip(moments, moments[1:])]


def _off_package(arrivals, cycles, factor):
    """ms: how much longer the intervals of targets are than those of the packages that they answer."""
    known = [(when, cycles[cycle]) for cycle, when in arrivals if cycle in cycles]
    return [a - b for a, b in zip(*(_intervals(moments, factor) for moments in zip(*known)))]


def _not_once(arrivals):
    """% of the cycles that got no target, or more than one."""
    count = Counter(cycle for cycle, _ in arrivals)
    cycles = range(min(count), max(count) + 1)
    return 100.0 * sum(count[cycle] != 1 for cycle in cycles) / len(cycles)


def figures(arrivals, cycles, factor):
    """Of a stream's [(cycle, ns of arrival)] and {cycle: ns of its package}; percentages, and ms."""
    answers = [(when - cycles[number]) * 1e-6 for number, when in arrivals if number in cycles]
    off = [ms - INTERVAL for ms in _intervals([when for _, when in arrivals], factor)]
    cycles_off = [ms - INTERVAL for ms in _intervals([cycles[number] for number in sorted(cycles)], factor)]
    return {"answer p50": percentile(answers, 0.5), "answer p99.9": percentile(answers, 0.999), "count": len(answers),
            "off package": _beyond(_off_package(arrivals, cycles, factor)), "off 2 ms": _beyond(off),
            "cycles off 2 ms": _beyond(cycles_off), "not once a cycle": _not_once(arrivals)}


def servo_stream(control, seconds, factor):
    """Figures of one trajectory; None when it could not be driven."""
    node = Node("bench_stream")
    client = ActionClient(node, ExecuteTrajectory, "execute_trajectory")
    if not client.wait_for_server(timeout_sec=15.0):
        raise SystemExit("bench: the action execute_trajectory does not appear")
    start = list(control.request("state")["state"]["target"]["position"])
    goal = ExecuteTrajectory.Goal(waypoints=_path(start, seconds), max_velocity=[0.4] * 6, max_acceleration=[5.0] * 6,
                                  lookahead_time=0.03, gain=2000.0)
    sending = client.send_goal_async(goal)
    rclpy.spin_until_future_complete(node, sending, timeout_sec=10.0)
    if not sending.done() or not sending.result().accepted:
        raise SystemExit("bench: the trajectory was refused; see the topic goal_refusals")
    outcome = sending.result().get_result_async()
    arrivals, cycles = _trace(control, node, outcome)
    result = outcome.result().result
    node.destroy_node()
    if not result.success or len(arrivals) < 10:
        print(f"bench: the trajectory says: {result.message}", file=sys.stderr)
        return None
    return {**figures(arrivals, cycles, factor), "tracking error": result.max_tracking_error}
