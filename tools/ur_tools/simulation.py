"""Shared by demo, bench, chaos and plan: starts a simulated controller and nodes, and runs such a command."""

import argparse
import sys
from typing import Callable, Dict, List, Sequence

from . import console
from .environment import program
from .layout import Layout
from .processes import Program, Programs

NODES = ("robot_state_receiver", "command_server", "dashboard_server")
MODELS = ("ur3", "ur5", "ur10", "ur3e", "ur5e", "ur7e", "ur10e", "ur12e", "ur16e", "ur8long", "ur15", "ur18", "ur20", "ur30")


OUTPUT_OPTIONS = ("--status", "--log", "--client-log", "--quiet", "--help", "-h")


def with_status(arguments: List[str], terminal: bool) -> List[str]:
    """On a terminal, the simulator shows its status unless the options select what it prints."""
    selected = any(argument.split("=")[0] in OUTPUT_OPTIONS for argument in arguments)
    return [*arguments, "--status"] if terminal and not selected else arguments


def start_simulator(programs: Programs, layout: Layout, env: Dict[str, str], address: str, model: str,
                    *arguments: str) -> Program:
    """Returns when the simulator reports that its ports listen. A connection attempt could reach another simulator."""
    simulator = programs.start("simulator", [str(program(layout, "ur_simulator", "ur_simulator")), "--address", address,
                                             "--model", model, *arguments], env)
    programs.wait_until(lambda: "ready: " in simulator.output, 10.0, "the simulator's ports")
    return simulator


def start_node(programs: Programs, layout: Layout, env: Dict[str, str], node: str, address: str, *parameters: str,
               debugged: Sequence[str] = ()) -> Program:
    """`debugged`: nodes whose debug messages are logged."""
    arguments = [argument for parameter in (f"robot_ip:={address}", *parameters) for argument in ("-p", parameter)]
    arguments += [argument for name in debugged for argument in ("--log-level", f"{name}:=debug")]
    return programs.start(node, [str(program(layout, "ur_ros_rtde", node)), "--ros-args", *arguments], env)


def main(parse: Callable[[List[str]], argparse.Namespace], run: Callable[[argparse.Namespace, Layout], int],
         check: Callable[[argparse.Namespace], None] = lambda _options: None) -> int:
    options = parse(sys.argv[1:])
    try:
        check(options)
        return run(options, Layout.of_environment())
    except console.Failure as failure:
        console.line(f"\n{failure}")
        return 1
    except OSError as error:
        console.line(f"\n{error.filename}: {error.strerror}" if error.filename else f"\n{error}")
        return 1
    except KeyboardInterrupt:
        console.line("\nStopped.")
        return 130
