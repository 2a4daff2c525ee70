"""./ur bench --trace: where the time from a package to a subscriber goes, and from a goal to its command, where packages are lost, and
what the same takes without this driver."""

import argparse
import pathlib
from typing import List, Sequence

from . import bench_hand_overs as hand_overs
from . import bench_session, console, simulation
from .environment import program
from .layout import Layout
from .percentile import percentile
from .processes import Programs

NODES = ("robot_state_receiver", "command_server")
SECONDS = 7  # of each measurement of packages: the simulator keeps 32 s
FLOORS = {"socket": "package to a bare socket (Python)", "rcl": "bare rcl publisher to the same C++ subscriber",
          "rclpy": "bare rcl publisher to an rclpy subscriber", "driver": "package to a C++ subscriber, without trace"}


def add_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("trace")
    group.add_argument("--trace", action="store_true",
                       help="only trace packages and goals through all hand-overs between threads and processes (about 1 min)")


def _traced(layout: Layout, file: pathlib.Path) -> "dict[str, str]":
    """Returns the environment of a program that writes its trace to `file`."""
    library = program(layout, "ur_ros_rtde", "libhand_over_trace.so")
    return {**bench_session.environment(layout), "LD_PRELOAD": str(library), "HAND_OVER_TRACE": str(file)}


def _measure(layout: Layout, options: argparse.Namespace, folder: pathlib.Path, seconds: int) -> dict:
    """Returns what bench/measure_trace.py found, with `seconds` for each measurement of packages. The nodes have written their traces."""
    env = bench_session.environment(layout)
    with Programs(folder) as programs:
        simulation.start_simulator(programs, layout, env, options.address, options.model)
        for name in NODES:
            node = simulation.start_node(programs, layout, _traced(layout, folder / f"{name}.trace"), name, options.address,
                                         "silence_limit:=1.0")
        bench_session.wait_until_ready(programs, node)
        arguments = ["--address", options.address, "--repeat", str(options.repeat), "--seconds", str(seconds),
                     "--subscriber", bench_session.subscriber(layout), "--goal-client", bench_session.goal_client(layout),
                     "--publisher", str(program(layout, "ur_ros_rtde", "joint_state_floor")),
                     "--trace-library", _traced(layout, folder)["LD_PRELOAD"], "--trace", str(folder / "subscriber.trace")]
        return bench_session.run_script(programs, layout, options, "measure_trace.py", arguments, 120.0)


def _line(text: str, values: Sequence[float]) -> str:
    if not values:
        return f"  {text:62} nothing measured"
    return f"  {text:62}" + "".join(f"{percentile(values, fraction):10.3f}" for fraction in (0.5, 0.99, 0.999))


def _print_steps(title: str, texts: Sequence[str], times: List[List[int]]) -> None:
    console.line(f"\n{title + f' ({len(times)}), ms':64}{'p50':>10}{'p99':>10}{'p99.9':>10}")
    for text, values in zip((*texts, "all"), hand_overs.steps(times)):
        console.line(_line(text, values))


def run(options: argparse.Namespace, layout: Layout, seconds: int = SECONDS) -> int:
    folder = bench_session.log_folder(layout, options.address)
    folder.mkdir(parents=True, exist_ok=True)
    for file in folder.glob("*.trace"):
        file.unlink()
    found = _measure(layout, options, folder, seconds)
    traces = {name: hand_overs.load(folder / f"{name}.trace") for name in (*NODES, "subscriber")}
    states = traces["robot_state_receiver"], traces["subscriber"]
    _print_steps("Packages", hand_overs.PACKAGE_TEXTS, hand_overs.package_times(found["sent"], *states))
    for client, goals in found["goals"].items():
        _print_steps(f"Goals of a client in {client}", hand_overs.GOAL_TEXTS, hand_overs.goal_times(goals, traces["command_server"]))
    console.line(f"\n{'For comparison, ms':64}{'p50':>10}{'p99':>10}{'p99.9':>10}")
    for name, text in FLOORS.items():
        console.line(_line(text, found[name]))
    lost = hand_overs.losses(found["sent"], *states)
    console.line("\nLost packages: " + ", ".join(f"{name} {count}" for name, count in lost.items()))
    return 0
