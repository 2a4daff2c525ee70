"""What the tests of trajectories share: waypoints, and what the simulator's target did."""

import math

from arm_state import home_plus
from support import JOINTS
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from ur_ros_rtde_msgs.msg import JointWaypoint


def waypoints(*positions):
    return [JointWaypoint(positions=list(values)) for values in positions]


def wave(count, size=0.3):
    """Samples of a smooth closed curve that begins at home."""
    angles = [2.0 * math.pi * i / (count - 1) for i in range(count)]
    return [home_plus(size * (1.0 - math.cos(a)), 0.5 * size * math.sin(a), -0.4 * size * math.sin(2.0 * a)) for a in angles]


def point(time, positions, velocities=(), accelerations=()):
    result = JointTrajectoryPoint(positions=list(positions), velocities=list(velocities), accelerations=list(accelerations))
    result.time_from_start.sec = int(time)
    result.time_from_start.nanosec = round(1e9 * (time - int(time)))
    return result


def timed(*points, names=JOINTS):
    return JointTrajectory(joint_names=list(names), points=list(points))


def distance_to_line(point_, start, end):
    """In joint space, of the joint that is farthest off."""
    along = [b - a for a, b in zip(start, end)]
    part = sum((p - a) * d for p, a, d in zip(point_, start, along)) / sum(d * d for d in along)
    return max(abs(p - a - part * d) for p, a, d in zip(point_, start, along))


def cycles_without_target(simulator, after):
    """Of the controller, from its cycle `after` on, between the first target of a stream and the last: it remembers two seconds."""
    targets = {cycle for cycle, _, _ in simulator.control("trace", after=after)["repeats"]}
    return max(targets) - min(targets) + 1 - len(targets)


class TargetSpeedRecorder:
    """Follows the simulator's target in the background of a test: called in a wait_for."""

    def __init__(self, simulator):
        self._simulator = simulator
        self._last = 0
        self.speeds = []

    def update(self):
        """The fastest target joint of each cycle since the last look."""
        cycles = self._simulator.control("trace", after=self._last)["cycles"]
        if cycles:
            self._last = cycles[-1][0]
        self.speeds += [speed for _, _, speed in cycles]
        return self.speeds
