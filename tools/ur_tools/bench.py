"""./ur bench: measures latency, load and start-up of the driver on the simulated controller, and compares them with targets.

A ratio below 1 is better than the target. Measure on an idle machine.
"""

import argparse
import json
import sys
import time
from typing import Dict, List, Optional, Tuple

from . import bench_discovery, bench_trajectory, boilerplate, console, ports, realtime, simulation
from .environment import program, run_environment
from .layout import PROGRAM, ROOT, Layout
from .processes import Programs

# Figures of the servo stream: part, target, unit.
STREAM: Tuple[Tuple[str, float, str], ...] = (
    ("answer p50", 0.3, "ms from a package to its target"),
    ("answer p99.9", 0.5, "ms from a package to its target"),
    ("off package", 0.1, "% of the intervals differ by more than 0.2 ms from those of the packages that they answer"),
    ("off 2 ms", 0.1, "% of the intervals differ by more than 0.2 ms from 2 ms"),
    ("cycles off 2 ms", 0.1, "% of the simulated controller's cycles differ by more than 0.2 ms from 2 ms"),
    ("not once a cycle", 0.1, "% of the cycles received no target, or several"),
    ("tracking error", 0.02, "rad"),
)
# Figure, part, target, unit.
TARGETS: Tuple[Tuple[str, Optional[str], float, str], ...] = (
    ("package to C++ subscriber", "p50", 0.3, "ms"),
    ("package to C++ subscriber", "p99", 1.0, "ms"),
    ("package to rclpy subscriber", "p50", 0.3, "ms"),
    ("package to rclpy subscriber", "p99", 1.0, "ms"),
    ("goal to first RTDE command", "p50", 1.0, "ms"),
    ("cancel to deceleration", "p50", 5.0, "ms"),
    *((stream, *figure) for stream in ("servo stream", "servo stream, real-time") for figure in STREAM),
    ("cpu", "simulator", 10.0, "% of a core"),
    ("cpu", "robot_state_receiver", 10.0, "% of a core"),
    ("cpu", "command_server", 10.0, "% of a core"),
    ("cpu", "dashboard_server", 10.0, "% of a core"),
    ("memory", "command_server", 100.0, "MB"),
    ("start to ready", None, 2.0, "s"),
    ("new client finds all actions", "p50", 0.5, "s, after clients were killed"),
    ("new client finds all actions", "max", 1.0, "s, after clients were killed"),
)
# Clients that are killed, and clients that then search for the actions.
KILLED_CLIENTS, NEW_CLIENTS = 20, 100


