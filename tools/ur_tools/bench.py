"""./ur bench: latency, load and start-up of the driver on the simulated controller, each beside its aim, as a ratio.

A ratio below 1 is better than the aim. Figures of a busy machine say more about the machine.
"""

import argparse
import json
import sys
import time
from typing import Dict, List, Optional, Tuple

from . import bench_trajectory, boilerplate, cell, say
from .environment import program, run_environment
from .layout import ROOT, Layout
from .processes import Programs

# Name of a figure, its part, the aim, the unit.
AIMS: Tuple[Tuple[str, Optional[str], float, str], ...] = (
    ("package to C++ subscriber", "p50", 0.3, "ms"),
    ("package to C++ subscriber", "p99", 1.0, "ms"),
    ("package to rclpy subscriber", "p50", 0.3, "ms"),
    ("package to rclpy subscriber", "p99", 1.0, "ms"),
    ("goal to first RTDE command", "p50", 1.0, "ms"),
    ("cancel to deceleration", "p50", 5.0, "ms"),
    ("servo stream", "p99.9 off", 0.2, "ms from its interval"),
    ("servo stream", "outside 0.2 ms", 0.1, "% of its intervals"),
    ("servo stream", "cycles outside", 0.1, "% of the simulated controller's own intervals meanwhile"),
    ("servo stream", "tracking error", 0.02, "rad"),
    ("cpu", "simulator", 10.0, "% of a core"),
    ("cpu", "robot_state_receiver", 10.0, "% of a core"),
    ("cpu", "command_server", 10.0, "% of a core"),
    ("cpu", "dashboard_server", 10.0, "% of a core"),
    ("memory", "command_server", 100.0, "MB"),
    ("start to ready", None, 2.0, "s"),
)


def parse(arguments: List[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="./ur bench", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--address", default="127.0.0.1", help="loopback address of the simulator (default: 127.0.0.1)")
    parser.add_argument("--model", default="ur10e", help="arm to simulate (default: ur10e)")
    parser.add_argument("--repeat", type=int, default=40, metavar="N", help="goals and cancels to measure (default: 40)")
    bench_trajectory.add_options(parser)
    return parser.parse_args(arguments)


def _start(programs: Programs, layout: Layout, options: argparse.Namespace, env: Dict[str, str]) -> "tuple[Dict[str, int], float]":
    """The process ids by name, and how long the command server took to be ready."""
    simulator = cell.start_simulator(programs, layout, env, options.address, options.model)
    pids = {"simulator": simulator.process.pid}
    ready = 0.0
    for node in cell.NODES:
        begin = time.monotonic()
        started = cell.start_node(programs, layout, env, node, options.address)
        pids[node] = started.process.pid
        if node == "command_server":
            programs.wait_until(lambda: "the robot is ready" in started.output and "commands: " in started.output, 20.0,
                                "the robot to be ready")
            ready = time.monotonic() - begin
    return pids, ready


def _measure(programs: Programs, layout: Layout, options: argparse.Namespace, pids: Dict[str, int],
             env: Dict[str, str]) -> dict:
    output = layout.log / "bench" / "figures.json"
    output.unlink(missing_ok=True)
    command = [str(layout.python), str(ROOT / "bench" / "measure.py"), "--address", options.address, "--subscriber",
               str(program(layout, "ur_ros_rtde", "joint_state_latency")), "--repeat", str(options.repeat), "--output", str(output)]
    for name, pid in pids.items():
        command += ["--pid", f"{name}={pid}"]
    if programs.run(command, env, 300.0) != 0:
        raise say.Failure("the measurement ended early, see above")
    return json.loads(output.read_text())


def _print(figures: dict) -> None:
    say.line(f"{'':30} {'':16} {'measured':>10} {'aim':>8}  ratio")
    for name, part, aim, unit in AIMS:
        value = figures.get(name)
        if part is not None and value is not None:
            value = value.get(part)
        if value is None:
            say.line(f"{name:30} {part or '':16} nothing measured")
            continue
        say.line(f"{name:30} {part or '':16} {value:10.3f} {aim:8g}  {value / aim:5.2f}  {unit}")


def run(options: argparse.Namespace, layout: Layout) -> int:
    if options.trajectory:
        return bench_trajectory.run(options, layout)
    env = {**run_environment(layout), "PYTHONDONTWRITEBYTECODE": "1"}
    with Programs(layout.log / "bench") as programs:
        say.step("Starting simulator and nodes, measuring for about a minute")
        pids, ready = _start(programs, layout, options, env)
        figures = _measure(programs, layout, options, pids, env)
        figures["start to ready"] = ready
        programs.check()
        _print(figures)
        say.line("\n" + boilerplate.table())
    return 0


if __name__ == "__main__":
    sys.exit(cell.main(parse, run))
