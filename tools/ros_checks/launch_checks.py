#!/usr/bin/env python3
"""Checks the launch files and the `ros2` commands of the documentation with the launch and ros2cli of a ROS 2 installation.
The packages of this repository must be built and sourced; see docs/internals/testing.md.

    tools/ros_checks/launch_checks.py                        # uses launch and ros2cli of the sourced ROS 2
    tools/ros_checks/launch_checks.py --prefix <folder>      # uses those of another prefix, as with the wheels
    tools/ros_checks/launch_checks.py -k two_robots          # passes other arguments to pytest
"""

import argparse
import os
import pathlib
import shutil
import sys

HERE = pathlib.Path(__file__).resolve().parent
LAYOUT = {"PATH": "bin", "LD_LIBRARY_PATH": "lib", "AMENT_PREFIX_PATH": "",
          "PYTHONPATH": f"lib/python3.{sys.version_info.minor}/site-packages"}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--prefix", type=pathlib.Path, action="append", default=[],
                        help="an installation that is not sourced; may be repeated")
    options, for_pytest = parser.parse_known_args()
    for prefix in options.prefix:
        if not prefix.is_dir():
            parser.error(f"--prefix {prefix}: there is no such folder")
        for variable, folder in LAYOUT.items():
            os.environ[variable] = os.pathsep.join(filter(None, [str(prefix.resolve() / folder).rstrip("/"),
                                                                 os.environ.get(variable, "")]))
    if not shutil.which("ros2"):
        parser.error("ros2 is not in PATH: source a ROS 2 installation, or give one with --prefix")
    os.environ["PYTHONDONTWRITEBYTECODE"] = "1"
    os.execvp(sys.executable, [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-v", str(HERE / "launch"), *for_pytest])


if __name__ == "__main__":
    main()
