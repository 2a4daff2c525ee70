"""Selects the Fast DDS profile of ur_ros_rtde for this process. Effective only before the first ROS context is created."""

import os
import pathlib

from ament_index_python import PackageNotFoundError, get_package_share_directory

# Fast DDS 3 and Fast DDS 2 read the profile file that an environment variable names and a file in the working directory.
# ur_ros_rtde installs only the file for the installed version.
SOURCES = (("FASTDDS_DEFAULT_PROFILES_FILE", "DEFAULT_FASTDDS_PROFILES.xml", "fastdds.xml"),
           ("FASTRTPS_DEFAULT_PROFILES_FILE", "DEFAULT_FASTRTPS_PROFILES.xml", "fastrtps.xml"))


def use() -> None:
    """Sets the environment variable, unless the user has a profile or ur_ros_rtde is not installed on this machine."""
    if any(variable in os.environ or pathlib.Path(local_file).exists() for variable, local_file, _ in SOURCES):
        return
    try:
        folder = pathlib.Path(get_package_share_directory("ur_ros_rtde"), "config")
    except PackageNotFoundError:
        return
    for variable, _, package_file in SOURCES:
        if (folder / package_file).exists():
            os.environ[variable] = str(folder / package_file)
