"""Builds, installs and starts the viewer: for view, `demo --view` and `plan --view`."""

import os
import pathlib
import re
import time
import webbrowser
from typing import Mapping, Sequence

from . import build as building
from . import console
from .environment import program, run_environment
from .layout import Layout
from .processes import Program, Programs

PACKAGE = "ur_ros_rtde_viewer"
START_TIMEOUT = 60.0  # s
READY = re.compile(r"The viewer runs at (\S+) until Ctrl-C\.")
CONNECTED = "A browser shows the page."


def prepare(layout: Layout, jobs: int = 0) -> pathlib.Path:
    """Returns the program of the viewer. Builds it only if it is missing, because the driver may be running."""
    try:
        viewer = program(layout, PACKAGE, "view")
    except FileNotFoundError:
        building.build(building.Options(layout, [PACKAGE], False, jobs))
        viewer = program(layout, PACKAGE, "view")
    building.setup_viewer(layout)
    return viewer


def execute(layout: Layout, arguments: Sequence[str], jobs: int = 0) -> None:
    """Replaces this process by the viewer."""
    viewer = prepare(layout, jobs)
    os.execve(viewer, [str(viewer), *arguments], run_environment(layout))


def start(programs: Programs, layout: Layout, env: Mapping[str, str], *arguments: str) -> Program:
    """Returns when the page is served, and prints its address."""
    viewer = programs.start("viewer", [str(program(layout, PACKAGE, "view")), *arguments], env)
    programs.wait_until(lambda: READY.search(viewer.output) is not None, START_TIMEOUT, "the viewer")
    console.line(f"The viewer runs at {address(viewer)} until Ctrl-C.")
    return viewer


def address(viewer: Program) -> str:
    """Returns the address of the page of a viewer that has started."""
    found = READY.search(viewer.output)
    assert found is not None
    return found.group(1)


def show_page(programs: Programs, viewer: Program, limit: float) -> None:
    """Opens the page if this machine has a display, and waits up to `limit` s until a browser shows it."""
    if os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"):
        webbrowser.open(address(viewer))
    console.line(f"Open the page in a browser. The demo continues when it is open, or in {limit:g} s.")
    end = time.monotonic() + limit
    while CONNECTED not in viewer.output and time.monotonic() < end:
        programs.check()
        time.sleep(0.1)
