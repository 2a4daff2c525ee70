"""A trajectory on the simulator: when its targets arrive, by the simulator's trace, and how far the arm is behind them."""

import time

import rclpy
from rclpy.action import ActionClient
from stream_latency import percentile
from ur_ros_rtde_msgs.action import ExecuteTrajectory
from ur_ros_rtde_msgs.msg import JointWaypoint

SERVO_J = 11  # ur_rtde's command
SECONDS = 10.0
POLL = 0.5  # s; the trace holds the last 1024 repeated commands, two seconds


def _path(start):
    """There and back, long enough for SECONDS at 0.4 rad/s."""
    there = list(start)
    there[0] += 0.4 * SECONDS / 4.0
    return [JointWaypoint(positions=list(positions)) for positions in (start, there, start, there, start)]


def _arrivals(control, node, outcome):
    """ns by the host's clock, of each target until the goal has ended."""
    arrivals, last = [], 0
    while not outcome.done():
        end = time.monotonic() + POLL
        while time.monotonic() < end and not outcome.done():
            rclpy.spin_once(node, timeout_sec=0.02)
        commands = control.request("trace", after=max(0, control.request("state")["state"]["cycle"] - 900))["repeats"]
        new = [when for _, when, code in commands if code == SERVO_J and when > last]
        arrivals += new
        last = new[-1] if new else last
    return arrivals


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
    arrivals = _arrivals(control, node, outcome)
    result = outcome.result().result
    off = [abs((b - a) * 1e-6 - 2.0) for a, b in zip(arrivals, arrivals[1:])]
    if not result.success or not off:
        return None
    return {"p50 off": percentile(off, 0.5), "p99.9 off": percentile(off, 0.999),
            "within 0.2 ms": 100.0 * sum(value <= 0.2 for value in off) / len(off), "count": len(off),
            "tracking error": result.max_tracking_error}