def parse(arguments: List[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog=f"{PROGRAM} bench", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--address", default="127.0.0.1", help="loopback address of the simulator (default: 127.0.0.1)")
    parser.add_argument("--model", default="ur10e", help="arm to simulate (default: ur10e)")
    parser.add_argument("--repeat", type=int, default=40, metavar="N", help="goals and cancels to measure (default: 40)")
    parser.add_argument("--stream", action="store_true", help="measure only the servo stream")
    parser.add_argument("--real-time-factor", type=float, default=1.0, metavar="F",
                        help="with --stream: let the robot's time pass F times as fast. The figures of the stream are in the robot's time; "
                             "F below 1 reduces the influence of the host's latency (default: 1)")
    parser.add_argument("--seconds", type=float, default=10.0, metavar="S", help="duration of the servo stream (default: 10)")
    parser.add_argument("--let-sleep", action="store_true",
                        help="let the cores sleep while the servo stream is measured with real-time priority; use this on a virtual "
                             "machine with steal time, where busy loops cost more than they gain")
    parser.add_argument("--realtime-priority", type=int, default=40, metavar="P",
                        help="measure the servo stream a second time with the node's parameter realtime_priority set to P and the "
                             "simulator under SCHED_FIFO, if the host permits it (default: 40)")
    bench_trajectory.add_options(parser)
    options = parser.parse_args(arguments)
    if options.real_time_factor != 1.0 and not options.stream:
        parser.error("--real-time-factor needs --stream: all other figures are in the host's time")
    return options


def check(options: argparse.Namespace) -> None:
    """Raises Failure if the address is in use."""
    ports.check(options.address)


def _nodes(options: argparse.Namespace, priority: int) -> Dict[str, Tuple[str, ...]]:
    """Returns the nodes to start, with their parameters."""
    # A delay of 100 ms must appear in the figures instead of ending the stream. A slowed robot sends packages less often.
    silence = min(10.0, max(1.0, 0.1 / options.real_time_factor))
    link = (f"realtime_priority:={priority}", f"silence_limit:={silence}")
    parameters: Dict[str, Tuple[str, ...]] = {"robot_state_receiver": link, "dashboard_server": (),
                                              "command_server": (*link, "watchdog_frequency:=2.0")}
    names = ("command_server",) if options.stream else simulation.NODES
    return {name: parameters[name] for name in names}


def _start(programs: Programs, layout: Layout, options: argparse.Namespace, env: Dict[str, str],
           priority: int) -> "tuple[Dict[str, int], float]":
    """Returns the process ids by name, and the time in s until the command server was ready."""
    simulator = simulation.start_simulator(programs, layout, env, options.address, options.model, "--real-time-factor",
                                     str(options.real_time_factor))
    if priority:  # the controller must not compete with the driver, as on a real robot
        realtime.make_realtime(simulator.process.pid, max(1, priority - 1))
    pids = {"simulator": simulator.process.pid}
    ready = 0.0
    for node, parameters in _nodes(options, priority).items():
        begin = time.monotonic()
        started = simulation.start_node(programs, layout, env, node, options.address, *parameters)
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
    if options.stream:
        command += ["--stream", "--real-time-factor", str(options.real_time_factor), "--seconds", str(options.seconds)]
    for name, pid in pids.items():
        command += ["--pid", f"{name}={pid}"]
    if programs.run(command, env, 300.0 + 2.0 * options.seconds / options.real_time_factor) != 0:
        raise console.Failure("the measurement failed, see above")
    return json.loads(output.read_text())


def _session(layout: Layout, options: argparse.Namespace, priority: int = 0) -> dict:
    """Starts the programs, and measures either the stream or everything else."""
    env = {**run_environment(layout), "PYTHONDONTWRITEBYTECODE": "1"}
    with Programs(layout.log / "bench") as programs:
        if priority and not options.let_sleep:
            realtime.keep_awake(programs)
        pids, ready = _start(programs, layout, options, env, priority)
        figures = _measure(programs, layout, options, pids, env)
        programs.check()
    return {**figures, "start to ready": ready}


def _print(figures: dict) -> None:
    console.line(f"{'':30} {'':16} {'measured':>10} {'target':>8}  ratio")
    for name, part, target, unit in TARGETS:
        value = figures.get(name)
        if part is not None and value is not None:
            value = value.get(part)
        if value is not None:
            console.line(f"{name:30} {part or '':16} {value:10.3f} {target:8g}  {value / target:5.2f}  {unit}")
        elif name in figures:
            console.line(f"{name:30} {part or '':16} nothing measured")


def run(options: argparse.Namespace, layout: Layout) -> int:
    if options.trajectory:
        return bench_trajectory.run(options, layout)
    figures: dict = {}
    if not options.stream:
        console.step("Measuring state and goals, for about 45 s")
        figures = _session(layout, options)
        console.step("Measuring discovery, for about a minute")
        figures["new client finds all actions"] = bench_discovery.measure(layout, options.address, KILLED_CLIENTS, NEW_CLIENTS)
    stream = argparse.Namespace(**{**vars(options), "stream": True})
    console.step(f"Measuring the servo stream, for about {2 * (12.0 + options.seconds / options.real_time_factor):.0f} s")
    figures["servo stream"] = _session(layout, stream)["servo stream"]
    if realtime.realtime_allowed(options.realtime_priority):
        figures["servo stream, real-time"] = _session(layout, stream, options.realtime_priority)["servo stream"]
    else:
        console.line(f"Not measured with real-time priority {options.realtime_priority}: this user may not have it")
    _print(figures)
    if not options.stream:
        console.line("\n" + boilerplate.table())
    return 0


if __name__ == "__main__":
    sys.exit(simulation.main(parse, run, check))
