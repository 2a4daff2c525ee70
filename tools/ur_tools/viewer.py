"""Builds, installs and starts the viewer: for view, `demo --view` and `plan --view`."""

import os
import pathlib
from typing import Mapping, Sequence

from . import build as building
from . import console
from .environment import program, run_environment
from .layout import Layout
from .processes import Program, Programs

PACKAGE = "ur_ros_rtde_viewer"
START_LIMIT = 60.0  # s


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
    programs.wait_until(lambda: "viewer runs at " in viewer.output, START_LIMIT, "the viewer")
    console.line(next(line for line in viewer.output.splitlines() if "viewer runs at " in line))
    return viewer
