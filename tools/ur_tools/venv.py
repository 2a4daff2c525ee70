"""The virtual environment with the ROS 2 wheels and the build tools."""

import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time
from typing import Dict, Iterable, List, Optional, Sequence, Tuple

from . import console, pins
from .layout import ROOT, SUPPORTED_DISTRIBUTIONS, Layout

SUPPORTED = ((3, 10), (3, 12))  # by the wheels
NEWEST = (3, 14)  # of a supported ROS
STAMP = "ur_stamp.txt"
VIEWER_STAMP = "ur_viewer_stamp.txt"
IDENTITY = "ur_identity.txt"
MEGABYTES = 160  # to download
SECONDS = 25.0
RETRY_DELAY = 3.0  # s
PYTHON_OF_ROS = "import rclpy, ensurepip, venv"
_PROBE = ("import sys, os, sysconfig, ensurepip, venv; "
          "header = os.path.join(sysconfig.get_paths()['include'], 'Python.h'); "
          "print('%d.%d' % sys.version_info[:2], int(os.path.exists(header)))")


def _candidates() -> Iterable[str]:
    chosen = os.environ.get("UR_PYTHON")
    if chosen:
        yield chosen
        return
    yield sys.executable
    for minor in (11, 12, 10):
        found = shutil.which(f"python3.{minor}")
        if found:
            yield found
    for minor in (11, 12, 10):
        for python in sorted(pathlib.Path.home().glob(f".pyenv/versions/3.{minor}.*/bin/python3"), reverse=True):
            yield str(python)
    yield "/usr/bin/python3"


def _why_unusable(python: str, newest: Tuple[int, int]) -> Optional[str]:
    try:
        result = subprocess.run([python, "-c", _PROBE], stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=30,
                                universal_newlines=True)
    except (OSError, subprocess.TimeoutExpired) as error:
        return str(error)
    if result.returncode != 0:
        return "has no venv and pip (python3-venv)" if "ensurepip" in result.stderr else console.tail(result.stderr, 1)
    version, header = result.stdout.split()
    major_minor = tuple(int(part) for part in version.split("."))
    if not SUPPORTED[0] <= major_minor <= newest:
        return f"is {version}"
    return None if header == "1" else "has no headers (python3-dev)"


def find_python(newest: Tuple[int, int] = SUPPORTED[1], user: str = "The ROS 2 wheels need") -> str:
    """Returns a Python from 3.10 to the newest that its user supports, with venv, pip and headers."""
    rejected: List[str] = []
    for python in _candidates():
        why = _why_unusable(python, newest)
        if why is None:
            return os.path.realpath(python)
        rejected.append(f"    {python} {why}")
    raise console.Failure(f"{user} Python 3.10 to 3.{newest[1]}. Found:\n" + "\n".join(dict.fromkeys(rejected)) +
                          "\nInstall one with its venv module and headers, or select it: UR_PYTHON=/path/to/python3.11 ./ur ...")


