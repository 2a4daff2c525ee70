"""Sends a goal, shows its feedback and prints its result.

The goal is YAML: an argument or, with --file, a file. Fields that are not named have their defaults; nan and inf are numbers.
Fields and types are checked before anything waits for a server.

Feedback goes to stderr: rewritten in place on a terminal, otherwise one line a second. The result goes to stdout. Ctrl-C,
SIGTERM, SIGHUP and a closed output cancel the goal: the arm decelerates, then the result is printed, and the exit code is 128
plus the number of the signal.

    ur call move_j "{joint_positions: [0, -1.57, 1.57, -1.57, -1.57, 0], speed: 0.5}"
    ur call execute_trajectory --file path.yaml
    ur call dashboard/robot_mode
    ur call move_j --show        the fields of the goal
"""

import argparse
import pathlib

from .problem import Problem


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("action", help="its name: move_l, dashboard/power_on")
    parser.add_argument("goal", nargs="?", help="YAML (default: {})")
    parser.add_argument("--file", type=pathlib.Path, metavar="FILE", help="read the goal from a YAML file")
    parser.add_argument("--wait", type=float, default=5.0, metavar="S", help="for the action server (default: 5 s)")
    parser.add_argument("--show", action="store_true", help="show the fields of the goal with their values, and send nothing")
    parser.add_argument("--quiet", action="store_true", help="show no feedback")


def run(options: argparse.Namespace) -> int:
    if options.goal is not None and options.file is not None:
        raise Problem("give the goal as an argument or with --file, not both")
    from .session import session  # only here: --help needs no ROS
    with session(options.namespace) as created:
        from .send_goal import send_goal  # only now: meanwhile the node discovers the servers
        return send_goal(created, options)
