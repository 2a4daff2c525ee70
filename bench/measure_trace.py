"""Lets packages and goals pass through the traced nodes, and measures the same without them. Started by `./ur bench --trace`."""

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

import rclpy
from goal_latency import GoalLatency
from joint_state_subscriber import receive_in_python
from latency import latencies
from rtde_socket import receive_from_socket

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "demo"))
from control_port import ControlPort

FLOOR = ("--ros-args", "-r", "__ns:=/floor")  # where the bare publisher publishes
FLOOR_SECONDS = 600  # it is terminated before, however long subscribers take to find it


def receive_in_cpp(options, *arguments, **env):
    output = subprocess.run([options.subscriber, str(options.seconds), *arguments], check=True, capture_output=True, text=True,
                            timeout=options.seconds + 30, env={**os.environ, **env}).stdout
    return [tuple(map(int, line.split())) for line in output.splitlines()]


def since_stamp(received):
    return [(when - stamp) * 1e-6 for stamp, when in received]


def sent_times(control):
    return [sent for _, sent, *_ in control.request("trace")["cycles"]]


def floors(options, control):
    """Returns latencies in ms without the driver, and with it but without the trace."""
    received = receive_from_socket(options.address, options.seconds)
    found = {"socket": latencies([(when, when) for when in received], control.request("trace"))}
    publisher = subprocess.Popen([options.publisher, str(FLOOR_SECONDS)])
    try:
        found["rcl"] = since_stamp(receive_in_cpp(options, *FLOOR))
        found["rclpy"] = since_stamp(receive_in_python(options.seconds, "/floor/joint_states"))
    finally:
        publisher.terminate()
        publisher.wait(10.0)
    found["driver"] = latencies(receive_in_cpp(options), control.request("trace"))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--address", required=True)
    parser.add_argument("--subscriber", required=True, help="path of the C++ subscriber")
    parser.add_argument("--publisher", required=True, help="path of the bare publisher")
    parser.add_argument("--trace-library", required=True, help="library that traces the subscriber")
    parser.add_argument("--trace", required=True, help="file for the trace of the subscriber")
    parser.add_argument("--goal-client", required=True, help="path of the C++ client")
    parser.add_argument("--seconds", type=int, required=True, help="duration of each measurement of packages")
    parser.add_argument("--repeat", type=int, default=40, help="number of goals")
    parser.add_argument("--output", required=True, type=Path, metavar="FILE", help="file for the times")
    options = parser.parse_args()
    rclpy.init()
    with ControlPort(options.address) as control:
        receive_in_cpp(options, LD_PRELOAD=options.trace_library, HAND_OVER_TRACE=options.trace)
        found = {"sent": sent_times(control)}
        goals = GoalLatency(control)
        found["goals"] = {"C++": goals.from_cpp(options.goal_client, options.repeat), "rclpy": goals.from_python(options.repeat)}
        goals.close()
        found.update(floors(options, control))
    rclpy.try_shutdown()
    options.output.write_text(json.dumps(found))


if __name__ == "__main__":
    main()
