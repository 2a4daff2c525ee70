"""Latency from a goal to its first RTDE command, from a cancel request to the start of the deceleration, and from the end of a
motion to its result.

The goal is sent by a client in Python or in C++; the effect is taken from the simulator's trace.
"""

import random
import subprocess
import time

import rclpy
from rclpy.action import ActionClient
from rclpy.node import Node

from ur_ros_rtde_msgs.action import MoveJ, SetPayload

# Between two goals, so that the control program waits for a command again, at any phase of its cycle of 2 ms.
PAUSE, SPREAD = 0.020, 0.002  # s
CPP_GOALS = 40  # the simulator keeps 256 commands, and each goal has several


def first_commands(sent, commands):
    """Returns [(time of sending a goal, time of the arrival of its command)] in ns, from the arrivals of all commands."""
    ends = [*sent[1:], float("inf")]
    found = ((begin, next((when for when in commands if begin < when < end), None)) for begin, end in zip(sent, ends))
    return [(begin, when) for begin, when in found if when is not None]


def milliseconds(goals):
    return [(arrived - sent) * 1e-6 for sent, arrived in goals]


class GoalLatency:
    def __init__(self, control):
        self.control = control
        self.node = Node("bench_commands")
        self.move_j = ActionClient(self.node, MoveJ, "move_j")
        self.set_payload = ActionClient(self.node, SetPayload, "set_payload")
        for client in (self.move_j, self.set_payload):
            if not client.wait_for_server(timeout_sec=15.0):
                raise SystemExit("bench: the actions of the command server were not found")

    def close(self):
        self.node.destroy_node()

    def _finish(self, future, limit=30.0):
        rclpy.spin_until_future_complete(self.node, future, timeout_sec=limit)
        if not future.done():
            raise SystemExit(f"bench: no response within {limit:g} s")
        return future.result()

    def _accepted(self, client, goal):
        handle = self._finish(client.send_goal_async(goal))
        if not handle.accepted:
            raise SystemExit("bench: a goal was rejected; see the topic goal_rejections")
        return handle

    def _cycle(self):
        return self.control.request("state")["state"]["cycle"]

    def from_python(self, count):
        """Returns [(time of sending a goal, time of the arrival of its command at the controller)] in ns."""
        result = []
        for index in range(count):
            goal = SetPayload.Goal(mass=0.5 + 0.01 * (index % 10))
            before = self._cycle()
            sent = time.time_ns()
            handle = self._accepted(self.set_payload, goal)
            self._finish(handle.get_result_async())
            result += first_commands([sent], self._commands(before))
            time.sleep(PAUSE + random.uniform(0.0, SPREAD))
        return result

    def from_cpp(self, program, count):
        """The same with the client `program`, in parts whose commands the simulator's trace can hold."""
        result = []
        for begin in range(0, count, CPP_GOALS):
            before = self._cycle()
            command = [program, str(min(CPP_GOALS, count - begin))]
            output = subprocess.run(command, check=True, capture_output=True, text=True, timeout=60).stdout
            result += first_commands([int(line) for line in output.split()], self._commands(before))
        return result

    def _commands(self, after):
        return [when for _, when, _ in self.control.request("trace", after=after)["commands"]]

    def cancel_to_deceleration(self, count):
        """Returns the times in ms from sending a cancel request to the first cycle with a lower target speed."""
        result = []
        for index in range(count):
            joints = list(self.control.request("state")["state"]["actual"]["position"])
            joints[0] += 1.0 if index % 2 == 0 else -1.0
            handle = self._accepted(self.move_j, MoveJ.Goal(joint_positions=joints, speed=0.4, acceleration=4.0))
            outcome = handle.get_result_async()
            self._wait_for_speed(0.399)
            before = self._cycle()
            sent = time.time_ns()
            self._finish(handle.cancel_goal_async())
            self._finish(outcome)
            cycles = self.control.request("trace", after=before)["cycles"]
            slower = [when for _, when, speed, *_ in cycles if when > sent and speed < 0.398]
            if slower:
                result.append((slower[0] - sent) * 1e-6)
        return result

    def end_to_result(self, count):
        """Returns the times in ms from the last cycle in which the target moves to the result of a motion."""
        result = []
        for index in range(count):
            joints = list(self.control.request("state")["state"]["actual"]["position"])
            joints[0] += 0.05 if index % 2 == 0 else -0.05
            before = self._cycle()
            handle = self._accepted(self.move_j, MoveJ.Goal(joint_positions=joints, speed=0.5, acceleration=1.4))
            self._finish(handle.get_result_async())
            received = time.time_ns()
            cycles = self.control.request("trace", after=before)["cycles"]
            moving = [when for _, when, speed, *_ in cycles if speed > 1e-6]
            result.append((received - moving[-1]) * 1e-6)
        return result

    def _wait_for_speed(self, speed, limit=5.0):
        deadline = time.monotonic() + limit
        while max(map(abs, self.control.request("state")["state"]["target"]["velocity"])) < speed:
            if time.monotonic() > deadline:
                raise SystemExit("bench: the arm did not reach its speed")
            rclpy.spin_once(self.node, timeout_sec=0.005)
