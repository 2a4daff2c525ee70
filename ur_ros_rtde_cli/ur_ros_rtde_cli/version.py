"""Version of the installed driver."""

import os
import pathlib
from xml.etree import ElementTree


def version_line() -> str:
    """Returns "ur_ros_rtde 1.2.3, ROS 2 kilted"."""
    from ament_index_python import get_package_share_directory  # imported here because --help does not need ROS
    description = pathlib.Path(get_package_share_directory("ur_ros_rtde_cli"), "package.xml").read_text()
    distribution = f", ROS 2 {os.environ['ROS_DISTRO']}" if "ROS_DISTRO" in os.environ else ""
    return f"ur_ros_rtde {ElementTree.fromstring(description).findtext('version')}{distribution}"
