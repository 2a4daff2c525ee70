"""Starts the viewer, which is a program of ur_ros_rtde_viewer."""

import os
import pathlib
from typing import List, Optional

from .errors import CliError


def find_viewer() -> Optional[pathlib.Path]:
    """Returns the program of ur_ros_rtde_viewer. The package depends on this one, so it need not be installed."""
    from ament_index_python import PackageNotFoundError, get_package_prefix  # imported here because --help does not need ROS
    try:
        return pathlib.Path(get_package_prefix("ur_ros_rtde_viewer"), "lib", "ur_ros_rtde_viewer", "view")
    except PackageNotFoundError:
        return None


def execute(arguments: List[str]) -> None:
    """Replaces this process by the viewer."""
    viewer = find_viewer()
    if viewer is None:
        raise CliError("the package ur_ros_rtde_viewer is not installed: build it in this workspace, and `pip install viser`")
    os.execv(viewer, [str(viewer), *arguments])
