"""Builds the packages that changed with colcon, and shows the progress."""

import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import time
from dataclasses import dataclass
from typing import Dict, Iterable, List, Optional, Set, Tuple

from . import build_times, console, disk, downloads, lock, machine, system_packages, venv
from .build_times import BuildTimes, Forecast
from .environment import build_environment
from .layout import ROOT, SANITIZERS, STATE, Layout
from .lock import Lock
from .packages import Package, discover_with_interfaces, state, with_dependencies
from .processes import end_group

STAMP = "ur_stamp.txt"
MEMORY_PER_JOB = 1.0e9  # bytes, of the largest translation units
WORKERS = 2  # packages at a time, each with all jobs
# CMake reads these variables when it configures a build folder for the first time, and keeps the values.
COMPILER_VARIABLES = ("CC", "CFLAGS", "CXX", "CXXFLAGS", "LDFLAGS")
_NOT_IN_PATHS = ":;$\\\"'"


def check_path(root: pathlib.Path) -> None:
    """Raises Failure if the path has characters that separate entries in PATH or CMake lists, or that need quoting. Spaces are allowed."""
    wrong = [character for character in _NOT_IN_PATHS if character in str(root)]
    if wrong:
        raise console.Failure(f"The checkout's path {root} contains {' '.join(wrong)}, which cannot be in a search path or a CMake "
                              "list. Move the checkout.")


def default_jobs() -> int:
    """One job per core, limited by memory."""
    return max(1, min(machine.cores(), int(machine.memory() / MEMORY_PER_JOB)))


@dataclass
class Options:
    layout: Layout
    packages: Optional[List[str]] = None
    tests: bool = False
    jobs: int = 0

    def __post_init__(self) -> None:
        self.jobs = self.jobs or default_jobs()


def _includes(layout: Layout) -> List[pathlib.Path]:
    """Returns the CMake files that each package includes."""
    files = [] if layout.is_installed else [layout.provider]
    return files + ([ROOT / "tools" / "cmake" / "sanitize.cmake"] if layout.variant in SANITIZERS else [])


def _common_sources(layout: Layout) -> List[pathlib.Path]:
    """Returns the files outside of the packages that each build depends on."""
    generators = [] if layout.is_installed else sorted((layout.provider.parent / "generators").glob("*.py"))
    return [*layout.requirements, *_includes(layout), *generators]


def _compiler() -> str:
    """Returns which compiler and options the environment selects."""
    return " ".join(" ".join(f"{name}={os.environ[name]}".split()) for name in COMPILER_VARIABLES if os.environ.get(name))


def cmake_arguments(options: Options, tests: bool) -> List[str]:
    layout = options.layout
    build_type = "Release"
    arguments = [] if layout.is_installed else [f"-DROS_WHEELS_PREFIX={layout.venv}"]
    if layout.variant == "debug":
        build_type = "Debug"
    elif layout.variant:
        build_type = "RelWithDebInfo"
        arguments.append(f"-DUR_SANITIZE={layout.variant}")
    return ["-GNinja", f"-DCMAKE_BUILD_TYPE={build_type}",
            # CMake's default, -O3, compiles more slowly: g++ needs a quarter of its time for what -O2 adds to -O1. The trajectory
            # library benefits from -O3 and sets it itself.
            "-DCMAKE_C_FLAGS_RELEASE=-O1 -DNDEBUG", "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG",
            "-DCMAKE_PROJECT_TOP_LEVEL_INCLUDES=" + ";".join(map(str, _includes(layout))), "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON",
            "-DBUILD_TESTING=" + ("ON" if tests else "OFF"), "-Wno-unused-cli", f"-DUR_COMPILER={_compiler()}", *arguments]


def is_foreign(folder: pathlib.Path, source: pathlib.Path) -> bool:
    """Returns whether CMake has configured a build folder for other sources, as before the checkout was moved, or for another compiler.
    It cannot change either."""
    try:
        text = (folder / "CMakeCache.txt").read_text(errors="replace")
    except FileNotFoundError:
        return False
    cache = dict(re.findall(r"^(CMAKE_HOME_DIRECTORY|UR_COMPILER):\w+=(.*)$", text, re.M))
    is_moved = os.path.realpath(cache.get("CMAKE_HOME_DIRECTORY", "")) != os.path.realpath(source)  # links may lead to the same sources
    return is_moved or cache.get("UR_COMPILER", "") != _compiler()


