import json
import pathlib
import types

import check_distributions as check
import pytest

PREFIX = pathlib.Path("/opt/wheels")
COMMAND = ('/usr/bin/c++ -DNAME=\\"x\\" -I/src/include -isystem /opt/wheels/include/rcl -isystem /install/include/my_msgs '
           "-isystem /usr/include/eigen3 -O3 -Wall -Winvalid-pch -include /build/cmake_pch.hxx -MD -MT a.o -MF a.o.d "
           "-o a.o -c /src/a.cpp")


class Headers:
    ros = {"rcl": types.SimpleNamespace(version="5.3.0")}

    def __init__(self, folder=pathlib.Path("/humble/rcl/include")):
        self._folder = folder

    def include_folders(self):
        return [self._folder]

    def replaces(self, folder):
        return folder.endswith("my_msgs")


def test_another_compiler_receives_the_options_of_the_build_and_writes_no_files():
    assert check.rewrite(COMMAND, "g++-11", PREFIX, None) == [
        "g++-11", "-fsyntax-only", "-Werror", '-DNAME="x"', "-I/src/include", "-isystem", "/opt/wheels/include/rcl", "-isystem",
        "/install/include/my_msgs", "-isystem", "/usr/include/eigen3", "-O3", "-Wall", "/src/a.cpp"]


def test_the_headers_of_the_distribution_replace_those_of_the_build():
    assert check.rewrite(COMMAND, "g++-11", PREFIX, Headers()) == [
        "g++-11", "-fsyntax-only", "-Werror", '-DNAME="x"', "-I/src/include", "-isystem", "/usr/include/eigen3", "-O3", "-Wall",
        "/src/a.cpp", "-isystem", "/humble/rcl/include"]


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A file that includes a ROS header, which exists in the build and in another distribution."""
    monkeypatch.setattr(check, "ROOT", tmp_path)
    for folder, text in (("wheels", "int old_name();"), ("rolling", "int new_name();")):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "ros.h").write_text(text)
    file = tmp_path / "a.cpp"
    file.write_text('#include "ros.h"\nint value() { return old_name(); }\n')
    build = tmp_path / ".ur" / "build"
    (build / "package").mkdir(parents=True)
    (build / "package" / "compile_commands.json").write_text(json.dumps([
        {"directory": str(tmp_path), "file": str(file), "command": f"c++ -isystem {tmp_path}/wheels/. -o a.o -c {file}"}]))
    return types.SimpleNamespace(build=build, prefix=tmp_path / "wheels", files="", jobs=1, rolling=tmp_path / "rolling")


def test_a_name_missing_in_the_distribution_is_an_error(project, capsys):
    assert check.check("c++", project, None) == 0
    assert check.check("c++", project, Headers(project.rolling)) == 1
    assert "old_name" in capsys.readouterr().out


def test_a_source_that_the_build_does_not_compile_by_itself_is_a_failure(project):
    source = project.rolling.parent / "package" / "src" / "b.cpp"
    source.parent.mkdir(parents=True)
    source.write_text("")
    with pytest.raises(SystemExit, match=r"does not compile 1 sources, among them .*b\.cpp: .*UNITY_BUILD=OFF"):
        check.check("c++", project, None)


def test_checking_no_file_is_a_failure(project):
    project.files = "no such file"
    assert check.check("c++", project, None) != 0
