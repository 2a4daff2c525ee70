"""The Python packages in wheels/*.txt: their versions are written by hand, the hashes of their files by `./ur lock`."""

import os
import pathlib
import re
import subprocess
from dataclasses import dataclass
from typing import Dict, List, Tuple

from . import console
from .layout import ROOT

FOLDER = ROOT / "wheels"
_PIN = re.compile(r"^([A-Za-z0-9][\w.-]*)==([\w.+!]+)(?:\s*;\s*([^\\]*?))?\s*\\?$")
_HASH = re.compile(r"^ +--hash=sha256:([0-9a-f]{64})\s*\\?$")
_MARKER = re.compile(r'^python_version (<|==|>=) "3\.(\d+)"$')
# What pip prints about a file with another hash.
_MISMATCH = re.compile(r"^ +(\S+==\S+) from \S+.*\n((?: +Expected sha256 .*\n| +Expected +or .*\n)+) +Got +([0-9a-f]+)", re.M)


@dataclass(frozen=True)
class Pin:
    name: str
    version: str
    marker: str = ""  # for which versions of Python: python_version < "3.11"
    hashes: Tuple[str, ...] = ()  # SHA-256 of each file that may be installed

    @property
    def requirement(self) -> str:
        return f"{self.name}=={self.version}"

    def is_for(self, python: Tuple[int, int]) -> bool:
        if not self.marker:
            return True
        match = _MARKER.match(self.marker)
        assert match is not None  # read() has checked it
        minor = int(match.group(2))
        return {"<": python[1] < minor, "==": python[1] == minor, ">=": python[1] >= minor}[match.group(1)]

    @property
    def text(self) -> str:
        """Its lines in the file."""
        first = f"{self.requirement}; {self.marker}" if self.marker else self.requirement
        return " \\\n".join([first, *(f"    --hash=sha256:{digest}" for digest in self.hashes)]) + "\n"


def normalized(name: str) -> str:
    """Returns the name in the spelling that is the same for all spellings of a package."""
    return re.sub(r"[-_.]+", "-", name).lower()


def _pin(file: pathlib.Path, number: int, line: str) -> Pin:
    match = _PIN.match(line)
    if match is None or (match.group(3) and not _MARKER.match(match.group(3))):
        raise console.Failure(f"{file.name}:{number}: `{line}` is not a pinned package. Write it as `numpy==2.2.6`, or for some versions "
                              "of Python as `numpy==2.2.6; python_version < \"3.11\"`, with <, == or >=.")
    return Pin(match.group(1), match.group(2), match.group(3) or "")


def read(file: pathlib.Path) -> List[Pin]:
    pins: List[Pin] = []
    for number, line in enumerate(file.read_text().splitlines(), 1):
        found = _HASH.match(line)
        if found and pins:
            last = pins.pop()
            pins.append(Pin(last.name, last.version, last.marker, (*last.hashes, found.group(1))))
        elif line.strip() and not line.startswith("#"):
            pins.append(_pin(file, number, line))
    return pins


def write(file: pathlib.Path, pins: List[Pin]) -> None:
    """Replaces the packages. The comment at the beginning stays."""
    lines = file.read_text().splitlines(keepends=True)
    comment = [line for line in lines if line.startswith("#")]
    file.write_text("".join(comment) + "".join(pin.text for pin in pins))


class Mismatch(console.Failure):
    """pip received a file that is not pinned."""


def install_command(python: pathlib.Path, file: pathlib.Path) -> List[str]:
    """Returns the command with which pip installs exactly the files that the hashes name."""
    # Compiling the modules that are never imported would take a third of the time.
    return [str(python), "-m", "pip", "install", "--disable-pip-version-check", "--no-input", "--no-deps", "--no-compile",
            "--require-hashes", "--requirement", str(file)]


def environment() -> Dict[str, str]:
    """Returns the environment for pip."""
    # PYTHONPATH and PYTHONHOME belong to another environment; PIP_USER would prevent an installation into this one.
    env = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONHOME", "PIP_USER")}
    env["_ROS_WHEELS_BOOTSTRAP_COMPLETE"] = "1"
    return env


def install(python: pathlib.Path, file: pathlib.Path) -> None:
    result = subprocess.run(install_command(python, file), env=environment(), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, universal_newlines=True)
    if result.returncode != 0:
        fail_on_mismatch(file, result.stdout)
        raise console.Failure(f"The packages in wheels/{file.name} could not be installed: {console.tail(result.stdout, 3)}\n"
                              "Check the network connection. pip's settings (`pip config list`) select a proxy or a mirror.")


def fail_on_mismatch(file: pathlib.Path, output: str) -> None:
    """Raises Mismatch if pip, installing this file of wheels/, reports a package whose hash is another one."""
    found = _MISMATCH.search(output)
    if not found:
        return
    package, expected, received = found.groups()
    count = expected.count("\n")
    raise Mismatch(
        f"{package} was not installed: the file that pip received has the SHA-256 {received}, which is not "
        f"{'the one' if count == 1 else f'one of the {count}'} in wheels/{file.name}.\n"
        f"- After a change of the version: run `./ur lock {file.stem}`.\n"
        "- On a machine without one of the processors and versions of Python that wheels/ has files for: use one that has.\n"
        "- Otherwise the file was changed on its way here: check the mirror in pip's settings (`pip config list`), and empty pip's "
        "cache (`pip cache purge`).")