class Stamps:
    """Records what each package was last built from: its files, those of its dependencies, and the build options."""

    def __init__(self, options: Options, packages: Dict[str, Package]):
        self._layout = options.layout
        options_digest = hashlib.sha256("\0".join(cmake_arguments(options, False)).encode())
        for file in _common_sources(options.layout):
            options_digest.update(file.read_bytes())
        options_digest.update(venv.identity(options.layout).encode())
        self._states: Dict[str, str] = {}
        for name, package in packages.items():
            digest = options_digest.copy()
            digest.update(state(package).encode())
            for dependency in sorted(package.depends & self._states.keys()):
                digest.update(self._states[dependency].encode())
            self._states[name] = digest.hexdigest()

    def _file(self, name: str) -> pathlib.Path:
        return self._layout.build / name / STAMP

    def has_tests(self, name: str) -> bool:
        file = self._file(name)
        return file.is_file() and file.read_text().endswith(" tests")

    def is_current(self, name: str, tests: bool) -> bool:
        file = self._file(name)
        if not (file.is_file() and (self._layout.install / "share" / name / "package.xml").is_file()):
            return False
        return file.read_text().split(" ")[0] == self._states[name] and (not tests or self.has_tests(name))

    def write(self, name: str, tests: bool) -> None:
        self._file(name).write_text(self._states[name] + (" tests" if tests else ""))


class Progress:
    """Follows colcon's output and the logs of the packages that it builds."""

    _EVENT = re.compile(r"^(Starting >>>|Finished <<<|Failed\s+<<<|Aborted\s+<<<)\s+(\S+)")
    _STEP = re.compile(r"^\[(\d+)/(\d+)\] ")  # step 0 checks the build files

    def __init__(self, layout: Layout, output: pathlib.Path, stamps: Stamps, forecast: Forecast, tests: bool):
        self._layout, self._output, self._stamps, self._tests = layout, output, stamps, tests
        self._forecast = forecast
        self._seen = 0
        self._running: Dict[str, float] = {}
        self._status = console.Status()
        self.failed: List[str] = []
        self.done: Set[str] = set()

    def update(self) -> None:
        self._forecast.update(self._running)
        lines = self._output.read_text(errors="replace").split("\n")
        for text in lines[self._seen:-1]:
            self._event(text)
        self._seen = len(lines) - 1
        if self._running:
            doing = ", ".join(f"{name} {self._step(name)}" for name in self._running)
            self._status.show(f"{self._forecast.text()}: {doing}")

    def _event(self, text: str) -> None:
        match = self._EVENT.match(text)
        if not match:
            return
        name, what = match.group(2), match.group(1).split()[0]
        start = self._running.setdefault(name, time.monotonic())
        if what == "Starting":
            return
        self._step(name)
        del self._running[name]
        if what == "Finished":
            self._stamps.write(name, self._tests)
            self._forecast.finish(name)
            self.done.add(name)
        elif what == "Failed":
            self.failed.append(name)
        self._status.keep(f"    {what.lower():8} {name} ({time.monotonic() - start:.0f} s)")

    def _step(self, name: str) -> str:
        log = self._layout.log / "latest_build" / name / "stdout.log"
        try:
            with log.open("rb") as file:
                file.seek(0, os.SEEK_END)
                file.seek(max(0, file.tell() - 4000))
                lines = file.read().decode(errors="replace").splitlines()
        except OSError:
            return ""
        for text in reversed(lines):
            match = self._STEP.match(text)
            if match and match.group(1) != "0":
                self._forecast.step(name, int(match.group(1)), int(match.group(2)))
                return f"{match.group(1)}/{match.group(2)}"
        return "configuring"

    def end(self) -> None:
        self.update()
        self._status.clear()


