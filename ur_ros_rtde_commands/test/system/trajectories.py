"""Shared by the trajectory tests: waypoints, trajectories and the target that the simulator receives."""

import math

from arm_state import home_plus
from support import JOINTS, wait_for
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


class TargetRecorder:
    """Records the targets of the simulated arm, and the cycles in which setpoints arrive, from construction on.

    Call update() until the end, for example in wait_for(). It fails if the simulator's trace has lost a cycle since the last
    call (32 s), so the record is complete.
    """

    def __init__(self, simulator):
        self._simulator = simulator
        self._first_cycle = self._last_cycle = simulator.state()["cycle"]
        self._setpoint_cycles = set()
        self.held = set()  # cycles in which a setpoint arrived that is the one before
        self.joint_speeds = {}  # of the fastest target joint in rad/s, by cycle
        self.tcp_speeds = {}  # m/s, by cycle
        self.published = {}  # time in ns since the epoch at which the simulator sent the state, by cycle

    def update(self):
        """Returns itself, so that a condition can continue with the record."""
        trace = self._simulator.control("trace", after=self._last_cycle)
        cycles = [cycle for cycle, *_ in trace["cycles"]]
        assert cycles == list(range(self._last_cycle + 1, self._last_cycle + 1 + len(cycles))), "the trace has gaps"
        for cycle, published, joint_speed, tcp_speed in trace["cycles"]:
            self.published[cycle] = published
            self.joint_speeds[cycle] = joint_speed
            self.tcp_speeds[cycle] = tcp_speed
        self._setpoint_cycles.update(cycle for cycle, *_ in trace["repeats"] if cycle > self._first_cycle)
        self.held.update(cycle for cycle, _arrived, _code, is_held in trace["repeats"] if is_held)
        self._last_cycle += len(cycles)
        return self

    def record_until_finished(self, goal, limit=60.0):
        """Records until the goal has its result."""
        wait_for(lambda: self.update() and goal.is_finished(), limit, "the end")
        self.update()

    def duration(self):
        """Returns the duration of the record in s of the robot."""
        return 0.002 * (self._last_cycle - self._first_cycle)

    def max_joint_speed(self):
        return max(self.joint_speeds.values())

    def max_deceleration(self, cycles=25):
        """Returns the largest mean deceleration of the fastest joint during this number of cycles in rad/s²."""
        speeds = list(self.joint_speeds.values())
        return max(earlier - later for earlier, later in zip(speeds, speeds[cycles:])) * 500.0 / cycles

    def max_tcp_speed(self):
        return max(self.tcp_speeds.values())

    def cycles_with_setpoint(self, first=0, last=math.inf):
        """Returns the number of cycles in which a setpoint arrived, except the first of a goal. The target cannot need more of
        them on a slow host, because each advances it by at least one cycle."""
        return sum(first <= cycle <= last for cycle in self._setpoint_cycles)

    def gaps(self, longer_than, first=0, last=math.inf):
        """Returns the lengths of the gaps between setpoints that are longer than this number of cycles."""
        cycles = sorted(cycle for cycle in self._setpoint_cycles if first <= cycle <= last)
        return [later - earlier for earlier, later in zip(cycles, cycles[1:]) if later - earlier > longer_than]

    def has_gap(self, longer_than, first, last):
        """Returns whether a gap between setpoints that is longer than this number of cycles reaches into a range of cycles."""
        cycles = sorted(self._setpoint_cycles)
        return any(later - earlier > longer_than and earlier < last and later > first for earlier, later in zip(cycles, cycles[1:]))

    def cycle_at_travel(self, distance):
        """Returns the cycle in which the target of the fastest joint has traveled this distance in rad."""
        traveled = 0.0
        for cycle, speed in self.joint_speeds.items():
            traveled += speed / 500.0
            if traveled >= distance:
                return cycle
        raise AssertionError(f"the target traveled {traveled:.4f} rad, less than {distance} rad")

    def cycles_from_first_to_last_setpoint(self):
        """The target cannot need fewer of them on a slow host, which only prolongs the motion."""
        return max(self._setpoint_cycles) - min(self._setpoint_cycles) + 1

    def moving_cycles_with_setpoint(self, joint_speed):
        """Returns the number of cycles in which a setpoint arrived and the target of a joint was faster (rad/s)."""
        return sum(self.joint_speeds[cycle] > joint_speed for cycle in self._setpoint_cycles if cycle in self.joint_speeds)
