"""Arguments of `ur`."""

import argparse
import os
import signal
import sys
from typing import List, Optional

from . import call, fastdds_profile, plugins, record, state
from .problem import Problem
from .session import Interrupted

DESCRIPTION = """\
Calls the actions of ur_ros_rtde, shows the robot's state, lists the plugins, records. Ends with 0 when what was asked for has
been done, 1 when it failed, 2 when it was refused or cannot be meant, 128 plus its number when a signal ended it.
"""


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="ur", description=DESCRIPTION, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", metavar="command", required=True)
    for module in (call, state, plugins, record):
        name = module.__name__.rpartition(".")[2]
        text = module.__doc__.splitlines()[0]
        sub = commands.add_parser(name, help=text[0].lower() + text[1:].rstrip("."), description=module.__doc__,
                                  formatter_class=argparse.RawDescriptionHelpFormatter)
        sub.add_argument("--namespace", default="", metavar="NS", help="of the robot's nodes (default: none)")
        module.add_arguments(sub)
        sub.set_defaults(run=module.run)
    return parser


def main(arguments: Optional[List[str]] = None) -> int:
    options = _parser().parse_args(arguments)
    fastdds_profile.use()
    try:
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
        _drop_what_cannot_be_written()


def _drop_what_cannot_be_written() -> None:
    """Otherwise Python tries again when it ends, and reports that."""
    for stream in filter(None, (sys.stdout, sys.stderr)):
        try:
            stream.flush()
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
