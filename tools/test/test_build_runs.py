"""./ur build with a fake colcon: in a path with spaces, interrupted and repeated, failing."""

import shutil
import subprocess
import sys

import pytest
from ur_tools import build, console, downloads, lock, system_packages, venv
from ur_tools.layout import ROOT, Layout
from ur_tools.packages import Package

# Like CMake, it keeps the compiler with which it has configured a build folder, and rejects a build folder of other sources.
COLCON = r"""
import os, pathlib, sys, time
arguments = sys.argv[1:]
value = lambda name: pathlib.Path(arguments[arguments.index(name) + 1])
log, build, install = value("--log-base"), value("--build-base"), value("--install-base")
names = arguments[arguments.index("--packages-select") + 1:arguments.index("--build-base")]
sources = {pathlib.Path(argument).name: argument for argument in arguments if pathlib.Path(argument, "package.xml").is_file()}
compiler, = (argument[2:].replace("=", ":STRING=", 1) for argument in arguments if argument.startswith("-DUR_COMPILER="))
with (log / "calls.txt").open("a") as file:
    print(*names, file=file)
(log / "open_files.txt").write_text(" ".join(str(link.resolve()) for link in pathlib.Path("/proc/self/fd").iterdir()))
for name in names:
    print("Starting >>>", name, flush=True)
    folder = log / "latest_build" / name
    folder.mkdir(parents=True, exist_ok=True)
    (build / name).mkdir(parents=True, exist_ok=True)
    cache, home = build / name / "CMakeCache.txt", "CMAKE_HOME_DIRECTORY:INTERNAL=" + sources[name]
    if not cache.exists():
        cache.write_text(f"{home}\n{compiler}\nCMAKE_CXX_COMPILER:FILEPATH={os.environ.get('CXX', 'c++')}\n")
    if home not in cache.read_text():
        sys.exit("The source does not match the source used to generate cache.")
    failure = log / "failure.txt"
    if failure.exists() and name == names[2]:
        for file in ("stdout.log", "stdout_stderr.log"):
            (folder / file).write_text("[1/4] Building a.o\nFAILED: a.o\n" + failure.read_text())
        if failure.read_text() == "hangs":
            time.sleep(60)
        print("Failed   <<<", name, "[0.1s, exited with code 1]", flush=True)
        sys.exit(1)
    (folder / "stdout.log").write_text("[0/4] Checking\n[4/4] Linking a\n")
    (install / "share" / name).mkdir(parents=True, exist_ok=True)
    (install / "share" / name / "package.xml").write_text("")
    print("Finished <<<", name, "[0.1s]", flush=True)
"""


@pytest.fixture
def state(tmp_path, monkeypatch):
    """The folder .ur of a checkout whose path contains spaces."""
    state = tmp_path / "a path with spaces" / ".ur"
    monkeypatch.setattr("ur_tools.layout.STATE", state)
    monkeypatch.setattr(build, "STATE", state)
    return state


@pytest.fixture
def layout(state, monkeypatch):
    """A checkout that is set up and has no built packages."""
    monkeypatch.setattr(build, "Lock", lambda name: lock.Lock(name, state))
    monkeypatch.setattr(system_packages, "absent", list)
    monkeypatch.setattr(venv, "is_current", lambda _: True)
    monkeypatch.setattr(downloads, "is_current", lambda: True)
    monkeypatch.setattr(downloads, "ensure", lambda _: None)
    layout = Layout("kilted")
    script = layout.venv / "bin" / "colcon"
    script.parent.mkdir(parents=True)
    (layout.base / "colcon.py").write_text(COLCON)
    script.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{layout.base / "colcon.py"}" "$@"\n')
    script.chmod(0o755)
    return layout


def calls(layout):
    return [line.split() for line in (layout.log / "calls.txt").read_text().splitlines()]


def lock_file(layout):
    return layout.base.parent / "build.lock"


def make_third_package_fail(layout, text):
    layout.log.mkdir(parents=True, exist_ok=True)
    (layout.log / "failure.txt").write_text(text)


