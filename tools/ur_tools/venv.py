"""The virtual environment with the ROS 2 wheels and the build tools."""

import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import time
from typing import Iterable, List, Optional

from . import console
from .layout import ROOT, Layout

SUPPORTED = ((3, 10), (3, 12))
STAMP = "ur_stamp.txt"
VIEWER_STAMP = "ur_viewer_stamp.txt"
MEGABYTES = 300  # to download
SECONDS = 50.0
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
        for found in sorted(pathlib.Path.home().glob(f".pyenv/versions/3.{minor}.*/bin/python3"), reverse=True):
            yield str(found)
    yield "/usr/bin/python3"


def _why_unusable(python: str) -> Optional[str]:
    try:
        result = subprocess.run([python, "-c", _PROBE], stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=30,
                                universal_newlines=True)
    except (OSError, subprocess.TimeoutExpired) as error:
        return str(error)
    if result.returncode != 0:
        return "has no venv and pip (python3-venv)" if "ensurepip" in result.stderr else console.tail(result.stderr, 1)
    version, header = result.stdout.split()
    major_minor = tuple(int(part) for part in version.split("."))
    if not SUPPORTED[0] <= major_minor <= SUPPORTED[1]:
        return f"is {version}"
    return None if header == "1" else "has no headers (python3-dev)"


def find_python() -> str:
    """Returns a Python 3.10 to 3.12 with venv, pip and headers. ROS 2 wheels exist for these versions."""
    refused: List[str] = []
    for python in _candidates():
        why = _why_unusable(python)
        if why is None:
            return os.path.realpath(python)
        refused.append(f"    {python} {why}")
    raise console.Failure("The ROS 2 wheels need Python 3.10, 3.11 or 3.12. Found:\n" + "\n".join(dict.fromkeys(refused)) +
                          "\nInstall one with its venv module and headers, or select it: UR_PYTHON=/path/to/python3.11 ./ur ...")


def _stamp(layout: Layout, requirements: Iterable[pathlib.Path]) -> str:
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


def _pip_install(layout: Layout, requirements: Iterable[pathlib.Path]) -> None:
    command = [str(layout.python), "-m", "pip", "install", "--disable-pip-version-check", "--no-input", "--no-deps",
               "--no-compile"]  # compiling the modules that are never imported takes a third of the time
    for file in requirements:
        command += ["--requirement", str(file)]
    log = layout.base / "pip.log"
    # PYTHONPATH and PYTHONHOME belong to another environment; PIP_USER would prevent an installation into this one.
    env = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONHOME", "PIP_USER")}
    env["_ROS_WHEELS_BOOTSTRAP_COMPLETE"] = "1"
    for attempt in range(1, 4):
        if _run_pip(command, env, log) == 0:
            return
        if attempt < 3:
            console.line(f"    the installation failed ({log}); trying again")
            time.sleep(3.0 * attempt)
    text = log.read_text(errors="replace")
    raise console.Failure(f"The Python packages could not be installed in three attempts. The end of {log}:\n"
                          f"{console.tail(text, 12)}\n"
                          "Check the network connection. pip's settings (`pip config list`) select a proxy or a mirror. Then run ./ur "
                          "again: downloaded packages are kept.")


def _run_pip(command: List[str], env: dict, log: pathlib.Path) -> int:
    status, start = console.Status(), time.monotonic()
    with log.open("w") as output:
        process = subprocess.Popen(command, env=env, stdout=output, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
        try:
            while process.poll() is None:
                lines = log.read_text(errors="replace").strip().splitlines()
                now = lines[-1].strip() if lines else ""
                status.show(f"{time.monotonic() - start:4.0f} s  {now}")
                time.sleep(0.2)
        finally:
            if process.poll() is None:
                process.terminate()
                process.wait()
            status.clear()
    return process.returncode


def is_current(layout: Layout) -> bool:
    stamp_file = layout.venv / STAMP
    return stamp_file.is_file() and stamp_file.read_text() == _stamp(layout, layout.requirements)


def ensure(layout: Layout) -> None:
    if is_current(layout):
        return
    start = time.monotonic()
    if not _is_usable(layout):
        python = find_python()
        console.step(f"Creating a virtual environment in {layout.venv.relative_to(ROOT)} with {python}")
        layout.base.mkdir(parents=True, exist_ok=True)
        result = subprocess.run([python, "-m", "venv", "--clear", str(layout.venv)], stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, universal_newlines=True)
        if result.returncode != 0:
            raise console.Failure(f"`{python} -m venv` failed:\n{console.tail(result.stdout, 10)}\n"
                                  "On Debian and Ubuntu, install the package python3-venv.")
    console.step(f"Installing ROS 2 {layout.ros.capitalize()} and the build tools as wheels")
    _pip_install(layout, layout.requirements)
    (layout.venv / STAMP).write_text(_stamp(layout, layout.requirements))
    console.line(f"    done in {time.monotonic() - start:.0f} s")


def ensure_viewer(layout: Layout) -> None:
    """Installs the packages of the viewer into the existing environment."""
    stamp_file, stamp = layout.venv / VIEWER_STAMP, _stamp(layout, layout.viewer_requirements)
    if stamp_file.is_file() and stamp_file.read_text() == stamp:
        return
    console.step("Installing the page server of the viewer (10 MB)")
    _pip_install(layout, layout.viewer_requirements)
    stamp_file.write_text(stamp)
