"""The program: checks the options, starts server and nodes, and runs the viewer until a signal."""

import argparse
import contextlib
import logging
from typing import List, Optional

from ur_ros_rtde_cli import output

from .arguments import DESCRIPTION, add_arguments, robots
from .errors import ViewerError

VISER = "1.1."  # the versions whose internal classes `page` uses
INSTALL = "pip install viser==1.1.1"


def _check(options: argparse.Namespace) -> None:
    try:
        import viser
    except ImportError as error:
        raise ViewerError(f"The viewer needs the Python package viser: {error}. Install it: `{INSTALL}`") from None
    if not viser.__version__.startswith(VISER):
        raise ViewerError(f"viser {viser.__version__} is installed, but the viewer needs {VISER}: `{INSTALL}`")
    from ur_ros_rtde_description.errors import DescriptionError

    from .scene.robot_scene import urdf_of
    from .scene.urdf import read_description

    try:
        found = robots(options)
        for robot in found:
            if robot.model:
                read_description(urdf_of(robot, robot.model))
    except (DescriptionError, ValueError) as error:
        raise ViewerError(str(error)) from None
    if options.plan and not found[0].model:
        raise ViewerError("--plan needs the model of the arm: add --model, for example --model ur10e")


def _serve(options: argparse.Namespace) -> None:
    from ur_ros_rtde_cli import fastdds_profile
    from ur_ros_rtde_cli.interruptions import PendingInterruption

    from .page.server import new_token, start_server, stop_server, url

    token = new_token(options.address) if options.token is None else "" if options.token == "none" else options.token
    server = start_server(options.address, options.port, token, options.dark)
    fastdds_profile.use()
    from .ros.nodes import Nodes
    from .viewer import Viewer
    interruption = PendingInterruption()
    with contextlib.ExitStack() as ending:
        ending.callback(interruption.restore_handlers)
        ending.callback(stop_server, server)
        nodes = Nodes()
        ending.callback(nodes.close)
        viewer = Viewer(server, nodes, options)
        ending.callback(viewer.close, lambda: interruption.is_pending)  # by a second signal
        server.on_client_connect(lambda _client: print("A browser shows the page.", flush=True))
        print(f"The viewer runs at {url(server, token)} until Ctrl-C.", flush=True)
        viewer.run(lambda: interruption.take() is not None)


def run(options: argparse.Namespace) -> int:
    logging.basicConfig(format="%(levelname)s: %(message)s", level=logging.INFO)
    logging.getLogger("websockets").setLevel(logging.WARNING)
    _check(options)
    _serve(options)
    return 0


def parse(arguments: Optional[List[str]]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="ur view", description=DESCRIPTION, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_arguments(parser)
    return parser.parse_args(arguments)


def main(arguments: Optional[List[str]] = None) -> int:
    return output.run(lambda: run(parse(arguments)))
