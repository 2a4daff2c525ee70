"""Starts a simulated controller and the nodes of one robot, and runs the measurement program beside them."""

import argparse
import contextlib
import json
import pathlib
import time
from typing import Dict, Iterator, List, Tuple

from . import console, realtime, simulation
from .environment import program, run_environment
from .layout import ROOT, Layout
from .processes import Program, Programs


def environment(layout: Layout) -> Dict[str, str]:
    return {**run_environment(layout), "PYTHONDONTWRITEBYTECODE": "1"}


def log_folder(layout: Layout, address: str) -> pathlib.Path:
    """Returns the folder of the logs. Measurements on different addresses may run at the same time."""
    return layout.log / "bench" / address


def wait_until_ready(programs: Programs, node: Program, limit: float = 20.0) -> None:
    """Waits until a node with actions serves them, and its robot is ready. Raises Failure after `limit` s."""
    programs.wait_until(lambda: "the robot is ready" in node.output and "commands: " in node.output, limit,
                        f"{node.name} to be ready")


def run_script(programs: Programs, layout: Layout, options: argparse.Namespace, script: str, arguments: List[str],
               limit: float) -> dict:
    """Runs bench/<script> with the Python of the build. Returns what it writes to the file given by --output."""
    output = log_folder(layout, options.address) / "figures.json"
    output.unlink(missing_ok=True)
    command = [str(layout.python), str(ROOT / "bench" / script), *arguments, "--output", str(output)]
    if programs.run(command, environment(layout), limit) != 0:
        raise console.Failure("the measurement failed, see above")
    return json.loads(output.read_text())


def subscriber(layout: Layout) -> str:
    return str(program(layout, "ur_ros_rtde", "joint_state_latency"))


def goal_client(layout: Layout) -> str:
    return str(program(layout, "ur_ros_rtde", "goal_latency"))


def _nodes(options: argparse.Namespace, priority: int) -> Dict[str, Tuple[str, ...]]:
    """Returns the nodes to start, with their parameters."""
    # A delay of 100 ms must appear in the figures instead of ending the stream. A slowed robot sends packages less often.
    silence = min(10.0, max(1.0, 0.1 / options.real_time_factor))
    link = (f"realtime_priority:={priority}", f"silence_limit:={silence}")
    parameters: Dict[str, Tuple[str, ...]] = {"robot_state_receiver": link, "dashboard_server": (),
                                              "command_server": (*link, "watchdog_frequency:=2.0")}
    names = ("command_server",) if options.stream else simulation.NODES
    return {name: parameters[name] for name in names}


def _start(programs: Programs, layout: Layout, options: argparse.Namespace, priority: int) -> "tuple[Dict[str, int], float]":
    """Returns the process ids by name, and the time in s until the command server was ready."""
    env = environment(layout)
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
            wait_until_ready(programs, started)
            ready = time.monotonic() - begin
    return pids, ready


def _arguments(layout: Layout, options: argparse.Namespace, pids: Dict[str, int]) -> List[str]:
    """Returns the arguments of bench/measure.py."""
    arguments = ["--address", options.address, "--subscriber", subscriber(layout), "--goal-client", goal_client(layout),
                 "--repeat", str(options.repeat)]
    if options.stream:
        arguments += ["--stream", "--real-time-factor", str(options.real_time_factor), "--seconds", str(options.seconds)]
    for name, pid in pids.items():
        arguments += ["--pid", f"{name}={pid}"]
    return arguments


@contextlib.contextmanager
def running(layout: Layout, options: argparse.Namespace, priority: int = 0) -> "Iterator[tuple[Programs, Dict[str, int], float]]":
    """Runs the simulator and the nodes. Yields them, their process ids and the start-up time of the command server in s."""
    with Programs(log_folder(layout, options.address)) as programs:
        if priority and not options.let_sleep:
            realtime.keep_awake(programs)
        pids, ready = _start(programs, layout, options, priority)
        yield programs, pids, ready
        programs.check()


def measure(layout: Layout, options: argparse.Namespace) -> "tuple[dict, dict]":
    """Measures state and goals. Returns figures and samples."""
    with running(layout, options) as (programs, pids, ready):
        found = run_script(programs, layout, options, "measure.py", _arguments(layout, options, pids), 300.0)
    return {**found["figures"], "start to ready": ready}, found["samples"]


def measure_stream(layout: Layout, options: argparse.Namespace, priority: int = 0, beside: "tuple" = ()) -> "tuple[dict, list]":
    """Measures the servo stream, with the commands `beside` running. Returns its figures and samples."""
    stream = argparse.Namespace(**{**vars(options), "stream": True})
    limit = 300.0 + 2.0 * options.seconds / options.real_time_factor
    with running(layout, stream, priority) as (programs, pids, _):
        for number, command in enumerate(beside):
            programs.start(f"beside_{number}", command, environment(layout))
        found = run_script(programs, layout, options, "measure.py", _arguments(layout, stream, pids), limit)
    return found["figures"]["servo stream"], found["samples"]["servo stream"]


def measure_streams(layout: Layout, options: argparse.Namespace, names: "tuple[str, str]", beside: "tuple" = ()) -> "tuple[dict, dict]":
    """Measures the servo stream without and, if permitted, with real-time priority. Returns figures and samples by name."""
    console.step(f"Measuring the servo stream, for about {2 * (12.0 + options.seconds / options.real_time_factor):.0f} s")
    figures, samples = {}, {}
    figures[names[0]], samples[names[0]] = measure_stream(layout, options, 0, beside)
    if realtime.realtime_allowed(options.realtime_priority):
        figures[names[1]], samples[names[1]] = measure_stream(layout, options, options.realtime_priority, beside)
    else:
        console.line(f"Not measured with real-time priority {options.realtime_priority}: this user may not have it")
    return figures, samples
