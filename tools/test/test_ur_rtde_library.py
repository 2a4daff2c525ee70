"""The library of ur_rtde_vendor cannot be mixed up with another installation of ur_rtde, at build time and at run time."""

import pathlib
import subprocess

import pytest
from ur_tools.environment import workspace_environment
from ur_tools.layout import ROOT, SANITIZERS, Layout

BACKGROUND = True
SONAME = "libur_rtde_vendor.so.1.6"
LAYOUT = Layout.of_environment()
pytestmark = pytest.mark.skipif(LAYOUT.variant in SANITIZERS, reason="programs of others do not load the sanitizer")
HEADERS = LAYOUT.install / "include" / "ur_rtde_vendor"
PROJECT = """
cmake_minimum_required(VERSION 3.18)
project(consumer LANGUAGES CXX)
{before}
find_package(ur_rtde_vendor REQUIRED)
add_executable(consumer main.cpp)
target_link_libraries(consumer PRIVATE ur_rtde::rtde)
"""
MAIN = """
#include <ur_rtde/script_client.h>
int main()
{
  return ur_rtde::ScriptClient::getDefaultScript().empty() ? 1 : 0;
}
"""


def run(*command):
    result = subprocess.run([str(part) for part in command], env=workspace_environment(LAYOUT), capture_output=True, text=True,
                            timeout=300)
    return result.returncode, " ".join((result.stdout + result.stderr).split())


def dynamic_section(file):
    code, text = run("readelf", "--dynamic", "--wide", file)
    assert code == 0, text
    return text


def compile_only(source: pathlib.Path, *options):
    return run("g++", "-std=c++20", "-fsyntax-only", *options, source)


@pytest.fixture
def configure(tmp_path):
    def configure(before=""):
        (tmp_path / "CMakeLists.txt").write_text(PROJECT.format(before=before))
        (tmp_path / "main.cpp").write_text(MAIN)
        return run("cmake", "-S", tmp_path, "-B", tmp_path / "build")

    return configure


@pytest.fixture
def other_headers(tmp_path):
    """The headers of another ur_rtde that ur_ros_rtde includes."""
    folder = tmp_path / "other" / "ur_rtde"
    folder.mkdir(parents=True)
    for name in ("dashboard_client.h", "rtde_control_interface.h", "rtde_io_interface.h", "rtde_receive_interface.h"):
        (folder / name).touch()
    return folder.parent


def test_the_library_has_its_own_soname():
    assert f"Library soname: [{SONAME}]" in dynamic_section(LAYOUT.install / "lib" / "libur_rtde_vendor.so")


def test_a_consumer_builds_and_loads_this_library(configure, tmp_path):
    code, text = configure()
    assert code == 0, text
    code, text = run("cmake", "--build", tmp_path / "build")
    assert code == 0, text
    consumer = tmp_path / "build" / "consumer"
    assert f"Shared library: [{SONAME}]" in dynamic_section(consumer)
    code, text = run(consumer)
    assert code == 0, text


def test_a_target_of_another_installation_is_an_error(configure):
    code, text = configure("set(ur_rtde_DIR /opt/other/lib/cmake/ur_rtde)\nadd_library(ur_rtde::rtde SHARED IMPORTED)")
    assert code != 0
    assert "The target ur_rtde::rtde belongs to another installation of ur_rtde: /opt/other/lib/cmake/ur_rtde" in text
    assert "Remove find_package(ur_rtde)" in text


def test_finding_the_package_twice_succeeds(configure):
    code, text = configure("function(find_it)\n  find_package(ur_rtde_vendor REQUIRED)\nendfunction()\nfind_it()")
    assert code == 0, text


def test_the_headers_do_not_compile_without_the_library(tmp_path):
    source = tmp_path / "main.cpp"
    source.write_text(MAIN)
    code, text = compile_only(source, "-I", HEADERS)
    assert code != 0
    assert "this target does not link its library" in text
    assert "Find ur_rtde_vendor instead of ur_rtde, and link ur_rtde::rtde." in text


def test_ur_ros_rtde_does_not_compile_with_headers_of_another_installation(tmp_path, other_headers):
    source = tmp_path / "main.cpp"
    source.write_text("#include <ur_ros_rtde_robot/connection/interfaces.hpp>\n")
    code, text = compile_only(source, "-DUR_RTDE_VENDOR", "-I", other_headers, "-I", HEADERS,
                              "-I", ROOT / "ur_ros_rtde_robot" / "include", "-I", ROOT / "ur_ros_rtde_trajectory" / "include")
    assert code != 0
    assert "These are not the ur_rtde headers of ur_rtde_vendor. Remove find_package(ur_rtde) from this project." in text