def _colcon(options: Options, names: List[str], folders: List[pathlib.Path], tests: bool) -> List[str]:
    layout = options.layout
    return [str(layout.venv / "bin" / "colcon"), "--log-base", str(layout.log), "build", "--merge-install",
            "--base-paths", *map(str, folders), "--packages-select", *names,
            "--build-base", str(layout.build), "--install-base", str(layout.install),
            "--executor", "parallel", "--parallel-workers", str(min(WORKERS, options.jobs)),
            "--event-handlers", "console_start_end+", "console_cohesion-", "parallel_status-", "summary-",
            "--cmake-force-configure", "--cmake-args", *cmake_arguments(options, tests)]


def _failure(layout: Layout, progress: Progress, output: pathlib.Path) -> console.Failure:
    parts = []
    for name in progress.failed:
        log = layout.log / "latest_build" / name / "stdout_stderr.log"
        text = log.read_text(errors="replace") if log.is_file() else ""
        # Only warnings of other files precede the first failure.
        at = next((at for at in (text.find("FAILED: "), text.find("CMake Error")) if at >= 0), -1)
        shown = "\n".join(text[at:].splitlines()[:40]) if at >= 0 else console.tail(text)
        parts.append(f"{name} did not build ({log}):\n{shown}")
    if any("No space left on device" in part for part in parts):
        parts.append(disk.full_message(layout.build))
    if not parts:
        parts.append(f"colcon failed ({output}):\n{console.tail(output.read_text(errors='replace'), 20)}")
    return console.Failure("\n\n".join(parts))


def _forget(layout: Layout, names: List[str]) -> None:
    """Removes the stamps, so that an interrupted build does not look current."""
    for name in names:
        stamp = layout.build / name / STAMP
        if stamp.exists():
            stamp.unlink()


def _run_colcon(options: Options, packages: Dict[str, Package], outdated: List[str], stamps: Stamps, tests: bool) -> None:
    layout = options.layout
    layout.log.mkdir(parents=True, exist_ok=True)
    _forget(layout, outdated)
    output = layout.log / "colcon.txt"
    command = _colcon(options, outdated, [package.folder for package in packages.values()], tests)
    with output.open("w") as file:
        process = subprocess.Popen(command, cwd=layout.base, env=build_environment(layout, options.jobs), stdout=file,
                                   stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, start_new_session=True,
                                   pass_fds=tuple(lock.descriptors()))  # colcon goes on if this process is killed
    times = _times(options)
    progress = Progress(layout, output, stamps, Forecast(times, _firsts(layout, outdated), tests), tests)
    try:
        while process.poll() is None:
            progress.update()
            time.sleep(0.2)
    finally:
        end_group(process)
        progress.end()
        times.write()
    if process.returncode != 0 or not set(outdated) <= progress.done:
        raise _failure(layout, progress, output)


def _times(options: Options) -> BuildTimes:
    return BuildTimes(options.layout.build_times, options.jobs)


def _firsts(layout: Layout, names: Iterable[str]) -> Dict[str, bool]:
    """Returns for each package whether this is its first build."""
    return {name: not (layout.build / name / ".ninja_log").is_file() for name in names}


@dataclass
class Pending:
    """The work that is left until everything is built."""

    system: List[str]  # packages of the operating system
    venv: bool
    archive: bool
    outdated: List[str]
    tests: bool = False

    def __bool__(self) -> bool:
        return bool(self.system or self.venv or self.archive or self.outdated)

    def text(self, options: Options) -> str:
        """Returns one line: downloads, packages to build, duration."""
        megabytes = self.venv * venv.MEGABYTES + self.archive * downloads.MEGABYTES
        parts = []
        if self.system:
            parts.append(f"installs {len(self.system)} system packages")
        if megabytes:
            parts.append(f"downloads about {megabytes} MB")
        if self.outdated:
            parts.append(f"builds {len(self.outdated)} package{'s' * (len(self.outdated) > 1)}")
        start = "First run: " if not options.layout.venv.exists() else ""
        text = f"{', '.join(parts)}, {self._duration(options)}"
        return start + (text if start else text[0].upper() + text[1:])

    def _duration(self, options: Options) -> str:
        times, first = _times(options), _firsts(options.layout, self.outdated)
        estimates = [times.first(name, self.tests) for name in self.outdated]
        seconds = bool(self.system) * system_packages.SECONDS + self.venv * venv.SECONDS + sum(estimate for estimate, _ in estimates)
        most = seconds + (build_times.SLOW_HOST - 1.0) * sum(estimate for estimate, steps in estimates if not steps)
        again = [name for name, is_first in first.items() if not is_first]
        duration = f"at most {build_times.rounded(most)}" if again else f"about {build_times.span(seconds, most)}"
        if self.outdated:
            duration += f" on {options.jobs} core{'s' * (options.jobs > 1)}"
        last = [times.last(name, self.tests) for name in again]
        if last and len(last) == len(first) and all(last):
            duration += f" (last time {build_times.rounded(sum(entry[0] for entry in last if entry))})"
        return duration


