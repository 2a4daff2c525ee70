"""./ur bench --recovery: how soon joint_states continues when links are closed, and when the controller or the node was restarted."""

import argparse
import shlex

from . import bench_session, console
from .environment import program
from .layout import Layout
from .processes import Programs


def add_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("recovery")
    group.add_argument("--recovery", action="store_true",
                       help="only measure how soon joint_states continues after interruptions (--repeat of each kind, about 2 min)")


def measure(layout: Layout, options: argparse.Namespace) -> "tuple[dict, dict]":
    """Returns figures and samples."""
    console.step("Measuring the recovery from interruptions, for about 2 min")
    simulator = [program(layout, "ur_simulator", "ur_simulator"), "--address", options.address, "--model", options.model]
    node = [program(layout, "ur_ros_rtde", "robot_state_receiver"), "--ros-args", "-p", f"robot_ip:={options.address}"]
    folder = bench_session.log_folder(layout, options.address)
    arguments = ["--address", options.address, "--repeat", str(options.repeat), "--logs", str(folder),
                 "--simulator", shlex.join(map(str, simulator)), "--node", shlex.join(map(str, node))]
    folder.mkdir(parents=True, exist_ok=True)
    with Programs(folder) as programs:
        found = bench_session.run_script(programs, layout, options, "measure_recovery.py", arguments, 60.0 + 10.0 * options.repeat)
    return found["figures"], found["samples"]
