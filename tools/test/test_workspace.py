"""In a workspace, colcon and rosdep find exactly the packages of this checkout."""

import argparse
import pathlib

import pytest
from ament_index_python.packages import get_package_share_directory
from catkin_pkg.packages import find_packages
from colcon_core import package_discovery, package_identification
from ur_ros_rtde_cli import new
from ur_tools import git, packages
from ur_tools.layout import ROOT

BACKGROUND = True


@pytest.fixture(scope="module")
def workspace(tmp_path_factory):
    folder = tmp_path_factory.mktemp("workspace")
    git.copy_files(folder / "src" / "ur_ros_rtde")
    return folder


def colcon_list(folder):
    """Returns the names of the packages that `colcon build` finds in a folder."""
    parser = argparse.ArgumentParser()
    package_discovery.add_package_discovery_arguments(parser)
    found = package_discovery.discover_packages(parser.parse_args(["--base-paths", str(folder)]),
                                                package_identification.get_package_identification_extensions())
    return sorted(package.name for package in found)


def test_colcon_finds_exactly_the_packages(workspace):
    assert colcon_list(workspace) == sorted(packages.discover(ROOT))


def test_rosdep_finds_exactly_the_packages(workspace):
    found = find_packages(str(workspace / "src"))  # what `rosdep --from-paths src` calls
    assert sorted(package.name for package in found.values()) == sorted(packages.discover(ROOT))


def test_ros2_finds_the_packages_in_an_isolated_installation():
    """A workspace that was built without --merge-install. Each package has a hook that adds it to AMENT_PREFIX_PATH."""
    shares = [pathlib.Path(get_package_share_directory(name)) for name in packages.discover(ROOT)]
    hooks = [pathlib.Path("environment", "ament_prefix_path.dsv"), pathlib.Path("hook", "ament_prefix_path.dsv")]
    assert not [share for share in shares if not any((share / hook).is_file() for hook in hooks)]


def test_colcon_finds_packages_made_by_ur_new(tmp_path):
    for kind in new.KINDS:
        new.create(kind, "pick_part", "", tmp_path)
    assert colcon_list(tmp_path) == sorted(f"pick_part_{kind}" for kind in new.KINDS)
