#!/usr/bin/env python3
"""Builds the checks in rclcpp/ against an installed ROS 2 and runs them on the installed driver and simulator.

Source the installation first (`source install/setup.bash`); --prefix adds installations on top of it. Arguments after `--` are
passed to the checks, which use GoogleTest: `-- --gtest_filter=ActionCheck.*`.
"""

import argparse
import os
import pathlib
import subprocess
import sys
import tempfile
from typing import List

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "ur_ros_rtde_commands" / "test" / "system"))

SOURCES = pathlib.Path(__file__).parent / "rclcpp"
PACKAGES = {"rclcpp_action": "share/rclcpp_action", "ur_ros_rtde": "share/ur_ros_rtde", "ur_simulator": "share/ur_simulator"}


def overlay(prefixes: List[pathlib.Path]) -> None:
    """Adds the installations to the environment, before those that are sourced."""
    for prefix in reversed(prefixes):
        python = f"lib/python{sys.version_info.major}.{sys.version_info.minor}/site-packages"
        for name, folder in (("AMENT_PREFIX_PATH", ""), ("CMAKE_PREFIX_PATH", ""), ("LD_LIBRARY_PATH", "lib"), ("PYTHONPATH", python)):
            os.environ[name] = os.pathsep.join(part for part in (str(prefix / folder), os.environ.get(name)) if part)


def missing_packages() -> List[str]:
    prefixes = [pathlib.Path(prefix) for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)]
    return [name for name, path in PACKAGES.items() if not any((prefix / path).is_dir() for prefix in prefixes)]


def build(folder: pathlib.Path) -> pathlib.Path:
    arguments = ["-DCMAKE_BUILD_TYPE=None", "-DCMAKE_CXX_FLAGS=-O0"]
    if "ROS_WHEELS_PREFIX" in os.environ:
        arguments.append(f"-DCMAKE_PROJECT_TOP_LEVEL_INCLUDES={ROOT / 'wheels' / 'provider.cmake'}")
    subprocess.run(["cmake", "-S", SOURCES, "-B", folder, *arguments], check=True)
    subprocess.run(["cmake", "--build", folder, "--parallel", "2"], check=True)
    return folder / "rclcpp_checks"


def run(checks: pathlib.Path, arguments: List[str], driver_parameters: List[str]) -> int:
    from programs import Simulator, start_node
    from support import own_address  # in a ROS domain of its own

    simulator = Simulator(own_address())
    driver = start_node("driver", simulator.address, "ur_type:=ur10e", *driver_parameters)
    try:
        return subprocess.run([checks, *arguments]).returncode
    finally:
        driver.stop()
        simulator.stop()
        pathlib.Path(checks.parent, "driver.log").write_text(driver.output() + "\n")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--prefix", type=pathlib.Path, action="append", default=[],
                        help="an installation that is not sourced; may be repeated")
    parser.add_argument("--build", type=pathlib.Path,
                        help="build folder, which is kept and receives the driver's log (default: a temporary folder)")
    parser.add_argument("--driver", metavar="PARAMETER:=VALUE", action="append", default=[], help="parameter of the driver")
    parser.add_argument("checks", nargs="*", help="arguments of the checks")
    options = parser.parse_args()
    overlay([prefix.resolve() for prefix in options.prefix])
    if missing := missing_packages():
        parser.error(f"not in AMENT_PREFIX_PATH: {', '.join(missing)}; source the installation's setup.bash, or give it with --prefix")
    with tempfile.TemporaryDirectory() as temporary:
        checks = build(options.build or pathlib.Path(temporary))
        return run(checks, options.checks, options.driver)


if __name__ == "__main__":
    sys.exit(main())
