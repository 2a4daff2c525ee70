"""Downloads the source archive of ur_rtde with pip. With an installed ROS 2, ur_rtde_vendor downloads it itself."""

import hashlib
import pathlib
import subprocess
import time
from typing import Tuple

from . import console, pins
from .layout import DOWNLOADS, ROOT, Layout

MEGABYTES = 4
PIN = ROOT / "wheels" / "ur_rtde.txt"


def _pinned() -> Tuple[str, str]:
    """Returns name and SHA-256 of the archive that is pinned in wheels/ur_rtde.txt."""
    pin, = pins.read(PIN)
    digest, = pin.hashes
    return f"{pin.name.replace('-', '_')}-{pin.version}.tar.gz", digest


def ur_rtde_archive() -> pathlib.Path:
    return DOWNLOADS / _pinned()[0]


def _is_valid(archive: pathlib.Path) -> bool:
    return archive.is_file() and hashlib.sha256(archive.read_bytes()).hexdigest() == _pinned()[1]


def is_current() -> bool:
    return _is_valid(ur_rtde_archive())


def ensure(layout: Layout) -> None:
    archive = ur_rtde_archive()
    if _is_valid(archive):
        return
    if archive.exists():
        console.line(f"    {archive.relative_to(ROOT)} is damaged; downloading it again")
        archive.unlink()
    console.step("Downloading the sources of ur_rtde")
    # --no-binary for this package only: pip prepares its metadata with build tools, which may be wheels.
    command = [str(layout.python), "-I", "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps",
               "--no-binary", "ur-rtde", "--require-hashes", "--requirement", str(PIN), "--dest", str(DOWNLOADS)]
    for attempt in range(1, 4):
        result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                universal_newlines=True)
        if result.returncode == 0 and _is_valid(archive):
            return
        pins.fail_on_mismatch(PIN, result.stdout)
        if attempt < 3:
            time.sleep(3.0 * attempt)
    raise console.Failure(f"The sources of ur_rtde could not be downloaded in three attempts:\n{console.tail(result.stdout, 12)}\n"
                          "Check the network connection. pip's settings (`pip config list`) select a proxy or a mirror. "
                          f"On a machine without a network, copy the archive to {archive}.")