def test_builds_everything_once_in_a_path_with_spaces(layout, capsys):
    names = list(build.build(build.Options(layout)))
    printed = capsys.readouterr().out
    assert printed.splitlines()[0].startswith(f"==> Builds {len(names)} packages, about ")
    assert all(f"finished {name}" in printed for name in names)
    assert str(lock_file(layout)) in (layout.log / "open_files.txt").read_text()  # even if ./ur is killed
    build.build(build.Options(layout))
    assert calls(layout) == [names]
    assert capsys.readouterr().out == ""


def test_stores_build_times_for_the_next_forecast(layout):
    build.build(build.Options(layout))
    seconds, steps = build._times(build.Options(layout)).last("rcl_cxx", False)
    assert steps == 4 and seconds < 30.0


def test_an_interrupted_build_is_continued(layout, monkeypatch):
    make_third_package_fail(layout, "hangs")
    update = build.Progress.update

    def interrupted(self):
        update(self)
        if len(self.done) == 2 and self._running:
            monkeypatch.setattr(build.Progress, "update", update)
            raise KeyboardInterrupt

    monkeypatch.setattr(build.Progress, "update", interrupted)
    with pytest.raises(KeyboardInterrupt):
        build.build(build.Options(layout))
    (layout.log / "failure.txt").unlink()
    names = list(build.build(build.Options(layout)))
    assert calls(layout) == [names, names[2:]]


def test_a_failure_is_shown_and_the_next_build_continues_with_the_failed_package(layout):
    make_third_package_fail(layout, "a.cpp:1: error: oh no")
    with pytest.raises(console.Failure, match="did not build(.|\n)*FAILED: a.o\na.cpp:1: error: oh no"):
        build.build(build.Options(layout))
    (layout.log / "failure.txt").unlink()
    names = list(build.build(build.Options(layout)))
    assert calls(layout)[1] == names[2:]


def test_a_full_disk_is_reported(layout):
    make_third_package_fail(layout, "a.cpp: fatal error: cannot write a.o: No space left on device")
    with pytest.raises(console.Failure, match="The disk that holds .* is full"):
        build.build(build.Options(layout))


def test_an_interrupted_installation_of_the_wheels_continues_in_the_same_environment(state, monkeypatch):
    layout = Layout("kilted")
    python = layout.venv / "bin" / "python"
    assert state in python.parents
    python.parent.mkdir(parents=True)
    python.write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n')
    python.chmod(0o755)
    (layout.venv / "bin" / "pip").write_text(f"#!{python}")
    (layout.venv / "pyvenv.cfg").write_text("")
    installed = []
    monkeypatch.setattr(venv, "find_python", lambda: pytest.fail("a new environment"))
    monkeypatch.setattr(venv, "_pip_install", lambda layout, _requirements: installed.append(layout))
    assert not venv.is_current(layout)
    venv.ensure(layout)
    assert installed == [layout] and venv.is_current(layout)


def test_the_viewer_waits_for_a_build_of_others_only_if_its_packages_are_missing(layout, state, monkeypatch):
    """`./ur view` shows the STOP button."""
    installed = []
    monkeypatch.setattr(venv, "_pip_install", lambda _, requirements: installed.append(requirements))
    build.setup_viewer(layout)
    assert installed == [layout.viewer_requirements]
    monkeypatch.setattr(lock.console, "step", pytest.fail)
    with lock.Lock("build", state):
        build.setup_viewer(layout)
    assert len(installed) == 1


def test_packages_are_built_again_in_a_new_environment(layout):
    names = list(build.build(build.Options(layout)))
    layout.venv.mkdir(parents=True, exist_ok=True)
    (layout.venv / venv.IDENTITY).write_text("another one")
    build.build(build.Options(layout))
    build.build(build.Options(layout))
    assert calls(layout) == [names, names]


def compilers(layout, names):
    caches = [(layout.build / name / "CMakeCache.txt").read_text() for name in names]
    return {line.partition("=")[2] for cache in caches for line in cache.splitlines() if line.startswith("CMAKE_CXX_COMPILER:")}


