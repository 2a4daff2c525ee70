"""Measures a running simulator and driver, and writes the figures as JSON. Started by `./ur bench`, which starts both."""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import rclpy
from goal_latency import GoalLatency, milliseconds
from joint_state_subscriber import receive_in_python
from latency import latencies, percentile
from process_load import LoadTrace, cpu_percent, resident_megabytes
from servo_stream import servo_stream

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "demo"))
from control_port import ControlPort

TRACE_SECONDS = 7.0  # the simulator keeps 16384 cycles: 32 s at 500 Hz
GOALS = 5  # times --repeat, of those that last some milliseconds: for their 99th percentile


def summary(values):
    return {"p50": percentile(values, 0.5), "p99": percentile(values, 0.99), "count": len(values)} if values else None


def receive_in_cpp(program, seconds):
    output = subprocess.run([program, str(seconds)], check=True, capture_output=True, text=True, timeout=seconds + 30).stdout
    return [tuple(map(int, line.split())) for line in output.splitlines()]


def points(received, values):
    """Returns [(time of reception in s, value), ...] for the report. Times begin at 0. The first messages may have no value."""
    return [(round((when - received[0][1]) * 1e-9, 6), round(value, 4)) for (_, when), value in zip(received[-len(values):], values)]


def state_figures(options, control, pids):
    figures, samples = {}, {}
    for name, receive in (("C++", lambda s: receive_in_cpp(options.subscriber, s)), ("rclpy", receive_in_python)):
        received = receive(TRACE_SECONDS)
        values = latencies(received, control.request("trace"))
        figures[f"package to {name} subscriber"] = summary(values)
        samples[f"package to {name} subscriber"] = points(received, values)
    figures["cpu"] = cpu_percent(pids, 5.0)
    figures["memory"] = {name: resident_megabytes(pid) for name, pid in pids.items()}
    return figures, samples


def goal_figures(options, control):
    latency = GoalLatency(control)
    measured = {"goal of C++ client to command": milliseconds(latency.from_cpp(options.goal_client, GOALS * options.repeat)),
                "goal of rclpy client to command": milliseconds(latency.from_python(GOALS * options.repeat)),
                "cancel to deceleration": latency.cancel_to_deceleration(options.repeat // 2),
                "end of motion to result": latency.end_to_result(options.repeat)}
    latency.close()
    samples = {name: list(enumerate(values)) for name, values in measured.items()}
    return {name: summary(values) for name, values in measured.items()}, samples


def all_figures(options, control):
    """Returns the figures, and the samples that the report draws."""
    pids = {name: int(pid) for name, pid in (pair.split("=") for pair in options.pid)}
    with LoadTrace(pids) as trace:
        figures, samples = state_figures(options, control, pids)
        goals, goal_samples = goal_figures(options, control)
    return {**figures, **goals}, {**samples, **goal_samples, "processes": trace.points}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--address", required=True)
    parser.add_argument("--subscriber", required=True, help="path of the C++ subscriber")
    parser.add_argument("--goal-client", required=True, help="path of the C++ client")
    parser.add_argument("--pid", action="append", default=[], metavar="NAME=PID", help="process whose load is measured")
    parser.add_argument("--output", required=True, type=Path, metavar="FILE", help="file for the figures")
    parser.add_argument("--repeat", type=int, default=40, help="number of goals and cancel requests")
    parser.add_argument("--stream", action="store_true", help="measure only the servo stream")
    parser.add_argument("--seconds", type=float, default=10.0, help="duration of the servo stream, in the robot's time")
    parser.add_argument("--real-time-factor", type=float, default=1.0, help="real-time factor of the simulator")
    options = parser.parse_args()
    rclpy.init()
    with ControlPort(options.address) as control:
        if options.stream:
            stream, answers = servo_stream(control, options.seconds, options.real_time_factor)
            figures, samples = {"servo stream": stream}, {"servo stream": answers}
        else:
            figures, samples = all_figures(options, control)
    rclpy.try_shutdown()
    options.output.write_text(json.dumps({"figures": figures, "samples": samples}))


if __name__ == "__main__":
    main()
