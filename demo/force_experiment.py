"""Force experiment: the arm moves down, ignores two lateral pushes and stops on contact.

Requires a running simulator and the nodes (`./ur demo` starts both). Writes a CSV file and a figure.
"""

import argparse
import math
import signal
import sys
import time
from pathlib import Path
from typing import Any

import rclpy
from control_port import ControlPort
from force_figure import VELOCITIES, draw, force_column
from rclpy.action import ActionClient
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from recorder import Recorder, mark_events, write_csv
from ur_ros_rtde_tutorials.action import MoveDownUntilForce

from ur_ros_rtde_msgs.msg import ErrorCode, GoalRejected

DISCOVERY_TIMEOUT = 20.0  # s
READY_TIMEOUT = 15.0  # s, from the first rejection until the robot is ready
TRANSIENT_LOCAL = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
CONNECTING = (ErrorCode.NOT_READY, ErrorCode.LINK_LOST)  # the driver may still be connecting
STANDSTILL = 0.002  # rad/s
BAR = 12  # characters: the line fits on a terminal of 80 columns
NEW_LINE = "\n" if sys.stdout.isatty() else ""  # after the progress line, which is shown on a terminal only
RECORDING_AFTER_STANDSTILL = 0.8  # s, recorded after standstill


class Experiment:
    def __init__(self, node, control, options):
        self.node, self.control, self.options = node, control, options
        self.recorder = Recorder(node)
        self.client = ActionClient(node, MoveDownUntilForce, "move_down_until_force")
        node.create_subscription(GoalRejected, "goal_rejections", self.on_rejection, TRANSIENT_LOCAL)
        self.rejections = {}
        self.goal_handle: Any = None
        self.result: Any = None
        self.pushes = []

    def wait(self, condition, limit, what):
        """Spins the node until the condition holds."""
        deadline = time.monotonic() + limit
        while not condition():
            if time.monotonic() > deadline:
                raise SystemExit(f"timeout after {limit:g} s waiting for {what}: see the logs of the nodes")
            rclpy.spin_once(self.node, timeout_sec=0.02)

    def prepare(self):
        self.wait(self.client.server_is_ready, DISCOVERY_TIMEOUT, "the action move_down_until_force")
        self.wait(self.recorder.complete, DISCOVERY_TIMEOUT, "joint_states, wrench and tcp_pose")
        self.start_height = self.recorder.height
        table = self.start_height - self.options.drop
        self.control.request("clear_surfaces")
        self.control.request("place_surface", point=[0.0, 0.0, table], normal=[0.0, 0.0, 1.0], stiffness=15000.0, damping=80.0)
        print(f"table placed {self.options.drop:.2f} m below the tool (z = {table:.3f} m)")

    def send_goal(self):
        goal = MoveDownUntilForce.Goal(
            force=self.options.threshold, distance=min(1.0, self.options.drop + 0.1), speed=self.options.speed
        )
        print(f"goal: down {goal.distance:.2f} m at {goal.speed:g} m/s until {goal.force:g} N along the flange Z axis")
        deadline = time.monotonic() + READY_TIMEOUT
        while not self.accepted(goal):
            rejection = self.rejections.get(bytes(self.goal_handle.goal_id.uuid))
            if rejection is None or rejection.error_code not in CONNECTING or time.monotonic() > deadline:
                raise SystemExit(f"goal rejected: {rejection.message if rejection else 'see the log of command_server'}")
        self.recorder.start()
        print("goal accepted")
        self.result = self.goal_handle.get_result_async()

    def accepted(self, goal):
        sent = self.client.send_goal_async(goal, feedback_callback=self.on_feedback)
        self.wait(sent.done, 10.0, "the goal response")
        self.goal_handle = sent.result()
        goal_id = bytes(self.goal_handle.goal_id.uuid)
        self.wait(lambda: self.goal_handle.accepted or goal_id in self.rejections, 10.0, "the reason for the rejection")
        return self.goal_handle.accepted

    def on_rejection(self, rejection):
        self.rejections[bytes(rejection.goal_id.uuid)] = rejection

    def on_feedback(self, _message):
        if not sys.stdout.isatty():
            return
        done = max(0.0, min(1.0, (self.start_height - self.recorder.height) / self.options.drop))
        bar = "#" * round(BAR * done)
        force = self.recorder.force()
        print(f"\r  moving down [{bar:<{BAR}}] {self.start_height - self.recorder.height:5.3f} m, "
              f"force x {force[0]:6.1f} y {force[1]:6.1f} z {force[2]:6.1f} N ", end="", flush=True)

    def push(self, axis):
        """Pushes the flange along one of its axes with 1.5 times the threshold."""
        wrench = [0.0] * 6
        wrench["xyz".index(axis)] = 1.5 * self.options.threshold
        self.control.request("push", wrench=wrench, duration=0.4, frame="tool")
        self.pushes.append((self.recorder.now(), axis))
        print(f"{NEW_LINE}  push along {axis.upper()}: {wrench['xyz'.index(axis)]:g} N for 0.4 s (must be ignored)")

    def run(self):
        self.send_goal()
        limit = 10.0 + 2.0 * self.options.drop / self.options.speed
        for axis, fraction in (("x", 0.3), ("y", 0.6)):
            height = self.start_height - fraction * self.options.drop
            self.wait(lambda h=height: self.recorder.height < h or self.result.done(), limit, "the arm to move down")
            if self.result.done():
                break
            self.push(axis)
        self.wait(self.result.done, limit, "the result")
        print(NEW_LINE, end="")
        end = self.recorder.now() + RECORDING_AFTER_STANDSTILL
        self.wait(lambda: self.recorder.now() > end, 10.0 * RECORDING_AFTER_STANDSTILL, "the end of the recording")
        return self.result.result().result

    def events(self):
        return mark_events(self.recorder.rows, self.pushes, self.options.threshold)

    def report(self, result, events):
        ignored = [event for event in events if event[1].startswith("ignored")]
        stops = [event for event in events if event[1].startswith("stop")]
        for index, kind in ignored:
            row, axis = self.recorder.rows[index], kind[-1]
            print(f"ignored:    {row[force_column(axis)]:.1f} N along {axis.upper()} at t = {row['timestamp']:.3f} s")
        if stops:
            row = self.recorder.rows[stops[0][0]]
            standstill = next((later["timestamp"] for later in self.recorder.rows[stops[0][0]:]
                               if max(abs(later[velocity]) for velocity in VELOCITIES) < STANDSTILL), math.nan)
            peak = max((later[force_column("z")] for later in self.recorder.rows[stops[0][0]:]), key=abs)
            print(f"stop:       {row[force_column('z')]:.1f} N along Z at t = {row['timestamp']:.3f} s, the first recorded sample above "
                  f"the threshold of {self.options.threshold:g} N; the driver, which reads more samples, stopped at {result.force:.1f} N")
            print(f"standstill: {1000 * (standstill - row['timestamp']):.0f} ms later; the force grew to {peak:.1f} N while the arm "
                  "decelerated")
        print(f"distance:   {result.distance:.3f} m")
        print(f"result:     {'success' if result.success else 'failure'} ({result.error_code}): {result.message}")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--address", default="127.0.0.1", help="address of the simulator")
    parser.add_argument("--model", default="UR10e", help="model in the title")
    parser.add_argument("--threshold", type=float, default=20.0, help="force threshold along the flange Z axis, N")
    parser.add_argument("--speed", type=float, default=0.1, help="speed of the tool, m/s")
    parser.add_argument("--drop", type=float, default=0.3, help="distance of the tool above the table, m")
    parser.add_argument("--output", type=Path, default=Path("."), help="folder for the CSV file and the figure")
    return parser.parse_args()


def main():
    options = parse_arguments()
    rclpy.init()
    node = Node("force_experiment")
    try:
        with ControlPort(options.address) as control:
            experiment = Experiment(node, control, options)
            experiment.prepare()
            result = experiment.run()
            events = experiment.events()
            experiment.report(result, events)
            csv_path, png_path = (options.output / f"force_experiment.{kind}" for kind in ("csv", "png"))
            write_csv(csv_path, experiment.recorder.rows, events)
            draw(csv_path, png_path, options.threshold,
                 f"MoveDownUntilForce on a simulated {options.model}: only a force along the flange Z axis stops it")
            print(f"written:    {csv_path} ({len(experiment.recorder.rows)} samples), {png_path}")
            return 0 if result.success and len(events) == 3 else 1
    except ExternalShutdownException:
        return 128 + signal.SIGINT
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    sys.exit(main())
