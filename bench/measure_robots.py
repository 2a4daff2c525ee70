"""Measures load and memory of the drivers of several robots, and the latency of one of them. Started by `./ur bench --scale`."""

import argparse
import json
import subprocess
import sys
import time
from pathlib import Path

from latency import latencies, percentile
from process_load import cpu_percent, proportional_megabytes, resident_megabytes

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "demo"))
from control_port import ControlPort

LATENCY_SECONDS, LOAD_SECONDS = 7, 5.0


def receive(program, namespace, seconds):
    """Returns [(stamp, time of reception)] in ns of the joint_states of a namespace."""
    command = [program, str(seconds), "--ros-args", "-r", f"__ns:={namespace}"]
    output = subprocess.run(command, check=True, capture_output=True, text=True, timeout=seconds + 60).stdout
    return [tuple(map(int, line.split())) for line in output.splitlines()]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--address", required=True, help="of the simulator in the namespace")
    parser.add_argument("--subscriber", required=True, help="path of the C++ subscriber")
    parser.add_argument("--namespace", required=True, help="of the robot whose latency is measured")
    parser.add_argument("--robots", required=True, type=int)
    parser.add_argument("--pid", action="append", type=int, required=True, help="process of a driver; repeatable")
    parser.add_argument("--output", required=True, type=Path, metavar="FILE", help="file for the figures")
    options = parser.parse_args()
    with ControlPort(options.address) as control:
        received = receive(options.subscriber, options.namespace, LATENCY_SECONDS)
        values = latencies(received, control.request("trace"))
    time.sleep(1.0)  # the subscriber has left
    load = sum(cpu_percent({pid: pid for pid in options.pid}, LOAD_SECONDS).values())
    figures = {"package p50": percentile(values, 0.5), "package p99": percentile(values, 0.99), "cpu": load / options.robots,
               "memory": sum(map(resident_megabytes, options.pid)) / options.robots,
               "own memory": sum(map(proportional_megabytes, options.pid)) / options.robots}
    options.output.write_text(json.dumps(figures))


if __name__ == "__main__":
    main()
