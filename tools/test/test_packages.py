import os

import pytest
from ur_tools import packages


def make_package(root, name, *depends):
    folder = root / name
    folder.mkdir()
    (folder / "CMakeLists.txt").write_text("")
    wanted = "".join(f"<depend>{other}</depend>" for other in depends)
    (folder / "package.xml").write_text(f"<package><name>{name}</name>{wanted}</package>")
    return folder


def test_packages_follow_their_dependencies(tmp_path):
    make_package(tmp_path, "a_driver", "z_messages", "rcl")
    make_package(tmp_path, "z_messages")
    assert list(packages.discover(tmp_path)) == ["z_messages", "a_driver"]


def test_a_folder_without_a_build_file_is_not_a_package(tmp_path):
    (make_package(tmp_path, "unfinished") / "CMakeLists.txt").unlink()
    assert packages.discover(tmp_path) == {}


def test_a_dependency_cycle_is_reported(tmp_path):
    make_package(tmp_path, "a", "b")
    make_package(tmp_path, "b", "a")
    with pytest.raises(ValueError, match="a -> b -> a"):
        packages.discover(tmp_path)


def test_selecting_a_package_includes_exactly_its_dependencies(tmp_path):
    make_package(tmp_path, "driver", "messages")
    make_package(tmp_path, "messages")
    make_package(tmp_path, "simulator")
    found = packages.discover(tmp_path)
    assert list(packages.with_dependencies(found, ["driver"])) == ["messages", "driver"]


def test_an_unknown_package_is_rejected_with_the_known_ones(tmp_path):
    make_package(tmp_path, "driver")
    with pytest.raises(KeyError, match="no package drivr; there are: driver"):
        packages.with_dependencies(packages.discover(tmp_path), ["drivr"])


def test_the_state_changes_with_a_written_an_added_and_a_removed_file(tmp_path):
    folder = make_package(tmp_path, "driver")
    package = packages.discover(tmp_path)["driver"]
    states = [packages.state(package)]
    (folder / "CMakeLists.txt").write_text("project(driver)")
    states.append(packages.state(package))
    (folder / "new.cpp").write_text("")
    states.append(packages.state(package))
    os.remove(folder / "new.cpp")
    assert packages.state(package) == states[1]
    assert len(set(states)) == 3


def test_compiled_python_files_do_not_change_the_state(tmp_path):
    folder = make_package(tmp_path, "driver")
    package = packages.discover(tmp_path)["driver"]
    before = packages.state(package)
    (folder / "__pycache__").mkdir()
    (folder / "__pycache__" / "x.pyc").write_text("")
    assert packages.state(package) == before
