"""A trajectory on the simulator: when its targets arrive, by the simulator's trace, and how far the arm is behind them."""

import time

import rclpy
from rclpy.action import ActionClient
from stream_latency import percentile
from ur_ros_rtde_msgs.action import ExecuteTrajectory
from ur_ros_rtde_msgs.msg import JointWaypoint

SERVO_J = 11  # ur_rtde's command
SECONDS = 10.0
INTERVAL = 2.0  # ms
POLL = 0.5  # s; the trace holds the last 1024 repeated commands, two seconds


def _path(start):
    """There and back, long enough for SECONDS at 0.4 rad/s."""
    there = list(start)
    there[0] += 0.4 * SECONDS / 4.0
    return [JointWaypoint(positions=list(positions)) for positions in (start, there, start, there, start)]


def _trace(control, node, outcome):
    """ns by the host's clock, until the goal has ended: of each target's arrival, and of each cycle by its number."""
    arrivals, cycles, last = [], {}, 0
    while not outcome.done():
        end = time.monotonic() + POLL
        while time.monotonic() < end and not outcome.done():
            rclpy.spin_once(node, timeout_sec=0.02)
        trace = control.request("trace", after=max(0, control.request("state")["state"]["cycle"] - 900))
        cycles.update((number, published) for number, published, *_ in trace["cycles"])
        new = [when for _, when, code in trace["repeats"] if code == SERVO_J and when > last]
        arrivals += new
        last = new[-1] if new else last
    return arrivals, cycles


def _off(begin, end):
    """ms."""
    return abs((end - begin) * 1e-6 - INTERVAL)


def _outside(off):
    return 100.0 * sum(value > 0.2 for value in off) / len(off)


def servo_stream(control, node):
    """Figures of one trajectory; None when it could not be driven."""
    client = ActionClient(node, ExecuteTrajectory, "execute_trajectory")
    if not client.wait_for_server(timeout_sec=15.0):
        raise SystemExit("bench: the action execute_trajectory does not appear")
    start = list(control.request("state")["state"]["target"]["position"])
    goal = ExecuteTrajectory.Goal(waypoints=_path(start), max_velocity=[0.4] * 6, lookahead_time=0.03, gain=2000.0)
    sending = client.send_goal_async(goal)
    rclpy.spin_until_future_complete(node, sending, timeout_sec=10.0)
    if not sending.done() or not sending.result().accepted:
        raise SystemExit("bench: the trajectory was refused; see the topic goal_refusals")
    outcome = sending.result().get_result_async()
    arrivals, cycles = _trace(control, node, outcome)
    result = outcome.result().result
    off = [_off(a, b) for a, b in zip(arrivals, arrivals[1:])]
    own = [_off(cycles[number], cycles[number + 1]) for number in cycles if number + 1 in cycles]
    if not result.success or not off or not own:
        return None
    return {"p50 off": percentile(off, 0.5), "p99.9 off": percentile(off, 0.999),
            "outside 0.2 ms": _outside(off), "count": len(off), "cycles outside": _outside(own),
            "tracking error": result.max_tracking_error}
