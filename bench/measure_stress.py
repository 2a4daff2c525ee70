"""Measures latency and missing packages with each quality of service. Started by `./ur bench --stress`."""

import argparse
import json
import subprocess
import sys
import time
from pathlib import Path

import rclpy
from latency import latencies, missing_percent, percentile
from process_load import cpu_seconds, tree
from rclpy.node import Node

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "demo"))
from control_port import ControlPort

SECONDS = 7  # the simulator keeps 16384 cycles: 32 s at 500 Hz
LIMIT = 30.0  # s, until the other subscribers are found
ARGUMENTS = {"best effort": (), "reliable": ("reliable",)}


def wait_for_subscribers(count):
    node = Node("bench_stress")
    deadline = time.monotonic() + LIMIT
    while node.count_subscribers("joint_states") < count:
        if time.monotonic() > deadline:
            raise SystemExit(f"bench: {node.count_subscribers('joint_states')} of {count} subscribers were found in {LIMIT:g} s")
        time.sleep(0.1)
    node.destroy_node()


def receive(program, qos):
    """Returns [(stamp, time of reception)] in ns of joint_states."""
    command = [program, str(SECONDS), *ARGUMENTS[qos]]
    output = subprocess.run(command, check=True, capture_output=True, text=True, timeout=SECONDS + 60).stdout
    return [tuple(map(int, line.split())) for line in output.splitlines()]


class Loads:
    """The loads in % of a core of processes with their descendants, since it was created."""

    def __init__(self, pids):
        self._pids = {name: tree(pid) for name, pid in pids.items()}
        self._begin, self._before = time.monotonic(), self._seconds()

    def _seconds(self):
        return {name: sum(map(cpu_seconds, pids)) for name, pids in self._pids.items()}

    def result(self):
        elapsed = time.monotonic() - self._begin
        return {name: 100.0 * (seconds - self._before[name]) / elapsed for name, seconds in self._seconds().items()}


def figures(received, trace):
    """Returns the figures, and the latencies with the times of reception in s for the report."""
    values = latencies(received, trace)
    if not values:
        return None, []
    summary = {name: percentile(values, fraction) for name, fraction in (("p50", 0.5), ("p99", 0.99), ("p99.9", 0.999))}
    begin = received[0][1]
    points = [(round((when - begin) * 1e-9, 6), round(value, 4))
              for (_, when), value in zip(received[-len(values):], values)]
    return {**summary, "missing": missing_percent(received, trace)}, points


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--address", required=True)
    parser.add_argument("--subscriber", required=True, help="path of the C++ subscriber")
    parser.add_argument("--subscribers", type=int, required=True, help="number of other subscribers to wait for")
    parser.add_argument("--load", action="append", default=[], metavar="NAME=PID", help="process whose load is measured; repeatable")
    parser.add_argument("--output", required=True, type=Path, metavar="FILE", help="file for the figures")
    options = parser.parse_args()
    rclpy.init()
    wait_for_subscribers(options.subscribers)
    found = {}
    with ControlPort(options.address) as control:
        loads = Loads({name: int(pid) for name, pid in (pair.split("=") for pair in options.load)})
        for qos in ARGUMENTS:
            found[qos] = figures(receive(options.subscriber, qos), control.request("trace"))
        load = loads.result()
    rclpy.try_shutdown()
    options.output.write_text(json.dumps({"figures": {qos: one for qos, (one, _) in found.items()},
                                          "samples": {qos: points for qos, (_, points) in found.items()}, "load": load}))


if __name__ == "__main__":
    main()
