"""Shows the state of the robot, once or continuously."""

import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--watch", action="store_true", help="repeat until Ctrl-C")
    parser.add_argument("--wait", type=float, default=5.0, metavar="S", help="for the first sample (default: 5 s)")


def run(options: argparse.Namespace) -> int:
    from .session import session  # only here: --help needs no ROS
    with session(options.namespace) as created:
        from .print_state import print_state  # only now: meanwhile the node discovers the publishers
        return print_state(created, options)
