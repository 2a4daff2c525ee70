"""What demo and bench share: a simulated controller, the three nodes, and how such a command starts and ends."""

import argparse
import socket
import sys
from typing import Callable, Dict, List

from . import say
from .environment import program
from .layout import Layout
from .processes import Program, Programs

NODES = ("robot_state_receiver", "command_server", "dashboard_server")
DASHBOARD_PORT = 29999


def _answers(address: str, port: int) -> bool:
    try:
        socket.create_connection((address, port), 0.2).close()
        return True
    except OSError:
        return False


def start_simulator(programs: Programs, layout: Layout, env: Dict[str, str], address: str, model: str,
                    *arguments: str) -> Program:
    """Returns when its ports listen."""
    simulator = programs.start("simulator", [program(layout, "ur_simulator", "ur_simulator"), "--address", address,
                                             "--model", model, *arguments], env)
    programs.wait_until(lambda: _answers(address, DASHBOARD_PORT), 10.0, "the simulator's ports")
    return simulator


def start_node(programs: Programs, layout: Layout, env: Dict[str, str], node: str, address: str, *parameters: str) -> Program:
    arguments = [argument for parameter in (f"robot_ip:={address}", *parameters) for argument in ("-p", parameter)]
    return programs.start(node, [program(layout, "ur_ros_rtde", node), "--ros-args", *arguments], env)


def main(parse: Callable[[List[str]], argparse.Namespace], run: Callable[[argparse.Namespace, Layout], int]) -> int:
    options = parse(sys.argv[1:])
    try:
        return run(options, Layout.of_environment())
    except say.Failure as failure:
        say.line(f"\n{failure}")
        return 1
    except KeyboardInterrupt:
        say.line("\nStopped.")
        return 130
