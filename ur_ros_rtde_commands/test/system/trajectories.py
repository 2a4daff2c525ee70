"""Shared by the trajectory tests: waypoints, trajectories and the target that the simulator receives."""

import math

from arm_state import home_plus
from support import JOINTS
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from ur_ros_rtde_msgs.msg import JointWaypoint


def waypoints(*positions):
    return [JointWaypoint(positions=list(values)) for values in positions]


def wave(count, size=0.3):
    """Returns samples of a smooth closed curve that begins at home."""
    angles = [2.0 * math.pi * i / (count - 1) for i in range(count)]
    return [home_plus(size * (1.0 - math.cos(a)), 0.5 * size * math.sin(a), -0.4 * size * math.sin(2.0 * a)) for a in angles]


def point(time, positions, velocities=(), accelerations=()):
    result = JointTrajectoryPoint(positions=list(positions), velocities=list(velocities), accelerations=list(accelerations))
    result.time_from_start.sec = int(time)
    result.time_from_start.nanosec = round(1e9 * (time - int(time)))
    return result


def timed(*points, names=JOINTS):
    return JointTrajectory(joint_names=list(names), points=list(points))


def distance_to_line(position, start, end):
    """Returns the distance of the joint that deviates most from the line, in joint space."""
    along = [b - a for a, b in zip(start, end)]
    part = sum((p - a) * d for p, a, d in zip(position, start, along)) / sum(d * d for d in along)
    return max(abs(p - a - part * d) for p, a, d in zip(position, start, along))


def cycles_without_target(simulator, after):
    """Returns the number of controller cycles without a new target, between the first and the last target after cycle `after`.

    The simulator's trace covers the last 2 s."""
    targets = {cycle for cycle, _, _ in simulator.control("trace", after=after)["repeats"]}
    return max(targets) - min(targets) + 1 - len(targets)


class TargetSpeedRecorder:
    """Records the target speeds of the simulator, from construction on.

    Call update() at least every 2 s, for example in wait_for(): the simulator's trace covers the last 2 s.
    """

    def __init__(self, simulator):
        self._simulator = simulator
        self._last_cycle = 0
        self._new_speeds()  # discards the past
        self._speeds = []

    def update(self):
        """Returns the speed of the fastest target joint in rad/s, of each cycle so far."""
        self._speeds += self._new_speeds()
        return self._speeds

    def _new_speeds(self):
        cycles = self._simulator.control("trace", after=self._last_cycle)["cycles"]
        if cycles:
            self._last_cycle = cycles[-1][0]
        return [speed for _, _, speed in cycles]