def needed_space(layout: Layout, names: Iterable[str]) -> float:
    """Returns how many bytes a build of these packages needs: the first one more, also for the virtual environment."""
    share = sum(_firsts(layout, names).values()) / len(discover_with_interfaces())
    return disk.LATER + disk.ENVIRONMENT * (not venv.is_current(layout)) + disk.BUILD * share


def _pending_setup(layout: Layout) -> Pending:
    return Pending(system_packages.absent(), not venv.is_current(layout), not downloads.is_current(), [])


def _setup(layout: Layout, pending: Pending) -> None:
    if pending:
        check_path(ROOT)
        if layout.is_installed:
            venv.python_of_ros(layout)
        disk.check(STATE, needed_space(layout, pending.outdated))
    system_packages.ensure()
    venv.ensure(layout)
    downloads.ensure(layout)


def setup(layout: Layout) -> None:
    """Installs the system packages, the virtual environment and the sources of ur_rtde, as far as they are missing."""
    if not _pending_setup(layout):
        return
    with Lock("build"):
        pending = _pending_setup(layout)
        if pending:
            console.step(pending.text(Options(layout)))
        _setup(layout, pending)


def setup_viewer(layout: Layout) -> None:
    """Installs the Python packages of the viewer if they are missing. The build needs none of them."""
    if venv.has_viewer(layout):
        return
    with Lock("build"):
        venv.ensure_viewer(layout)


def _chosen(options: Options) -> Dict[str, Package]:
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if options.layout.is_installed else []
    packages = discover_with_interfaces(prefixes)
    if options.packages is not None:
        try:
            packages = with_dependencies(packages, options.packages)
        except KeyError as error:
            raise console.Failure(str(error.args[0])) from None
    return packages


def _pending(options: Options, packages: Dict[str, Package]) -> Tuple[Pending, Stamps]:
    stamps = Stamps(options, packages)
    pending = _pending_setup(options.layout)
    pending.outdated = [name for name in packages if not stamps.is_current(name, options.tests)]
    # A package that was built with its tests keeps them; otherwise building and testing in turn would configure it each time.
    pending.tests = options.tests or any(stamps.has_tests(name) for name in pending.outdated)
    return pending, stamps


def build(options: Options) -> Dict[str, Package]:
    """Sets up what is missing and builds what changed. Returns the requested packages and their dependencies."""
    packages = _chosen(options)
    if not _pending(options, packages)[0]:
        return packages
    with Lock("build"):
        packages = _chosen(options)
        pending, _ = _pending(options, packages)  # another ./ur may have built them while this one waited
        for name in pending.outdated:
            if is_foreign(options.layout.build / name, packages[name].folder):
                shutil.rmtree(options.layout.build / name)
        if pending:
            console.step(pending.text(options))
        _setup(options.layout, pending)
        pending, stamps = _pending(options, packages)  # in the environment that is there now
        if pending.outdated:
            _build(options, packages, pending, stamps)
    return packages


def _build(options: Options, packages: Dict[str, Package], pending: Pending, stamps: Stamps) -> None:
    console.step(f"Building {', '.join(pending.outdated)} for {options.layout.title}"
                 + (f" ({options.layout.variant})" if options.layout.variant else ""))
    start = time.monotonic()
    _run_colcon(options, packages, pending.outdated, stamps, pending.tests)
    console.line(f"    built in {time.monotonic() - start:.0f} s")
