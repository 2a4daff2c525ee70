"""Chromium and Playwright for the browser tests. `./ur test` provides them when such a test is selected.

A Chromium on PATH is used. Otherwise, Debian's package of a headless Chromium and the libraries that this machine lacks are
unpacked into .ur/browser, without root: a download of 100 MB, 290 MB on disk. Playwright adds a download of 54 MB. If apt has no
package lists, as in a new container, they are downloaded into .ur/apt. All addresses are those of the machine's own configuration.
"""

import os
import pathlib
import re
import shutil
import subprocess
import time
from typing import Any, Dict, List, Optional

from . import console, pins
from .environment import FOREIGN
from .layout import ROOT, STATE, Layout

NAMES = ("chromium", "chromium-headless-shell", "chromium-browser", "google-chrome")
PACKAGE = "chromium-headless-shell"
PROGRAM = pathlib.Path("usr/lib/chromium/chromium-headless-shell")  # in the package
REQUIREMENTS = ROOT / "wheels" / "browser.txt"
FOLDER = STATE / "browser"
SYSTEM_LISTS = pathlib.Path("/var/lib/apt/lists")
LISTS = STATE / "apt"
TIMEOUT = 300.0  # s, for each program that is run
TOOLS = ("apt-get", "dpkg-deb")

# Read by the tests: the program, the folders of its libraries, or why there is none.
VARIABLE, LIBRARIES, MISSING = "UR_BROWSER", "UR_BROWSER_LIBRARIES", "UR_BROWSER_MISSING"

# For a machine without a GPU.
ARGUMENTS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",
             "--disable-gpu-compositing"]


def launch(playwright: Any, limit: float) -> Any:
    """Returns a Chromium, started by Playwright as the variables say."""
    env = {**os.environ, "LD_LIBRARY_PATH": os.environ.get(LIBRARIES, "")}
    return playwright.chromium.launch(executable_path=os.environ[VARIABLE], args=ARGUMENTS, env=env, timeout=1e3 * limit)


def _run(command: List[str], folder: pathlib.Path = ROOT) -> str:
    env = {name: value for name, value in os.environ.items() if name not in FOREIGN}
    try:
        result = subprocess.run(command, cwd=folder, env={**env, "LC_ALL": "C"}, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, universal_newlines=True, timeout=TIMEOUT)
    except subprocess.TimeoutExpired:
        raise console.Failure(f"`{' '.join(command[:3])} …` took longer than {TIMEOUT:g} s: check the network connection.") from None
    if result.returncode != 0:
        raise console.Failure(f"`{' '.join(command[:3])} …`: {console.tail(result.stdout, 3)}")
    return result.stdout


def _has_lists(folder: pathlib.Path) -> bool:
    return any(folder.glob("*Packages*"))


def _apt_options() -> List[str]:
    """Returns the options with which apt finds packages. Where the machine has no package lists, they are downloaded into LISTS."""
    if _has_lists(SYSTEM_LISTS):
        return []
    options = ["-o", f"Dir::State::lists={LISTS / 'lists'}", "-o", f"Dir::Cache={LISTS / 'cache'}", "-o", "APT::Sandbox::User=root"]
    if not _has_lists(LISTS / "lists"):
        console.step("Downloading the package lists of apt, because this machine has none")
        start = time.monotonic()
        for part in ("lists/partial", "cache/archives/partial"):
            (LISTS / part).mkdir(parents=True, exist_ok=True)
        _run(["apt-get", *options, "-o", "Acquire::http::Timeout=20", "update"])
        console.line(f"    done in {time.monotonic() - start:.0f} s")
    return options


def _download(folder: pathlib.Path) -> None:
    """Downloads the archives of the package and of the libraries that are not installed."""
    options = _apt_options()
    listing = _run(["apt-get", *options, "install", "--print-uris", "--yes", "--no-install-recommends", "-o", "Debug::NoLocking=1",
                    PACKAGE])
    packages = [name.split("_")[0] for name in re.findall(r"^'\S+' (\S+\.deb) ", listing, re.M)]
    console.step("Downloading a headless Chromium for the browser tests (100 MB)")
    start = time.monotonic()
    _run(["apt-get", *options, "download", *packages], folder)
    console.line(f"    done in {time.monotonic() - start:.0f} s")


def _unpack(folder: pathlib.Path) -> None:
    """Downloads and unpacks Chromium. An interrupted run leaves no incomplete `folder`."""
    absent = [tool for tool in TOOLS if shutil.which(tool) is None]
    if absent:
        raise console.Failure(f"this machine has no {' and no '.join(absent)}, the tools of Debian")
    incomplete = folder.with_name(folder.name + ".incomplete")
    shutil.rmtree(incomplete, ignore_errors=True)
    archives = incomplete / "archives"
    archives.mkdir(parents=True)
    _download(archives)
    for archive in sorted(archives.glob("*.deb")):
        _run(["dpkg-deb", "-x", str(archive), str(incomplete)])
    if not (incomplete / PROGRAM).is_file():
        raise console.Failure(f"the package {PACKAGE} does not contain {PROGRAM}")
    shutil.rmtree(archives)
    shutil.rmtree(folder, ignore_errors=True)
    incomplete.rename(folder)


def _install_playwright(layout: Layout) -> None:
    site = layout.site_packages(layout.venv)
    if all((site / f"{pin.name}-{pin.version}.dist-info").is_dir() for pin in pins.read(REQUIREMENTS)):
        return
    console.step("Installing Playwright for the browser tests (54 MB)")
    pins.install(layout.python, REQUIREMENTS)


def _chromium(folder: pathlib.Path) -> Dict[str, str]:
    installed: Optional[str] = next(filter(None, map(shutil.which, NAMES)), None)
    if installed:
        return {VARIABLE: installed}
    if not (folder / PROGRAM).is_file():
        _unpack(folder)
    libraries = sorted({str(file.parent) for file in folder.rglob("lib*.so*")})
    return {VARIABLE: str(folder / PROGRAM), LIBRARIES: os.pathsep.join(libraries)}


def environment(layout: Layout, folder: pathlib.Path = FOLDER) -> Dict[str, str]:
    """Returns the variables for browser tests. Without a browser, they are skipped, and the reason and the remedy are printed."""
    try:
        found = _chromium(folder)
        _install_playwright(layout)
        return found
    except pins.Mismatch:
        raise
    except console.Failure as failure:
        reason = f"{failure} Install chromium, or put it on PATH."
        console.line(f"    the browser tests are skipped: {reason}")
        return {MISSING: reason}
