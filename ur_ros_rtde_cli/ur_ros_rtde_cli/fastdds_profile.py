"""The Fast DDS profile of ur_ros_rtde, for a process that has not created a ROS context yet."""

import os
import pathlib

from ament_index_python import PackageNotFoundError, get_package_share_directory

# Where Fast DDS 3 and Fast DDS 2 look for profiles: the file that a variable names and one in the working directory. Of our
# own files the one for the installed version is installed.
SOURCES = (("FASTDDS_DEFAULT_PROFILES_FILE", "DEFAULT_FASTDDS_PROFILES.xml", "fastdds.xml"),
           ("FASTRTPS_DEFAULT_PROFILES_FILE", "DEFAULT_FASTRTPS_PROFILES.xml", "fastrtps.xml"))


def use() -> None:
    """Does nothing if the user has a profile, or if ur_ros_rtde is not installed on this machine."""
    if any(variable in os.environ or pathlib.Path(local_file).exists() for variable, local_file, _ in SOURCES):
        return
    try:
        folder = pathlib.Path(get_package_share_directory("ur_ros_rtde"), "config")
    except PackageNotFoundError:
        return
    for variable, _, package_file in SOURCES:
        if (folder / package_file).exists():
            os.environ[variable] = str(folder / package_file)
