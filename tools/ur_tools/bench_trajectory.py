"""./ur bench --trajectory: the planner's proof. Random paths: are all limits kept, how long does planning take? And the
durations beside independent solvers: copp-py with jerk limits, toppra without.
"""

import argparse
import pathlib
import subprocess
import sys
from typing import List

from . import build as building
from . import say
from .environment import run_environment
from .layout import ROOT, Layout

# Oracles only: nothing of the project needs them.
ORACLES = ("numpy==2.2.6", "scipy==1.15.3", "copp-py==0.2.3", "toppra==0.6.10")
# What, jerk limits or not, s between the oracle's stations. A solver that looks too seldom exceeds the limits between.
COMPARISONS = (("with jerk limits, against copp-py", "1", "0.006"), ("without, against toppra", "0", "0.003"))


def add_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("the planner of trajectories")
    group.add_argument("--trajectory", action="store_true", help="prove and measure the planner; nothing else is run")
    group.add_argument("--paths", type=int, default=1000, metavar="N",
                       help="random paths, with jerk limits and again without (default: 1000; the whole proof: 10000)")
    group.add_argument("--oracle", type=int, default=50, metavar="N",
                       help="paths whose duration is compared; copp-py takes some seconds each (default: 50; 0: none)")


def _oracle_python(layout: Layout) -> pathlib.Path:
    """Of an environment of the oracles' own."""
    folder = layout.base / "oracle"
    python = folder / "bin" / "python"
    stamp = folder / "ur_stamp.txt"
    if stamp.is_file() and stamp.read_text() == " ".join(ORACLES):
        return python
    say.step("Installing the oracles")
    for command in ([str(layout.python), "-m", "venv", "--clear", str(folder)],
                    [str(python), "-m", "pip", "install", "--disable-pip-version-check", "-q", *ORACLES]):
        result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        if result.returncode != 0:
            raise say.Failure(f"`{' '.join(command)}` failed:\n{say.tail(result.stdout, 10)}")
    stamp.write_text(" ".join(ORACLES))
    return python


def _run(command: List[str], env) -> None:
    if subprocess.run(command, env=env).returncode != 0:
        raise say.Failure(f"{pathlib.Path(command[0]).name} ended early, see above")


def run(options: argparse.Namespace, layout: Layout) -> int:
    building.build(building.Options(layout, ["ur_ros_rtde_trajectory"], True))
    env = run_environment(layout)
    programs = layout.build / "ur_ros_rtde_trajectory" / "test"
    say.step(f"Planning {options.paths} random paths, with jerk limits and without")
    sys.stdout.flush()
    _run([str(programs / "trajectory_bench"), str(options.paths)], env)
    if options.oracle <= 0:
        return 0
    python = _oracle_python(layout)
    for what, jerk, step in COMPARISONS:
        say.step(f"Durations of {options.oracle} paths {what}: ours by the oracle's, below 1 is shorter")
        sys.stdout.flush()
        paths = layout.log / "trajectory_paths.bin"
        paths.parent.mkdir(parents=True, exist_ok=True)
        _run([str(programs / "trajectory_export"), str(paths), "0", str(options.oracle), jerk, step], env)
        _run([str(python), str(ROOT / "ur_ros_rtde_trajectory" / "test" / "trajectory" / "oracle.py"), str(paths)], {})
        paths.unlink()
    return 0
