"""Include directives between the directories of a package point in one direction."""

import pathlib
import re

import pytest
from ur_tools.layout import ROOT

BACKGROUND = True

# From the top down: a directory may include headers of the directories after it. Headers in the package's own folder are free.
DIRECTORIES = {
    "rcl_cxx": ("action", "services", "topics", "executor", "node", "parameters", "context", "events", "rcl_support"),
    "ur_ros_rtde": ("programs", "process", "nodes", "recording", "teleoperation", "state", "diagnostics", "plugins", "streaming",
                    "goals", "frames", "detail"),
    "ur_ros_rtde_robot": ("program", "motion", "state", "connection", "script"),
    "ur_ros_rtde_trajectory": ("kinematics", "trajectory", "timing", "solver", "motion", "path"),
    "ur_simulator": ("app", "library", "controller", "world_file", "control_port", "urcap", "primary", "modbus", "robot_api", "dashboard",
                     "polyscope", "rtde", "net", "client_log", "log", "script_api", "port_map", "urscript", "safety", "world", "motion",
                     "dynamics", "kinematics", "state", "version", "common"),
}
INCLUDE = re.compile(r'^#include "([^"]+)"', re.M)


def directory(path, package):
    """Returns the directory of a file in src or in include/<package>, or None for a file that is in no directory."""
    parts = [part for part in pathlib.PurePath(path).parts if part not in ("src", "include", package)]
    return parts[0] if len(parts) > 1 else None


def upward_includes(package, order):
    folder = ROOT / package
    for file in sorted(path for root in ("src", "include") for path in (folder / root).rglob("*.[ch]pp")):
        source = directory(file.relative_to(folder), package)
        for header in INCLUDE.findall(file.read_text()):
            target = directory(header, package)
            if source in order and target in order and order.index(target) < order.index(source):
                yield f"{file.relative_to(ROOT)} includes {header}"


def test_directories_include_only_those_below_them():
    upward = [line for package, order in DIRECTORIES.items() for line in upward_includes(package, order)]
    assert not upward, "\n".join(upward)


def test_each_directory_has_a_place():
    def folders(package):
        return {path.name for root in (ROOT / package / "src", ROOT / package / "include" / package) for path in root.iterdir()
                if any(path.rglob("*.[ch]pp"))}

    misplaced = {package: folders(package) ^ set(order) for package, order in DIRECTORIES.items() if folders(package) != set(order)}
    assert not misplaced


def includes(file):
    return re.findall(r'#include ["<]([^">]+)[">]', file.read_text())


@pytest.mark.parametrize("package", ["rcl_cxx", "ur_ros_rtde_robot"])
def test_a_public_header_is_used_by_another_package(package):
    """Directly, or by such a header. All others belong to src."""
    folder = ROOT / package / "include"
    used = {name for file in ROOT.glob("*/**/*.[ch]pp") if file.relative_to(ROOT).parts[0] != package for name in includes(file)}
    new = used
    while new:
        new = {name for header in new if (folder / header).is_file() for name in includes(folder / header)} - used
        used |= new
    assert {str(header.relative_to(folder)) for header in folder.rglob("*.hpp")} - used == set()
