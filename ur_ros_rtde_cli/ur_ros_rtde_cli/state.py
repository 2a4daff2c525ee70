"""Shows the state of the robot, once or continuously."""

import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--watch", action="store_true", help="update until Ctrl-C (on a terminal: the whole screen)")
    parser.add_argument("--json", action="store_true", help="print the newest message of each topic as JSON, one object per line")
    parser.add_argument("--wait", type=float, default=5.0, metavar="S", help="time to wait for the first message (default: 5 s)")


def run(options: argparse.Namespace) -> int:
    from .session import session  # imported here because --help does not need ROS
    with session(options.namespace) as created:
        from .print_state import print_state  # imported here because the node discovers the publishers in the meantime
        return print_state(created, options)
