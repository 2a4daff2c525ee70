"""Entry point and arguments of `ur`."""

import argparse
import difflib
import importlib
import os
import pathlib
import sys
from typing import Any, List, Optional

from . import output
from .errors import CliError

COMMANDS = {"call": "send a goal, show its feedback and print its result",
            "state": "show the state of the robot, once or continuously",
            "plugins": "list the installed plugins with package and description",
            "record": "record RTDE outputs of the robot to a CSV file",
            "plot": "draw a recording",
            "compare": "compare two recordings and draw both",
            "urdf": "print the URDF of an arm",
            "calibration": "save the calibration of an arm for its URDF",
            "new": "create a package with a plugin: a command, a dashboard command or an extension",
            "doctor": "check a robot over the network: ur doctor --robot ADDRESS",
            "completion": "print what lets bash or zsh complete command lines",
            "view": "show robots in the browser"}
VIEW = "view"  # a program of another package, with options of its own
# Commands that communicate with no node.
WITHOUT_NODES = ("plugins", "plot", "compare", "urdf", "calibration", "new", "doctor", "completion")

# Commands of the script `ur` in a checkout. They are not installed.
CHECKOUT_COMMANDS = ("demo", "test", "build", "sim", "bench", "plan", "chaos", "fuzz", "shell", "docs", "format", "lint",
                     "lock", "sbom", "doctor", "clean")

# argcomplete sets it when a shell asks for completions.
COMPLETION_VARIABLE = "_ARGCOMPLETE"

# Environment variable with the folder of the checkout, set in its shell.
CHECKOUT_VARIABLE = "UR_CHECKOUT"

DESCRIPTION = """\
Calls actions of ur_ros_rtde, shows, records and draws the state of the robot, lists the plugins, prints URDFs,
checks robots and reads their calibration.

Exit code: 0 success, 1 failure, 2 goal rejected or wrong arguments, 128 plus the signal number after a signal.
"""
EPILOG = f"""\
{', '.join(CHECKOUT_COMMANDS)} need the sources. Run them with `./ur` in a checkout of
ur_ros_rtde, or with `ur` in its `./ur shell`.
"""


class _ShowVersion(argparse.Action):
    """Reads the version of the installed package only if it is asked for."""

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        from .version import version_line  # imported here because nothing else needs it
        print(version_line())
        parser.exit()


def _make_parser() -> argparse.ArgumentParser:
    """Returns the parser for `ur --help`."""
    parser = argparse.ArgumentParser(prog="ur", description=DESCRIPTION, epilog=EPILOG,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--version", action=_ShowVersion, nargs=0, help="show the version of the driver")
    commands = parser.add_subparsers(metavar="command", required=True)
    for name, text in COMMANDS.items():
        commands.add_parser(name, help=text)
    return parser


def _add_arguments(command: str, parser: argparse.ArgumentParser) -> None:
    """Imports only the module of this command, because other modules would delay the start."""
    module = importlib.import_module(f"{__package__}.{command}")
    parser.description, parser.formatter_class = module.__doc__, argparse.RawDescriptionHelpFormatter
    if command not in WITHOUT_NODES:
        from . import namespaces  # imported here because the other commands do not need it
        parser.add_argument("--namespace", default="", type=namespaces.valid, metavar="NS",
                            help="namespace of the nodes of the robot (default: none)")
    module.add_arguments(parser)
    parser.set_defaults(run=module.run)


def _parse_arguments(command: str, arguments: List[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog=f"ur {command}")
    parser.add_argument("--version", action=_ShowVersion, nargs=0, help=argparse.SUPPRESS)
    _add_arguments(command, parser)
    return parser.parse_intermixed_args(arguments)


def _complete() -> None:
    """Answers a shell that completes a command line, and exits."""
    from . import completion, view  # imported here, like argcomplete, because only shells need them
    parser = argparse.ArgumentParser(prog="ur")
    parser.add_argument("--version", action=_ShowVersion, nargs=0)
    commands = parser.add_subparsers()
    for name in COMMANDS:
        command = commands.add_parser(name)
        if name == VIEW:
            view.add_arguments(command)
        else:
            _add_arguments(name, command)
    if _checkout_script() is not None:
        for name in CHECKOUT_COMMANDS:
            if name not in COMMANDS:
                commands.add_parser(name)
    completion.complete(parser)


def _unknown_command(command: str) -> CliError:
    if command in CHECKOUT_COMMANDS:
        return CliError(f"`ur {command}` needs the sources: run `./ur {command}` in a checkout of ur_ros_rtde, or "
                        f"`ur {command}` in its `./ur shell`")
    close = difflib.get_close_matches(command, (*COMMANDS, *CHECKOUT_COMMANDS), 1)
    return CliError(f"there is no command {command}" + (f"; did you mean {close[0]}?" if close else ".")
                    + f" The commands are: {', '.join(COMMANDS)}")


def _belongs_to_checkout(arguments: List[str]) -> bool:
    """Returns whether `./ur` runs this command. It installs what view needs; doctor without arguments checks the machine."""
    return not arguments or arguments[0] not in COMMANDS or arguments[0] == VIEW or arguments == ["doctor"]


def _checkout_script() -> Optional[pathlib.Path]:
    """Returns the script `ur` of the checkout if this is its shell."""
    folder = os.environ.get(CHECKOUT_VARIABLE)
    return pathlib.Path(folder, "ur") if folder and pathlib.Path(folder, "ur").is_file() else None


def main(arguments: Optional[List[str]] = None) -> int:
    arguments = sys.argv[1:] if arguments is None else arguments
    if COMPLETION_VARIABLE in os.environ:
        _complete()
    if _belongs_to_checkout(arguments) and _checkout_script() is not None:
        os.execv(str(_checkout_script()), [str(_checkout_script()), *arguments])
    return output.run(lambda: _run(arguments))


def _run(arguments: List[str]) -> int:
    if not arguments:
        _make_parser().print_help()
        return 2
    command = arguments[0]
    if command.startswith("-"):
        _make_parser().parse_args(arguments)
    if command not in COMMANDS:
        raise _unknown_command(command)
    if command == VIEW:
        from . import view  # imported here because the other commands do not need it
        view.execute(arguments[1:])
    options = _parse_arguments(command, arguments[1:])
    if command not in WITHOUT_NODES:
        from . import fastdds_profile, lazy_imports  # imported here because --help does not need ROS
        lazy_imports.enable()
        fastdds_profile.use()
    return options.run(options)
