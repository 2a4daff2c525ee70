"""Interrupts the state of the robot in three ways, and measures when joint_states continues. Started by `./ur bench --recovery`."""

import argparse
import json
import shlex
import signal
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import rclpy
from latency import percentile
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import JointState

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "demo"))
from control_port import ControlPort

RTDE_PORT = 30004
LIMIT = 20.0  # s, for each recovery
STEADY = 0.5  # s with messages before each interruption: connections that break again at once are replaced at longer intervals


class JointStates:
    """Receives joint_states in a thread."""

    def __init__(self):
        self._arrived = threading.Condition()
        self._messages = []  # (stamp, time of reception) in ns
        self._node = Node("bench_recovery")
        self._node.create_subscription(JointState, "joint_states", self._receive, qos_profile_sensor_data)
        self._thread = threading.Thread(target=self._spin)
        self._thread.start()

    def _spin(self):
        try:
            rclpy.spin(self._node)
        except ExternalShutdownException:
            pass

    def _receive(self, message):
        stamp = message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec
        with self._arrived:
            self._messages.append((stamp, time.time_ns()))
            self._arrived.notify_all()

    def _wait(self, find, what):
        with self._arrived:
            if not self._arrived.wait_for(lambda: find() is not None, LIMIT):
                raise SystemExit(f"bench: {what} did not arrive within {LIMIT:g} s")
            return find()

    def steady(self):
        """Waits until messages have arrived for some time."""
        begin = time.time_ns()

        def found():
            first = next((when for _, when in self._messages if when > begin), None)
            return first is not None and self._messages[-1][1] - first > STEADY * 1e9 or None

        self._wait(found, f"joint_states for {STEADY:g} s")

    def first_after(self, begin):
        """Returns the time in ns at which the first message with data from after `begin` arrived."""
        return self._wait(lambda: next((when for stamp, when in self._messages if stamp > begin), None), "joint_states")

    def close(self):
        rclpy.try_shutdown()
        self._thread.join()
        self._node.destroy_node()


class Process:
    """A program that is started again and again. Its output goes to a log file."""

    def __init__(self, command, log):
        self._command, self._log = shlex.split(command), open(log, "wb")
        self.start()

    def start(self):
        self._process = subprocess.Popen(self._command, stdout=self._log, stderr=subprocess.STDOUT)

    def end(self, number):
        self._process.send_signal(number)
        self._process.wait(timeout=LIMIT)

    def close(self):
        if self._process.poll() is None:
            self._process.kill()
            self._process.wait()
        self._log.close()


def wait_for_port(address, port):
    deadline = time.monotonic() + LIMIT
    while True:
        try:
            socket.create_connection((address, port), timeout=LIMIT).close()
            return
        except ConnectionRefusedError:
            if time.monotonic() > deadline:
                raise SystemExit(f"bench: port {port} of {address} did not open within {LIMIT:g} s") from None
            time.sleep(0.0005)


def close_links(address):
    with ControlPort(address) as control:
        control.request("drop_links", which="rtde")
    return time.time_ns()


def restart_controller(address, simulator):
    simulator.end(signal.SIGKILL)
    simulator.start()
    wait_for_port(address, RTDE_PORT)
    return time.time_ns()


def restart_node(node):
    node.end(signal.SIGINT)
    begin = time.time_ns()
    node.start()
    return begin


def measure(states, interrupt, count):
    """Returns median and maximum in ms from the end of each interruption to the next message."""
    times = []
    for _ in range(count):
        states.steady()
        begin = interrupt()
        times.append((states.first_after(begin) - begin) * 1e-6)
    return {"p50": percentile(times, 0.5), "max": max(times), "count": count}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--address", required=True)
    parser.add_argument("--simulator", required=True, metavar="COMMAND", help="command line of the simulator")
    parser.add_argument("--node", required=True, metavar="COMMAND", help="command line of the node")
    parser.add_argument("--repeat", type=int, default=40, help="number of interruptions of each kind")
    parser.add_argument("--logs", required=True, type=Path, metavar="FOLDER")
    parser.add_argument("--output", required=True, type=Path, metavar="FILE", help="file for the figures")
    options = parser.parse_args()
    simulator = Process(options.simulator, options.logs / "simulator.log")
    wait_for_port(options.address, RTDE_PORT)
    node = Process(options.node, options.logs / "node.log")
    rclpy.init()
    states = JointStates()
    try:
        figures = {"links closed": measure(states, lambda: close_links(options.address), options.repeat),
                   "controller restarted": measure(states, lambda: restart_controller(options.address, simulator), options.repeat),
                   "node restarted": measure(states, lambda: restart_node(node), options.repeat)}
    finally:
        states.close()
        node.close()
        simulator.close()
    options.output.write_text(json.dumps({"figures": figures, "samples": {}}))


if __name__ == "__main__":
    main()
