"""Arguments of `ur`."""

import argparse
import difflib
import importlib
import os
import pathlib
import signal
import sys
from typing import List, Optional

from .interruptions import Interrupted
from .problem import Problem

COMMANDS = {"call": "send a goal, show its feedback and print its result",
            "state": "show the state of the robot, once or continuously",
            "plugins": "list the installed plugins: name, package, description",
            "record": "record fields of the robot's state into a CSV file"}

# Those of the script `ur` of a checkout, which are not installed.
CHECKOUT_COMMANDS = ("demo", "test", "build", "sim", "bench", "plan", "chaos", "shell", "new", "format", "lint", "doctor", "clean")

# Set in the shell of a checkout: its folder.
CHECKOUT_VARIABLE = "UR_CHECKOUT"

DESCRIPTION = """\
Calls the actions of ur_ros_rtde, shows the robot's state, lists the plugins, records. Exit code: 0 done, 1 failed, 2 refused
or not understood, 128 plus the number of the signal that ended it.
"""
EPILOG = f"""\
{', '.join(CHECKOUT_COMMANDS)} need the sources: they are commands of ./ur in a checkout of ur_ros_rtde, and of ur in its
`./ur shell`.
"""


def _parser() -> argparse.ArgumentParser:
    """For `ur --help`."""
    parser = argparse.ArgumentParser(prog="ur", description=DESCRIPTION, epilog=EPILOG,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(metavar="command", required=True)
    for name, text in COMMANDS.items():
        commands.add_parser(name, help=text)
    return parser


def _parse(command: str, arguments: List[str]) -> argparse.Namespace:
    """Imports only the module of the command: the others would delay its start."""
    module = importlib.import_module(f"{__package__}.{command}")
    parser = argparse.ArgumentParser(prog=f"ur {command}", description=module.__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    if command != "plugins":
        parser.add_argument("--namespace", default="", metavar="NS", help="of the robot's nodes (default: none)")
    module.add_arguments(parser)
    parser.set_defaults(run=module.run)
    return parser.parse_intermixed_args(arguments)


def _unknown(command: str) -> Problem:
    if command in CHECKOUT_COMMANDS:
        return Problem(f"`ur {command}` needs the sources: run `./ur {command}` in a checkout of ur_ros_rtde, or "
                       f"`ur {command}` in its `./ur shell`")
    close = difflib.get_close_matches(command, (*COMMANDS, *CHECKOUT_COMMANDS), 1)
    return Problem(f"there is no command {command}" + (f"; did you mean {close[0]}?" if close else "")
                   + f" The commands are: {', '.join(COMMANDS)}")


def _checkout() -> Optional[pathlib.Path]:
    """The script `ur` of the checkout whose shell this is."""
    folder = os.environ.get(CHECKOUT_VARIABLE)
    return pathlib.Path(folder, "ur") if folder and pathlib.Path(folder, "ur").is_file() else None


def main(arguments: Optional[List[str]] = None) -> int:
    arguments = sys.argv[1:] if arguments is None else arguments
    command = arguments[0] if arguments else ""
    if command not in COMMANDS and _checkout() is not None:
        os.execv(str(_checkout()), [str(_checkout()), *arguments])
    try:
        if not arguments:
            _parser().print_help()
            return 2
        if command.startswith("-"):
            _parser().parse_args(arguments)
        if command not in COMMANDS:
            raise _unknown(command)
        options = _parse(command, arguments[1:])
        if command != "plugins":
            from . import fastdds_profile, lazy_imports  # only here: --help needs no ROS
            lazy_imports.enable()
            fastdds_profile.use()
        return options.run(options)
    except Problem as problem:
        print(problem, file=sys.stderr)
        return 2
    except Interrupted as interrupted:
        return interrupted.exit_code
    except KeyboardInterrupt:
        return Interrupted(signal.SIGINT).exit_code
    except BrokenPipeError:
        return Interrupted(signal.SIGPIPE).exit_code
    finally:
        _drop_unwritable_output()


def _drop_unwritable_output() -> None:
    """Otherwise Python writes it again at exit and reports the failure."""
    for stream in filter(None, (sys.stdout, sys.stderr)):
        try:
            stream.flush()
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
