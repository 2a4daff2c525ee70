"""Measures a running simulator and driver, and writes the figures as JSON. Started by `./ur bench`, which starts both."""

import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import rclpy
from goal_latency import GoalLatency
from servo_stream import servo_stream
from state_latency import latencies, percentile, receive_in_python

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "demo"))
from control_port import ControlPort  # noqa: E402

TRACE_SECONDS = 7.0  # the simulator keeps 4096 cycles: 8 s at 500 Hz


def summary(values):
    return {"p50": percentile(values, 0.5), "p99": percentile(values, 0.99), "count": len(values)} if values else None


def receive_in_cpp(program, seconds):
    output = subprocess.run([program, str(seconds)], check=True, capture_output=True, text=True, timeout=seconds + 30).stdout
    return [tuple(map(int, line.split())) for line in output.splitlines()]


def cpu_seconds(pid):
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def resident_megabytes(pid):
    status = Path(f"/proc/{pid}/status").read_text()
    return next(int(line.split()[1]) for line in status.splitlines() if line.startswith("VmRSS:")) / 1024.0


def cpu_percent(pids, seconds):
    """Returns the load of each process in % of one core while the robot is idle."""
    before, begin = {name: cpu_seconds(pid) for name, pid in pids.items()}, time.monotonic()
    time.sleep(seconds)
    elapsed = time.monotonic() - begin
    return {name: 100.0 * (cpu_seconds(pid) - before[name]) / elapsed for name, pid in pids.items()}


def state_figures(options, control):
    figures = {}
    for name, receive in (("C++", lambda s: receive_in_cpp(options.subscriber, s)), ("rclpy", receive_in_python)):
        received = receive(TRACE_SECONDS)
        figures[f"package to {name} subscriber"] = summary(latencies(received, control.request("trace")))
    pids = {name: int(pid) for name, pid in (pair.split("=") for pair in options.pid)}
    figures["cpu"] = cpu_percent(pids, 5.0)
    figures["memory"] = {name: resident_megabytes(pid) for name, pid in pids.items()}
    return figures


def goal_figures(options, control):
    latency = GoalLatency(control)
    figures = {"goal to first RTDE command": summary(latency.goal_to_command(options.repeat)),
               "cancel to deceleration": summary(latency.cancel_to_deceleration(options.repeat // 2))}
    latency.close()
    return figures


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--address", required=True)
    parser.add_argument("--subscriber", required=True, help="path of the C++ subscriber")
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
            figures = {"servo stream": servo_stream(control, options.seconds, options.real_time_factor)}
        else:
            figures = {**state_figures(options, control), **goal_figures(options, control)}
    rclpy.try_shutdown()
    options.output.write_text(json.dumps(figures))


if __name__ == "__main__":
    main()
