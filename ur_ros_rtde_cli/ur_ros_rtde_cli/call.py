"""Sends a goal, shows its feedback and prints its result.

The goal is YAML, given as an argument or with --file as a file. Fields that are not given keep their defaults. nan and inf are
numbers. Fields and types are checked before `ur` waits for a server.

Feedback is printed to stderr: one line in place on a terminal, otherwise one line per second. The result is printed to stdout. With
--json, stdout has one JSON object per line: {"feedback": ...} for each message, then {"status": ..., "result": ...}, or
{"rejected": ...}.

Exit code: 0 success, 1 failure, no driver, or its end during the goal, 2 goal rejected or wrong arguments.

Ctrl-C, SIGTERM, SIGHUP and a closed output cancel the goal: the arm decelerates to standstill, the result is printed, and the exit
code is 128 plus the number of the signal.

    ur call move_j "{joint_positions: [0, -1.57, 1.57, -1.57, -1.57, 0], speed: 0.5}"
    ur call execute_trajectory --file path.yaml
    ur call dashboard/robot_mode
    ur call left/stop            to a driver in the namespace left, as with --namespace left
    ur call move_j --show        shows the fields of the goal, with units and ranges: a beginning for --file
"""

import argparse
import pathlib

from . import actions, completion, namespaces
from .errors import CliError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    action = parser.add_argument("action", help="name of the action, for example move_l or dashboard/power_on")
    goal = parser.add_argument("goal", nargs="?", help="fields of the goal in YAML (default: {})")
    action.completer, goal.completer = completion.action_names, completion.goal  # type: ignore[attr-defined]
    parser.add_argument("--file", type=pathlib.Path, metavar="FILE", help="read the goal from a YAML file")
    parser.add_argument("--wait", type=float, default=5.0, metavar="S", help="time to wait for the action server (default: 5 s)")
    parser.add_argument("--show", action="store_true", help="show the fields of the goal and their values; do not send the goal")
    parser.add_argument("--json", action="store_true", help="print feedback and result as JSON, one object per line")
    parser.add_argument("--quiet", action="store_true", help="do not show feedback")


def run(options: argparse.Namespace) -> int:
    if options.goal is not None and options.file is not None:
        raise CliError("give the goal as an argument or with --file, not both")
    try:
        options.namespace, options.action = actions.split_name(options.action, options.namespace)
        options.namespace = namespaces.valid(options.namespace)
    except argparse.ArgumentTypeError as error:
        raise CliError(str(error)) from None
    from .session import session  # imported here because --help does not need ROS
    with session(options.namespace) as created:
        from .send_goal import send_goal  # imported here because the node discovers the servers in the meantime
        return send_goal(created, options)
