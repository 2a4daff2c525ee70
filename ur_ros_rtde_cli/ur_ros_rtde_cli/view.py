"""Starts the viewer, which is a program of ur_ros_rtde_viewer."""

import argparse
import contextlib
import importlib
import os
import pathlib
from typing import List, Optional

from .errors import CliError


def find_viewer() -> Optional[pathlib.Path]:
    """Returns the program of ur_ros_rtde_viewer. That package depends on this one, so it need not be installed."""
    prefixes = filter(None, os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep))
    candidates = (pathlib.Path(prefix, "lib", "ur_ros_rtde_viewer", "view") for prefix in prefixes)
    return next((candidate for candidate in candidates if candidate.is_file()), None)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds the options of the viewer, if it is installed, for completion."""
    with contextlib.suppress(ImportError):
        importlib.import_module("ur_ros_rtde_viewer.arguments").add_arguments(parser)


def execute(arguments: List[str]) -> None:
    """Replaces this process by the viewer."""
    viewer = find_viewer()
    if viewer is None:
        raise CliError("the package ur_ros_rtde_viewer is not installed: build it in this workspace, and `pip install viser`")
    os.execv(viewer, [str(viewer), *arguments])