def python_of_ros(layout: Layout) -> str:
    """Returns the Python of the installed ROS that has been sourced: python3, or the one that UR_PYTHON names."""
    if layout.distribution not in SUPPORTED_DISTRIBUTIONS:
        found = f"ROS 2 {layout.distribution} is sourced" if layout.distribution else "No ROS 2 is sourced"
        raise console.Failure(f"{found}: `--ros installed` needs one of {', '.join(SUPPORTED_DISTRIBUTIONS)}. Source its setup script "
                              "first, as in `. /opt/ros/jazzy/setup.sh`; or use wheels: `--ros jazzy`.")
    python = shutil.which(os.environ.get("UR_PYTHON", "python3")) or "python3"
    result = subprocess.run([python, "-c", PYTHON_OF_ROS], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
    if result.returncode != 0:
        raise console.Failure(f"{layout.title}: {python} cannot be used: {console.tail(result.stdout, 1)}\nIt must be the Python of that "
                              "installation, with rclpy and venv (python3-venv). Select it: UR_PYTHON=/path/to/python3 ./ur ...")
    return python


def python_for(layout: Layout) -> str:
    """Returns the Python for the virtual environment."""
    return python_of_ros(layout) if layout.is_installed else find_python()


def _stamp(layout: Layout, requirements: Sequence[pathlib.Path]) -> str:
    # A virtual environment contains its own path: it must be created again after a move.
    digest = hashlib.sha256(str(layout.venv).encode())
    for file in requirements:
        digest.update(file.read_bytes())
    return digest.hexdigest()


def _is_usable(layout: Layout) -> bool:
    """Returns whether a usable environment exists, into which new requirements can be installed."""
    config = layout.venv / "pyvenv.cfg"
    script = layout.venv / "bin" / "pip"
    if not (config.is_file() and script.is_file() and str(layout.venv) in script.read_text(errors="replace")):
        return False
    return subprocess.run([str(layout.python), "-c", "import pip"], stderr=subprocess.DEVNULL).returncode == 0


def _pip_install(layout: Layout, requirements: Sequence[pathlib.Path]) -> None:
    env = pins.environment()
    for attempt in range(1, 4):
        with Installation(layout, requirements, env) as installation:
            logs = installation.wait()
        if not logs:
            return
        for file in requirements:
            if _log(layout, file) in logs:  # the same file would come at the next attempt
                pins.fail_on_mismatch(file, _log(layout, file).read_text(errors="replace"))
        if attempt < 3:
            console.line(f"    the installation failed ({', '.join(map(str, logs))}); trying again")
            time.sleep(RETRY_DELAY * attempt)
    ends = "\n".join(f"The end of {log}:\n{console.tail(log.read_text(errors='replace'), 12)}" for log in logs)
    raise console.Failure(f"The Python packages could not be installed in three attempts. {ends}\n"
                          "Check the network connection. pip's settings (`pip config list`) select a proxy or a mirror. Then run ./ur "
                          "again: downloaded packages are kept.")


def _log(layout: Layout, requirements: pathlib.Path) -> pathlib.Path:
    return layout.base / f"pip_{requirements.stem}.log"


class Installation:
    """Installs the packages of all requirement files, each with a pip of its own: most of the time, pip waits for the registry."""

    def __init__(self, layout: Layout, requirements: Sequence[pathlib.Path], env: Dict[str, str]):
        self._total = sum(_count(file) for file in requirements)
        self._running: "Dict[pathlib.Path, subprocess.Popen[bytes]]" = {}  # by log
        for file in requirements:
            log = _log(layout, file)
            with log.open("w") as output:
                self._running[log] = subprocess.Popen(pins.install_command(layout.python, file), env=env, stdout=output,
                                                      stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)

    def __enter__(self) -> "Installation":
        return self

    def __exit__(self, *_unused: object) -> None:
        for process in self._running.values():
            if process.poll() is None:
                process.terminate()
        for process in self._running.values():
            process.wait()

    def wait(self) -> List[pathlib.Path]:
        """Waits for the end and shows the progress. Returns the logs of the processes that failed."""
        status, start = console.Status(), time.monotonic()
        try:
            while any(process.poll() is None for process in self._running.values()):
                status.show(f"{time.monotonic() - start:4.0f} s  {self._progress()}")
                time.sleep(0.2)
        finally:
            status.clear()
        return [log for log, process in self._running.items() if process.returncode != 0]

    def _progress(self) -> str:
        texts = [log.read_text(errors="replace") for log in self._running]
        names = [name for text in texts for name in re.findall(r"^(?:Collecting|Requirement already satisfied:) ([^\s=]+)", text, re.M)]
        installing = sum(text.count("Installing collected packages") for text in texts)
        if installing == len(texts):
            return f"installing {self._total} packages"
        return f"{len(names)} of about {self._total} packages" + (f": {', '.join(names[-1:])}" if names else "")


def _count(requirements: pathlib.Path) -> int:
    """Returns the number of packages: those with several versions, for several versions of Python, count once."""
    return len({pin.name for pin in pins.read(requirements)})


def _has_stamp(layout: Layout, stamp: str, requirements: Sequence[pathlib.Path]) -> bool:
    file = layout.venv / stamp
    return file.is_file() and file.read_text() == _stamp(layout, requirements)


def is_current(layout: Layout) -> bool:
    return _has_stamp(layout, STAMP, layout.requirements)


def identity(layout: Layout) -> str:
    """Returns a text that is different after the environment has been created again: builds put files into it, and use its headers."""
    file = layout.venv / IDENTITY
    return file.read_text() if file.is_file() else ""


def ensure(layout: Layout) -> None:
    if is_current(layout):
        return
    start = time.monotonic()
    if not _is_usable(layout):
        python = python_for(layout)
        console.step(f"Creating a virtual environment in {layout.venv.relative_to(ROOT)} with {python}")
        layout.base.mkdir(parents=True, exist_ok=True)
        options = ["--system-site-packages"] if layout.is_installed else []
        result = subprocess.run([python, "-m", "venv", "--clear", *options, str(layout.venv)], stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, universal_newlines=True)
        if result.returncode != 0:
            raise console.Failure(f"`{python} -m venv` failed:\n{console.tail(result.stdout, 10)}\n"
                                  "On Debian and Ubuntu, install the package python3-venv.")
        (layout.venv / IDENTITY).write_text(str(time.time_ns()))
    console.step("Installing the build tools" if layout.is_installed else f"Installing {layout.title} and the build tools as wheels")
    _pip_install(layout, layout.requirements)
    (layout.venv / STAMP).write_text(_stamp(layout, layout.requirements))
    console.line(f"    done in {time.monotonic() - start:.0f} s")


def has_viewer(layout: Layout) -> bool:
    """Returns whether the environment has the packages of the viewer."""
    return _has_stamp(layout, VIEWER_STAMP, layout.viewer_requirements)


def ensure_viewer(layout: Layout) -> None:
    """Installs the packages of the viewer into the existing environment."""
    if has_viewer(layout):
        return
    console.step("Installing the page server of the viewer (10 MB)")
    _pip_install(layout, layout.viewer_requirements)
    (layout.venv / VIEWER_STAMP).write_text(_stamp(layout, layout.viewer_requirements))