def test_another_compiler_is_used_also_after_a_failed_build(layout, monkeypatch):
    """As ./ur doctor advises: CXX=g++-12 ./ur ..."""
    monkeypatch.delenv("CXX", raising=False)
    make_third_package_fail(layout, "a.cpp:1: error: oh no")
    with pytest.raises(console.Failure, match="did not build"):
        build.build(build.Options(layout))
    (layout.log / "failure.txt").unlink()
    monkeypatch.setenv("CXX", "g++-12")
    names = list(build.build(build.Options(layout)))
    assert calls(layout)[1] == names and compilers(layout, names) == {"g++-12"}
    build.build(build.Options(layout))
    assert len(calls(layout)) == 2


def test_a_moved_checkout_builds_again(layout):
    names = list(build.build(build.Options(layout)))
    for name in names:
        (layout.build / name / "CMakeCache.txt").write_text(f"CMAKE_HOME_DIRECTORY:INTERNAL=/before/{name}\n")
        (layout.build / name / build.STAMP).write_text("of the sources at their old path")
    build.build(build.Options(layout))
    assert calls(layout) == [names, names]


def test_the_cache_of_cmake_says_what_a_build_folder_is_for(tmp_path, monkeypatch):
    source, folder = tmp_path / "the package", tmp_path / "build"
    source.mkdir()
    (source / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.18)\nproject(a NONE)\n")
    monkeypatch.setenv("CXX", "ccache  g++-12")
    assert not build.is_foreign(folder, source)
    arguments = [argument for argument in build.cmake_arguments(build.Options(Layout("kilted")), False) if "UR_COMPILER" in argument]
    subprocess.run(["cmake", "-S", str(source), "-B", str(folder), *arguments], check=True, stdout=subprocess.DEVNULL)
    assert not build.is_foreign(folder, source)
    assert build.is_foreign(folder, tmp_path / "renamed")
    monkeypatch.setenv("CXX", "g++-11")
    assert build.is_foreign(folder, source)


@pytest.fixture
def digest(tmp_path, monkeypatch):
    """Returns a function that returns what the build of a package depends on; the files outside of the package are copies in tmp_path."""
    for folder in ("wheels", "tools/cmake"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    monkeypatch.setattr("ur_tools.layout.ROOT", tmp_path)
    monkeypatch.setattr(build, "ROOT", tmp_path)
    (tmp_path / "package").mkdir()

    def of(variant):
        return build.Stamps(build.Options(Layout("kilted", variant)), {"a": Package("a", tmp_path / "package", frozenset())})._states

    return of


@pytest.mark.parametrize("variant, file", [("", "wheels/kilted.txt"), ("", "wheels/provider.cmake"),
                                           ("", "wheels/generators/sitecustomize.py"), ("thread", "tools/cmake/sanitize.cmake")])
def test_packages_are_built_again_after_a_change_of_a_file_that_all_depend_on(digest, tmp_path, variant, file):
    before = digest(variant)
    assert digest(variant) == before
    with (tmp_path / file).open("a") as changed:
        changed.write("# changed\n")
    assert digest(variant) != before


@pytest.mark.parametrize("variable", build.COMPILER_VARIABLES)
def test_packages_are_built_again_with_another_compiler_or_its_options(digest, monkeypatch, variable):
    monkeypatch.delenv(variable, raising=False)
    before = digest("")
    monkeypatch.setenv(variable, "another one")
    assert digest("") != before


def test_a_new_environment_has_another_identity(state, monkeypatch):
    layout = Layout("kilted")
    monkeypatch.setattr(venv, "ROOT", state.parent)
    monkeypatch.setattr(venv, "find_python", lambda: sys.executable)
    monkeypatch.setattr(venv, "_pip_install", lambda _layout, _requirements: None)
    venv.ensure(layout)
    first = venv.identity(layout)
    (layout.venv / "pyvenv.cfg").unlink()
    (layout.venv / venv.STAMP).unlink()
    venv.ensure(layout)
    assert first and venv.identity(layout) not in ("", first)
