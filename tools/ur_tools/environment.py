"""The environment in which our programs, rclpy and our interfaces are found."""

import json
import os
import pathlib
import shutil
from typing import Dict, Iterable

from .downloads import ur_rtde_archive
from .layout import ROOT, Layout

# What another ROS installation may have left in the user's environment. rcl of the wheels ends with 102 if
# RMW_IMPLEMENTATION names anything else than the middleware it is linked with.
FOREIGN = ("RMW_IMPLEMENTATION", "ROS_DISTRO", "ROS_VERSION", "ROS_PYTHON_VERSION", "ROS_LOCALHOST_ONLY", "PYTHONHOME",
           "AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH", "COLCON_PREFIX_PATH", "COLCON_DEFAULTS_FILE", "PYTHONPATH", "LD_LIBRARY_PATH",
           "_ROS_WHEELS_BOOTSTRAP_COMPLETE", "UR_CHECKOUT")


def _path(*parts: object) -> str:
    return os.pathsep.join(str(part) for part in parts if part)


def _base(layout: Layout) -> Dict[str, str]:
    env = {name: value for name, value in os.environ.items() if name not in FOREIGN}
    env["VIRTUAL_ENV"] = str(layout.venv)
    env["PATH"] = _path(layout.venv / "bin", env.get("PATH", os.defpath))
    env["AMENT_PREFIX_PATH"] = str(layout.venv)
    env["ROS_WHEELS_PREFIX"] = str(layout.venv)
    return env


def build_environment(layout: Layout, jobs: int) -> Dict[str, str]:
    """For colcon and CMake: the wheels as the underlay."""
    env = _base(layout)
    env["ROS_DISTRO"] = layout.ros
    env["PYTHONPATH"] = str(layout.provider.parent / "generators")  # makes them fast
    env["UR_RTDE_ARCHIVE"] = str(ur_rtde_archive())
    env["CMAKE_BUILD_PARALLEL_LEVEL"] = str(jobs)
    env["MAKEFLAGS"] = f"-j{jobs}"  # keeps colcon from giving ninja a -j and a load limit of its own
    if shutil.which("ccache"):
        env.setdefault("CMAKE_CXX_COMPILER_LAUNCHER", "ccache")
        env.setdefault("CMAKE_C_COMPILER_LAUNCHER", "ccache")
    return env


def bundled_libraries(layout: Layout) -> Iterable[pathlib.Path]:
    return sorted(layout.site_packages(layout.venv).glob("ros_*.libs"))


def run_environment(layout: Layout) -> Dict[str, str]:
    """For programs and rclpy: our installation over the wheels.

    The wheels set LD_LIBRARY_PATH by starting Python a second time, in no certain order; it is all set here, and the
    guard variable keeps them from it.
    """
    env = _base(layout)
    env["ROS_DISTRO"] = layout.ros
    env["PATH"] = _path(layout.install / "bin", env["PATH"])
    env["AMENT_PREFIX_PATH"] = _path(layout.install, layout.venv)
    env["PYTHONPATH"] = str(layout.site_packages(layout.install))
    env["LD_LIBRARY_PATH"] = _path(layout.install / "lib", layout.venv / "lib", *bundled_libraries(layout))
    env["_ROS_WHEELS_BOOTSTRAP_COMPLETE"] = "1"
    # Everything runs on this machine; nothing is announced to the network unless the user asks for it.
    env.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    _set_fastdds_profile(env, layout)
    return env


def _set_fastdds_profile(env: Dict[str, str], layout: Layout) -> None:
    """For the user's programs: our own set it themselves. Only the profile for the installed version of Fast DDS is there."""
    profiles = {"FASTDDS_DEFAULT_PROFILES_FILE": "fastdds.xml", "FASTRTPS_DEFAULT_PROFILES_FILE": "fastrtps.xml"}
    if not any(variable in env for variable in profiles):
        for variable, name in profiles.items():
            file = layout.install / "share" / "ur_ros_rtde" / "config" / name
            if file.is_file():
                env[variable] = str(file)


def workspace_environment(layout: Layout) -> Dict[str, str]:
    """As run_environment(), with `ur` on PATH and the arguments that `colcon build` of a user's own workspace needs."""
    env = run_environment(layout)
    # For `ur` of ur_ros_rtde_cli, which hands the commands of the checkout to ./ur, and for that: with the same build.
    env["UR_CHECKOUT"] = str(ROOT)
    env["UR_LAYOUT"] = f"{layout.ros}:{layout.variant}"
    env["CMAKE_PREFIX_PATH"] = str(layout.install)
    env["PYTHONPATH"] = _path(env["PYTHONPATH"], layout.provider.parent / "generators")
    folders = [layout.install / "lib" / name for name in ("ur_ros_rtde", "ur_ros_rtde_cli")]
    env["PATH"] = _path(*folders, env["PATH"])  # the wheels have no `ros2 run`
    defaults = layout.base / "colcon_defaults.yaml"
    arguments = ["-GNinja", "-DCMAKE_BUILD_TYPE=Release", f"-DROS_WHEELS_PREFIX={layout.venv}",
                 f"-DCMAKE_PROJECT_TOP_LEVEL_INCLUDES={layout.provider}", "-Wno-unused-cli"]
    defaults.write_text(json.dumps({"build": {"cmake-args": arguments}}))
    env["COLCON_DEFAULTS_FILE"] = str(defaults)
    return env


def program(layout: Layout, package: str, name: str) -> pathlib.Path:
    """An installed executable: lib/<package>/<name> as ROS has it, or bin/<name>."""
    for candidate in (layout.install / "lib" / package / name, layout.install / "bin" / name):
        if candidate.is_file():
            return candidate
    raise FileNotFoundError(f"{name} of {package} is not in {layout.install}")
