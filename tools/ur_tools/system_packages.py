"""Packages of the operating system that the build needs."""

import os
import pathlib
import shutil
import subprocess
from typing import Dict, List, Tuple

from . import console
from .layout import ROOT

LIST = ROOT / "tools" / "system_packages.txt"
SECONDS = 60.0  # to download and install them


def needed(file: pathlib.Path = LIST) -> List[str]:
    lines = (line.split("#")[0].strip() for line in file.read_text().splitlines())
    return [line for line in lines if line]


def missing(names: List[str]) -> List[str]:
    result = subprocess.run(["dpkg-query", "-W", "-f=${Package} ${db:Status-Status}\n", *names],
                            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, universal_newlines=True)
    installed = {line.split()[0] for line in result.stdout.splitlines() if line.endswith(" installed")}
    return [name for name in names if name not in installed]


def _prefix() -> List[str]:
    """Returns the prefix that runs a command as root without a prompt. Raises PermissionError if there is none."""
    if os.geteuid() == 0:
        return []
    if shutil.which("sudo") and subprocess.run(["sudo", "-n", "true"], stderr=subprocess.DEVNULL).returncode == 0:
        return ["sudo", "-n"]
    raise PermissionError


def absent() -> List[str]:
    """Returns the packages to install; an empty list without dpkg."""
    return missing(needed()) if shutil.which("dpkg-query") else []


def _run(command: List[str], env: Dict[str, str]) -> Tuple[int, str]:
    """Shows what a program prints while it runs. Returns its exit status and output."""
    status, lines = console.Status(), []
    with subprocess.Popen(command, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True,
                          errors="replace") as process:
        assert process.stdout is not None
        for line in process.stdout:
            lines.append(line)
            status.show(line.rstrip())
    status.clear()
    return process.returncode, "".join(lines)


def ensure() -> None:
    if not shutil.which("dpkg-query"):
        console.line("    this machine has no dpkg: the equivalents of these Debian packages must be installed: " + " ".join(needed()))
        return
    names = absent()
    if not names:
        return
    command = "apt-get install -y --no-install-recommends " + " ".join(names)
    try:
        prefix = _prefix()
    except PermissionError:
        raise console.Failure(f"These system packages are missing. Install them, then run ./ur again:\n\n    sudo {command}\n") from None
    console.step("Installing system packages: " + " ".join(names))
    env = dict(os.environ, DEBIAN_FRONTEND="noninteractive")
    if prefix:
        prefix = prefix + ["env", "DEBIAN_FRONTEND=noninteractive"]
    for part in ("apt-get update", command):
        returncode, output = _run(prefix + part.split(), env)
    if returncode != 0:
        raise console.Failure(f"`{command}` failed:\n{console.tail(output, 15)}\n"
                              "Check the network connection and the package sources of this machine.")
