"""./ur demo: starts the simulated controller of an arm above a table and the three nodes, and runs a motion that stops on force.

Writes demo/force_experiment.csv and demo/force_experiment.png: forces (top) and joint velocities (bottom), with ignored pushes in
blue and the stop in red.
"""

import argparse
import pathlib
import sys
import tempfile
import time
from typing import List

from . import console, ports, simulation, viewer
from .environment import run_environment
from .layout import PROGRAM, ROOT, Layout
from .processes import QUIETLY, Programs

# Distance of the tool above the table, m: how far each size of arm can move down from its start pose.
DROP = {"ur3": 0.15, "ur3e": 0.15}
DEFAULT_DROP = 0.3
PAGE_TIMEOUT = 20.0  # s, to open the page of the viewer
# On a busy machine the simulator may be silent for longer than a robot ever is, and Python cannot receive three topics at 500 Hz:
# 125 Hz is sufficient for the figure.
PARAMETERS = {"robot_state_receiver": ("rtde_frequency:=125.0", "silence_limit:=1.0"),
              "command_server": ("silence_limit:=1.0", "watchdog_frequency:=2.0")}


def parse(arguments: List[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog=f"{PROGRAM} demo", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--model", type=str.lower, choices=simulation.MODELS, metavar="MODEL", default="ur10e",
                        help="arm to simulate: " + ", ".join(simulation.MODELS) + " (default: ur10e)")
    parser.add_argument("--threshold", type=float, default=20.0, metavar="N",
                        help="force along the flange Z axis that stops the arm, newtons, 5 to 100 (default: 20)")
    parser.add_argument("--speed", type=float, default=0.1, metavar="M/S",
                        help="speed of the tool, m/s, 0.01 to 0.25 (default: 0.1)")
    parser.add_argument("--drop", type=float, metavar="M",
                        help="distance of the table below the tool, m (default: depends on the size of the arm)")
    parser.add_argument("--address", default="127.0.0.1", help="loopback address of the simulator (default: 127.0.0.1)")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "demo", metavar="FOLDER",
                        help="folder for the CSV file and the figure (default: demo)")
    parser.add_argument("--keep-running", action="store_true",
                        help="keep the simulator and the nodes running until Ctrl-C")
    parser.add_argument("--view", action="store_true",
                        help="show the robot in the browser; implies --keep-running, so that the page remains")
    options = parser.parse_args(arguments)
    options.keep_running |= options.view
    for name, low, high in (("threshold", 5.0, 100.0), ("speed", 0.01, 0.25)):
        value = getattr(options, name)
        if not low <= value <= high:
            parser.error(f"--{name} {value:g}: must be from {low:g} to {high:g}")
    if options.drop is None:
        options.drop = DROP.get(options.model, DEFAULT_DROP)
    if not 0.05 <= options.drop <= 0.6:
        parser.error(f"--drop {options.drop:g}: must be from 0.05 to 0.6")
    return options


def packages(options: argparse.Namespace) -> List[str]:
    """Returns the packages to build, with their dependencies. The experiment uses one command of the tutorials; the standard
    commands take a quarter of the build time, so they are built only when the nodes are to be used afterwards."""
    return (["ur_ros_rtde_tutorials", "ur_simulator"] + ["ur_ros_rtde_commands"] * options.keep_running
            + [viewer.PACKAGE] * options.view)


def check(options: argparse.Namespace) -> None:
    """Raises Failure if the output folder cannot be written or the address is in use."""
    try:
        options.output.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=options.output).close()  # a permission check would miss a read-only or full disk
    except OSError as error:
        raise console.Failure(f"--output {options.output}: the folder cannot be written: {error.strerror}") from None
    ports.check(options.address)


def _name(model: str) -> str:
    """Returns the name that UR gives to a model: UR10e."""
    return model.upper().replace("E", "e")


def _start(programs: Programs, layout: Layout, options: argparse.Namespace) -> None:
    env = run_environment(layout)
    console.step(f"Starting the simulated controller of a {_name(options.model)} at {options.address}")
    simulation.start_simulator(programs, layout, env, options.address, options.model)
    console.step("Starting the nodes " + ", ".join(simulation.NODES))
    for node in simulation.NODES:
        simulation.start_node(programs, layout, env, node, options.address, *PARAMETERS.get(node, ()))
    if options.view:
        console.step("Starting the viewer")
        page = viewer.start(programs, layout, env, "--control", "--recordings", str(options.output))
        viewer.show_page(programs, page, PAGE_TIMEOUT)


def _experiment(programs: Programs, layout: Layout, options: argparse.Namespace) -> int:
    console.step("move_down_until_force")
    command = [layout.python, ROOT / "demo" / "force_experiment.py", "--address", options.address, "--model",
               _name(options.model), "--threshold", options.threshold, "--speed", options.speed,
               "--drop", options.drop, "--output", options.output]
    return programs.run([str(part) for part in command], run_environment(layout), limit=300.0, how=QUIETLY)


def _keep_running(programs: Programs, options: argparse.Namespace) -> None:
    console.line(f"The simulator ({options.address}) and the nodes run until Ctrl-C. To use them, open another terminal: ./ur shell")
    while True:
        programs.check()
        time.sleep(0.2)


def run(options: argparse.Namespace, layout: Layout) -> int:
    logs = layout.log / "demo"
    with Programs(logs) as programs:
        _start(programs, layout, options)
        code = _experiment(programs, layout, options)
        if code != 0:
            console.line(f"The demo failed. Logs of the simulator and the nodes: {logs}")
        elif options.keep_running:
            _keep_running(programs, options)
    return code


if __name__ == "__main__":
    sys.exit(simulation.main(parse, run, check))
