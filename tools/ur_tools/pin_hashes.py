"""./ur lock: asks the registry for the hashes of all files that the supported machines install, and writes them to wheels/*.txt."""

import argparse
import json
import pathlib
import re
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any, Dict, List, Set, Tuple

from . import console, pins, venv

FILES = tuple(sorted(path.stem for path in pins.FOLDER.glob("*.txt")))
SOURCES = ("ur_rtde",)  # files whose packages are source archives, the same for all machines
OF_WHEELS = ("jazzy", "kilted", "libraries", "oracle")  # exist for one processor
# Used with every Python that a supported ROS has; the others with those of the wheels.
OF_INSTALLED_ROS = ("browser", "docs", "tools", "viewer")
# Of the oldest supported system, Ubuntu 22.04. Newer systems install the same files.
GLIBC = 35
OLDEST_GLIBC = {"x86_64": 5, "aarch64": 17}
CONNECTIONS = 4  # pips that ask the registry at the same time

Hashes = Dict[Tuple[str, str], Set[str]]  # by normalized name and version


@dataclass(frozen=True)
class Machine:
    python: Tuple[int, int]
    processor: str

    def __str__(self) -> str:
        return f"Python {self.python[0]}.{self.python[1]} on {self.processor}"

    @property
    def options(self) -> List[str]:
        """The options with which pip selects the files of this machine. Files for older versions of glibc are accepted, too."""
        glibc = range(GLIBC, OLDEST_GLIBC[self.processor] - 1, -1)
        platforms = [f"--platform=manylinux_2_{minor}_{self.processor}" for minor in glibc]
        platforms += [f"--platform={name}_{self.processor}" for name in ("manylinux2014", "linux")]
        return ["--implementation=cp", f"--python-version={self.python[0]}.{self.python[1]}", *platforms]


def machines(name: str) -> List[Machine]:
    """Returns the machines on which this file of wheels/ is installed."""
    newest = venv.NEWEST if name in OF_INSTALLED_ROS else venv.SUPPORTED[1]
    minors = range(venv.SUPPORTED[0][1], newest[1] + 1)
    processors = ["x86_64"] if name in OF_WHEELS else list(OLDEST_GLIBC)
    return [Machine((3, minor), processor) for minor in minors for processor in processors]


def _report(python: pathlib.Path, folder: pathlib.Path, wanted: List[pins.Pin], options: List[str], what: str) -> List[Dict[str, Any]]:
    """Returns what pip says about the files that it would install."""
    requirements, report = folder / f"{what}.txt", folder / f"{what}.json"
    requirements.write_text("".join(f"{pin.requirement}\n" for pin in wanted))
    # pip compares Requires-Python with the Python that runs it; _check_python() compares it with that of the machine.
    command = [str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input", "--dry-run",
               "--ignore-installed", "--ignore-requires-python", "--no-deps", f"--target={folder}", *options, f"--report={report}",
               f"--requirement={requirements}"]
    result = subprocess.run(command, env=pins.environment(), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            universal_newlines=True)
    if result.returncode != 0:
        raise console.Failure(f"pip found no files for {what}:\n{console.tail(result.stdout, 10)}\n"
                              "`pip install --report` needs pip 22.2: with an older one, choose another Python with UR_PYTHON.")
    return list(json.loads(report.read_text())["install"])


def _check_python(item: Dict[str, Any], machine: Machine) -> None:
    metadata = item["metadata"]
    needed = re.search(r">= *3\.(\d+)(?:\.(\d+))?", metadata.get("requires_python", ""))
    if needed and (int(needed.group(1)), int(needed.group(2) or 0)) > (machine.python[1], 0):
        raise console.Failure(f"{metadata['name']} {metadata['version']} needs Python {metadata['requires_python']}: pin an older version "
                              f"for Python {machine.python[0]}.{machine.python[1]}, with a marker such as "
                              f"`; python_version < \"3.{needed.group(1)}\"`.")


def _files_of(python: pathlib.Path, folder: pathlib.Path, name: str, wanted: List[pins.Pin], machine: Machine) -> List[Dict[str, Any]]:
    here = [pin for pin in wanted if pin.is_for(machine.python)]
    found = _report(python, folder, here, machine.options, f"{name} with {machine}")
    for item in found:
        _check_python(item, machine)
    return found


def _hashes(python: pathlib.Path, folder: pathlib.Path, name: str, wanted: List[pins.Pin]) -> Hashes:
    """Returns the hashes for all machines of this file."""
    if name in SOURCES:
        files = _report(python, folder, wanted, [f"--no-binary={','.join(pin.name for pin in wanted)}"], f"{name} as sources")
    else:
        with ThreadPoolExecutor(CONNECTIONS) as pool:
            reports = [pool.submit(_files_of, python, folder, name, wanted, machine) for machine in machines(name)]
        files = [item for report in reports for item in report.result()]
    found: Hashes = {}
    for item in files:
        key = pins.normalized(item["metadata"]["name"]), item["metadata"]["version"]
        found.setdefault(key, set()).add(item["download_info"]["archive_info"]["hashes"]["sha256"])
    return found


def lock(name: str, python: pathlib.Path, folder: pathlib.Path) -> int:
    """Writes the hashes to this file of wheels/. Returns the number of packages whose hashes have changed."""
    file = pins.FOLDER / f"{name}.txt"
    before = pins.read(file)
    found = _hashes(python, folder, name, before)
    unused = [pin for pin in before if (pins.normalized(pin.name), pin.version) not in found]
    if unused:
        raise console.Failure(f"wheels/{name}.txt: no supported machine installs {unused[0].requirement}; {unused[0].marker}. Remove it.")
    after = [replace(pin, hashes=tuple(sorted(found[pins.normalized(pin.name), pin.version]))) for pin in before]
    pins.write(file, after)
    return sum(old != new for old, new in zip(before, after))


def run(options: argparse.Namespace) -> int:
    unknown = sorted(set(options.files) - set(FILES))
    if unknown:
        raise console.Failure(f"there is no wheels/{unknown[0]}.txt; there are: {', '.join(FILES)}")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([venv.find_python(), "-m", "venv", str(folder / "venv")], check=True)
        for file in options.files or FILES:
            console.step(f"Asking for the hashes of wheels/{file}.txt")
            changed = lock(file, folder / "venv" / "bin" / "python", folder)
            console.line(f"    {changed} package{'s' * (changed != 1)} changed")
    return 0
