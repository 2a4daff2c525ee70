"""./ur bench --scale: load, latency and memory with several robots, and memory over many goals.

A driver process serves one robot. Several robots are several drivers, each with its own namespace (docs/internals/performance.md).
"""

import argparse
import ipaddress
import time
from typing import Dict, List

from . import bench_session, console, ports, simulation
from .bench_rows import HOSTING, ROBOTS, scale_name
from .environment import program
from .layout import Layout
from .processes import Program, Programs

READY_TIMEOUT = 120.0  # s; each driver discovers the actions of all others


def add_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("several robots and many goals")
    group.add_argument("--scale", action="store_true",
                       help=f"only measure load, latency and memory with {', '.join(map(str, ROBOTS))} robots, and the driver's "
                            "memory over many goals (about 5 min)")
    group.add_argument("--goals", type=int, default=10000, metavar="N",
                       help="with --scale: number of goals; 0: none (default: 10000)")
    group.add_argument("--robots", type=_numbers, default=ROBOTS, metavar="N,N",
                       help=f"with --scale: numbers of robots, out of {', '.join(map(str, ROBOTS))} (default: all)")


def _numbers(text: str) -> "tuple[int, ...]":
    try:
        found = tuple(int(part) for part in text.split(",") if part)
    except ValueError:
        found = (0,)
    if not set(found) <= set(ROBOTS):
        raise argparse.ArgumentTypeError(f"{text}: give some of {', '.join(map(str, ROBOTS))}")
    return found


def addresses(options: argparse.Namespace, count: int) -> List[str]:
    """Returns the addresses of the simulators: that of --address, and those that follow it."""
    first = ipaddress.IPv4Address(options.address)
    return [str(first + number) for number in range(count)]


def check(options: argparse.Namespace) -> None:
    """Raises Failure if an address is in use."""
    for address in addresses(options, max(options.robots, default=1)):
        ports.check(address)


def _start_robot(programs: Programs, layout: Layout, options: argparse.Namespace, address: str, number: int,
                 nodes: "tuple[str, ...]") -> Dict[str, Program]:
    env = bench_session.environment(layout)
    simulator = [str(program(layout, "ur_simulator", "ur_simulator")), "--address", address, "--model", options.model]
    started = programs.start(f"simulator_{number}", simulator, env)
    programs.wait_until(lambda: "ready: " in started.output, 10.0, "the simulator's ports")
    found = {}
    for node in nodes:
        # With many robots on few cores, a delay must appear in the figures instead of ending a connection.
        parameters = () if node == "dashboard_server" else ("silence_limit:=2.0",)
        command = [str(program(layout, "ur_ros_rtde", node)), "--ros-args", "-p", f"robot_ip:={address}",
                   *(part for parameter in parameters for part in ("-p", parameter)), "-r", f"__ns:=/robot_{number}"]
        found[node] = programs.start(f"{node}_{number}", command, env)
    return found


def _measure_robots(layout: Layout, options: argparse.Namespace, count: int, nodes: "tuple[str, ...]") -> dict:
    with Programs(bench_session.log_folder(layout, options.address)) as programs:
        begin = time.monotonic()
        robots = [_start_robot(programs, layout, options, address, number, nodes)
                  for number, address in enumerate(addresses(options, count))]
        for robot in robots:
            server = robot.get("driver") or robot["command_server"]
            bench_session.wait_until_ready(programs, server, READY_TIMEOUT)
        ready = time.monotonic() - begin
        pids = [node.process.pid for robot in robots for node in robot.values()]
        arguments = ["--address", options.address, "--subscriber", bench_session.subscriber(layout), "--namespace", "/robot_0",
                     "--robots", str(count), *(part for pid in pids for part in ("--pid", str(pid)))]
        found = bench_session.run_script(programs, layout, options, "measure_robots.py", arguments, 120.0)
        programs.check()
    return {**found, "ready": ready}


def _measure_goals(layout: Layout, options: argparse.Namespace) -> dict:
    """Sends goals one after the other. Returns the growth of the driver's memory and the duration of a goal."""
    console.step(f"Sending {options.goals} goals")
    env = bench_session.environment(layout)
    with Programs(bench_session.log_folder(layout, options.address)) as programs:
        simulation.start_simulator(programs, layout, env, options.address, options.model)
        driver = simulation.start_node(programs, layout, env, "driver", options.address)
        bench_session.wait_until_ready(programs, driver)
        arguments = ["--pid", str(driver.process.pid), "--goals", str(options.goals)]
        found = bench_session.run_script(programs, layout, options, "many_goals.py", arguments, 120.0 + 0.2 * options.goals)
        programs.check()
    return found


def measure(layout: Layout, options: argparse.Namespace) -> "tuple[dict, dict]":
    """Returns figures and samples."""
    figures, samples = {}, {}
    for hosting, nodes in HOSTING.items():
        for count in options.robots:
            console.step(f"Measuring {count} robot{'s' * (count > 1)}, each as {hosting}")
            figures[scale_name(count, hosting)] = _measure_robots(layout, options, count, nodes)
    if options.goals:
        found = _measure_goals(layout, options)
        figures["many goals"], samples["many goals"] = found["figures"], found["samples"]
    return figures, samples
