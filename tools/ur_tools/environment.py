"""Environment variables with which our programs, rclpy and our interfaces are found."""

import json
import os
import pathlib
import shutil
from typing import Dict, Iterable

from . import git
from .downloads import ur_rtde_archive
from .layout import ROOT, Layout

OF_A_WORKSPACE = ("COLCON_DEFAULTS_FILE", "PYTHONHOME", "UR_CHECKOUT")
# Variables that another ROS installation may have set. The wheels' rcl exits with status 102 if RMW_IMPLEMENTATION names
# another middleware than the one it is linked with.
FOREIGN = ("RMW_IMPLEMENTATION", "ROS_DISTRO", "ROS_VERSION", "ROS_PYTHON_VERSION", "ROS_LOCALHOST_ONLY", "AMENT_PREFIX_PATH",
           "CMAKE_PREFIX_PATH", "COLCON_PREFIX_PATH", "PYTHONPATH", "LD_LIBRARY_PATH", "_ROS_WHEELS_BOOTSTRAP_COMPLETE", *OF_A_WORKSPACE)
# Prefixes of variables that select tests: those of the user's shell would also affect which tests a build finds.
OF_TESTS = ("GTEST_", "PYTEST_")

# The variable that selects a profile, with our profile, for Fast DDS 3 and Fast DDS 2.
FASTDDS_PROFILES = {"FASTDDS_DEFAULT_PROFILES_FILE": "fastdds.xml", "FASTRTPS_DEFAULT_PROFILES_FILE": "fastrtps.xml"}


def _path(*parts: object) -> str:
    return os.pathsep.join(str(part) for part in parts if part)


def _base(layout: Layout) -> Dict[str, str]:
    foreign = (*git.REPOSITORY_VARIABLES, *(OF_A_WORKSPACE if layout.is_installed else FOREIGN))
    env = {name: value for name, value in os.environ.items() if name not in foreign and not name.startswith(OF_TESTS)}
    env["VIRTUAL_ENV"] = str(layout.venv)
    env["PATH"] = _path(layout.venv / "bin", env.get("PATH", os.defpath))
    if not layout.is_installed:
        env["ROS_DISTRO"] = layout.ros
        env["AMENT_PREFIX_PATH"] = str(layout.venv)
        env["ROS_WHEELS_PREFIX"] = str(layout.venv)
    return env


def build_environment(layout: Layout, jobs: int) -> Dict[str, str]:
    """Returns the environment for colcon and CMake, with ROS as the underlay."""
    env = _base(layout)
    if not layout.is_installed:
        env["PYTHONPATH"] = str(layout.provider.parent / "generators")  # faster interface generators
    env["UR_RTDE_ARCHIVE"] = str(ur_rtde_archive())
    env["CMAKE_BUILD_PARALLEL_LEVEL"] = str(jobs)
    env["MAKEFLAGS"] = f"-j{jobs}"  # otherwise colcon passes its own -j and load limit to ninja
    if shutil.which("ccache"):
        env.setdefault("CMAKE_CXX_COMPILER_LAUNCHER", "ccache")
        env.setdefault("CMAKE_C_COMPILER_LAUNCHER", "ccache")
    return env


def bundled_libraries(layout: Layout) -> Iterable[pathlib.Path]:
    return sorted(layout.site_packages(layout.venv).glob("ros_*.libs"))


def run_environment(layout: Layout) -> Dict[str, str]:
    """Returns the environment for programs and rclpy, with our installation as an overlay of ROS.

    The wheels would set LD_LIBRARY_PATH, in an undefined order, and start Python again. It is set here instead, and
    _ROS_WHEELS_BOOTSTRAP_COMPLETE disables their bootstrap.
    """
    env = _base(layout)
    env["PATH"] = _path(layout.install / "bin", env["PATH"])
    env["AMENT_PREFIX_PATH"] = _path(layout.install, env["AMENT_PREFIX_PATH"])
    env["PYTHONPATH"] = _path(layout.site_packages(layout.install), env.get("PYTHONPATH"))
    if layout.is_installed:
        env["LD_LIBRARY_PATH"] = _path(layout.install / "lib", env.get("LD_LIBRARY_PATH"))
    else:
        env["LD_LIBRARY_PATH"] = _path(layout.install / "lib", layout.venv / "lib", *bundled_libraries(layout))
        env["_ROS_WHEELS_BOOTSTRAP_COMPLETE"] = "1"
    # Participants are announced to the network only if the user asks for it.
    env.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    if layout.distribution == "humble":  # does not know it
        env.setdefault("ROS_LOCALHOST_ONLY", "1")
    if not any(variable in env for variable in FASTDDS_PROFILES):
        env.update(fastdds_profile(layout))
    return env


def fastdds_profile(layout: Layout) -> Dict[str, str]:
    """Returns the variable with the Fast DDS profile for the user's programs; ours set it themselves."""
    folder = layout.install / "share" / "ur_ros_rtde" / "config"  # has the profile of the installed version
    return {variable: str(folder / name) for variable, name in FASTDDS_PROFILES.items() if (folder / name).is_file()}


def workspace_environment(layout: Layout) -> Dict[str, str]:
    """Returns run_environment() with `ur` on PATH. Writes nothing: `ur call stop` works on a full disk too."""
    env = run_environment(layout)
    # `ur` of ur_ros_rtde_cli passes the commands of the checkout to ./ur, which uses the same build.
    env["UR_CHECKOUT"] = str(ROOT)
    env["UR_LAYOUT"] = f"{layout.ros}:{layout.variant}"
    env["CMAKE_PREFIX_PATH"] = _path(layout.install, env.get("CMAKE_PREFIX_PATH"))
    folders = [layout.install / "lib" / name for name in ("ur_ros_rtde", "ur_ros_rtde_cli", "ur_ros_rtde_python")]
    env["PATH"] = _path(*folders, env["PATH"])  # the wheels have no `ros2 run`
    return env


def shell_environment(layout: Layout) -> Dict[str, str]:
    """Returns workspace_environment() with the arguments for `colcon build` in a user's own workspace."""
    env = workspace_environment(layout)
    if layout.is_installed:
        return env
    env["PYTHONPATH"] = _path(env["PYTHONPATH"], layout.provider.parent / "generators")
    arguments = ["-GNinja", "-DCMAKE_BUILD_TYPE=Release", f"-DROS_WHEELS_PREFIX={layout.venv}",
                 f"-DCMAKE_PROJECT_TOP_LEVEL_INCLUDES={layout.provider}", "-Wno-unused-cli"]
    defaults, text = layout.base / "colcon_defaults.yaml", json.dumps({"build": {"cmake-args": arguments}})
    if not (defaults.is_file() and defaults.read_text() == text):
        defaults.write_text(text)
    env["COLCON_DEFAULTS_FILE"] = str(defaults)
    return env


def program(layout: Layout, package: str, name: str) -> pathlib.Path:
    """Returns the path of an installed executable: lib/<package>/<name>, or bin/<name>."""
    for candidate in (layout.install / "lib" / package / name, layout.install / "bin" / name):
        if candidate.is_file():
            return candidate
    raise FileNotFoundError(f"{name} of {package} is not in {layout.install}")
