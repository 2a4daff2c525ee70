"""ur_rtde_vendor: the source archive of ur_rtde, its verification and the error messages."""

import pathlib
import subprocess
import tarfile

import pytest
from ur_tools.downloads import ur_rtde_archive
from ur_tools.layout import ROOT

BACKGROUND = True
VENDOR = ROOT / "ur_rtde_vendor"
PROJECT = f"""
cmake_minimum_required(VERSION 3.18)
project(sources NONE)
include({VENDOR}/cmake/source_archive.cmake)
include({VENDOR}/cmake/patched_source.cmake)
source_archive(URL archive)
patched_source("${{archive}}" {VENDOR}/sources.sha256 {VENDOR}/patches source)
message(STATUS "sources in ${{source}}")
"""


@pytest.fixture
def configure(tmp_path):
    def run(archive="", url="file:///nowhere/ur_rtde-v1.6.5.tar.gz"):
        (tmp_path / "CMakeLists.txt").write_text(PROJECT.replace("URL", url))
        result = subprocess.run(["cmake", "-S", tmp_path, "-B", tmp_path / "build", f"-DUR_RTDE_ARCHIVE={archive}"],
                                capture_output=True, text=True, timeout=300)
        return result.returncode, " ".join((result.stdout + result.stderr).split())

    return run


@pytest.fixture(scope="module")
def unpacked(tmp_path_factory):
    folder = tmp_path_factory.mktemp("archive")
    with tarfile.open(ur_rtde_archive()) as archive:
        archive.extractall(folder)
    return next(folder.iterdir())


def pack(unpacked: pathlib.Path, archive: pathlib.Path, root: str, leave_out=()) -> pathlib.Path:
    with tarfile.open(archive, "w:xz") as file:
        for name in ("LICENSE", "include", "scripts", "src"):
            file.add(unpacked / name, f"{root}/{name}", filter=lambda entry: None if entry.name.endswith(leave_out) else entry)
    return archive


def test_an_archive_with_another_layout_is_accepted(configure, unpacked, tmp_path):
    code, printed = configure(pack(unpacked, tmp_path / "ur_rtde-v1.6.5.tar.xz", "ur_rtde-v1.6.5", ("tcp_socket.cpp",)))
    assert code == 0, printed
    sources = tmp_path / "build" / "source" / "ur_rtde"
    assert (sources / "scripts" / "rtde_control.script").is_file()
    assert not (sources / "src" / "rtde_python_bindings.cpp").exists()  # unverified files are not used


def test_an_archive_is_downloaded_once(configure, unpacked, tmp_path):
    packed = pack(unpacked, tmp_path / "ur_rtde-v1.6.5.tar.xz", "ur_rtde-v1.6.5")
    url = packed.as_uri()
    assert configure(url=url)[0] == 0
    packed.unlink()
    assert configure(url=url)[0] == 0


def test_a_changed_file_is_reported(configure, unpacked, tmp_path):
    changed = tmp_path / "changed"
    subprocess.run(["cp", "-r", unpacked, changed], check=True)
    with (changed / "src" / "rtde.cpp").open("a") as file:
        file.write("\n")
    code, printed = configure(pack(changed, tmp_path / "changed.tar.xz", "ur_rtde-1.6.5"))
    assert code != 0
    assert "the SHA-256 of src/rtde.cpp is" in printed
    assert "UR_RTDE_ARCHIVE=<path>" in printed


def test_a_missing_file_is_reported(configure, unpacked, tmp_path):
    code, printed = configure(pack(unpacked, tmp_path / "part.tar.xz", "ur_rtde-1.6.5", ("rtde.cpp",)))
    assert code != 0
    assert "it has no src/rtde.cpp" in printed


def test_a_file_that_is_not_an_archive_is_reported(configure, tmp_path):
    (tmp_path / "page.tar.gz").write_text("<html>sign in</html>")
    code, printed = configure(tmp_path / "page.tar.gz")
    assert code != 0
    assert "page.tar.gz is not an archive with ur_rtde's sources" in printed


def test_a_missing_archive_is_reported(configure):
    code, printed = configure("/nowhere/ur_rtde.tar.gz")
    assert code != 0
    assert "it is `/nowhere/ur_rtde.tar.gz`, and there is no such file" in printed


def test_a_failed_download_is_reported(configure):
    code, printed = configure()
    assert code != 0
    assert "cannot be downloaded from file:///nowhere/ur_rtde-v1.6.5.tar.gz" in printed
    assert "-DUR_RTDE_ARCHIVE=<path>" in printed
