"""./ur bench --trajectory: checks on random paths that the planner keeps all limits, measures the planning time, and compares
the durations with independent solvers: copp-py with jerk limits, toppra without.
"""

import argparse
import pathlib
import subprocess
import sys
from typing import List, Mapping

from . import build as building
from . import console, pins
from .environment import run_environment
from .layout import ROOT, Layout

REQUIREMENTS = ROOT / "wheels" / "oracle.txt"
# Name, jerk limits (0 or 1), s between the solver's grid points. On a coarse grid a solver exceeds the limits in between.
COMPARISONS = (("with jerk limits, against copp-py", "1", "0.006"), ("without, against toppra", "0", "0.003"))


def add_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("trajectory planner")
    group.add_argument("--trajectory", action="store_true", help="only check and measure the planner")
    group.add_argument("--paths", type=int, default=1000, metavar="N",
                       help="number of random paths, planned with and without jerk limits (default: 1000; for a thorough check: 10000)")
    group.add_argument("--oracle", type=int, default=50, metavar="N",
                       help="number of paths whose duration is compared; copp-py takes several seconds for each (default: 50; 0: none)")


def _oracle_python(layout: Layout) -> pathlib.Path:
    """Returns the Python of a virtual environment with the solvers, which is created if necessary."""
    folder = layout.base / "oracle"
    python = folder / "bin" / "python"
    stamp = folder / "ur_stamp.txt"
    if stamp.is_file() and stamp.read_text() == REQUIREMENTS.read_text():
        return python
    console.step("Installing the solvers")
    command = [str(layout.python), "-m", "venv", "--clear", str(folder)]
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
    if result.returncode != 0:
        raise console.Failure(f"`{' '.join(command)}` failed:\n{console.tail(result.stdout, 10)}")
    pins.install(python, REQUIREMENTS)
    stamp.write_text(REQUIREMENTS.read_text())
    return python


def _run(command: List[str], env: Mapping[str, str]) -> None:
    if subprocess.run(command, env=env).returncode != 0:
        raise console.Failure(f"{pathlib.Path(command[0]).name} failed, see above")


def run(options: argparse.Namespace, layout: Layout) -> int:
    building.build(building.Options(layout, ["ur_ros_rtde_trajectory"], True))
    env = run_environment(layout)
    programs = layout.build / "ur_ros_rtde_trajectory" / "test"
    console.step(f"Planning {options.paths} random paths, with jerk limits and without")
    sys.stdout.flush()
    _run([str(programs / "trajectory_bench"), str(options.paths)], env)
    if options.oracle <= 0:
        return 0
    python = _oracle_python(layout)
    for what, jerk, step in COMPARISONS:
        console.step(f"Durations of {options.oracle} paths {what}: ratio to the solver's, below 1 is shorter")
        sys.stdout.flush()
        paths = layout.log / "trajectory_paths.bin"
        paths.parent.mkdir(parents=True, exist_ok=True)
        _run([str(programs / "trajectory_export"), str(paths), "0", str(options.oracle), jerk, step], env)
        _run([str(python), str(ROOT / "ur_ros_rtde_trajectory" / "test" / "trajectory" / "oracle.py"), str(paths)], {})
        paths.unlink()
    return 0
