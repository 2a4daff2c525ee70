"""./ur plan FILE: plans a trajectory without a robot and prints its duration and the largest use of each limit.

FILE is a goal as YAML, as for `ur call ACTION --file FILE`. With the field trajectory it is a goal of
execute_parametrized_trajectory, otherwise of execute_trajectory. Fields that only affect the execution (start_tolerance,
gain, ...) are ignored.

    blend_tolerance: 0.05                                       |    trajectory:
    waypoints:                                                  |      points:
      - positions: [0.0, -1.57, 1.57, -1.57, -1.57, 0.0]        |        - positions: [0.0, -1.57, 1.57, -1.57, -1.57, 0.0]
      - positions: [1.0, -1.20, 1.30, -1.57, -1.57, 0.0]        |          time_from_start: {sec: 0}
                                                                |        - positions: [1.0, -1.20, 1.30, -1.57, -1.57, 0.0]
                                                                |          time_from_start: {sec: 2, nanosec: 500000000}

If the trajectory would exceed limits, it is rejected, and the first exceeded limit is printed.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import time
from typing import List, Mapping

from . import console, simulation, viewer
from .environment import program, run_environment
from .layout import PROGRAM, ROOT, Layout
from .processes import Programs

FIGURES = (".png", ".pdf", ".svg")


def parse(arguments: List[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog=f"{PROGRAM} plan", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=pathlib.Path, help="goal as YAML")
    parser.add_argument("--model", default="", metavar="MODEL",
                        help="model of the arm: ur3e, ur5e, ur10e, ... (default: the widest limits of all models)")
    parser.add_argument("--plot", type=pathlib.Path, metavar="FIGURE",
                        help=f"draw positions, velocities, accelerations and jerks against their limits: {', '.join(FIGURES)}")
    parser.add_argument("--view", action="store_true", help="animate the plan in the browser until Ctrl-C; needs --model")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="write the plan's samples")
    options = parser.parse_args(arguments)
    if options.view and not options.model:
        parser.error("--view shows an arm: state its model with --model, for example --model ur10e")
    if options.plot and options.plot.suffix not in FIGURES:
        parser.error(f"--plot {options.plot}: the name of a figure ends with {', '.join(FIGURES)}")
    return options


def check(options: argparse.Namespace) -> None:
    """Raises Failure if a file cannot be written."""
    for file in filter(None, (options.plot, options.json)):
        if not file.parent.is_dir():
            raise console.Failure(f"{file} cannot be written: there is no folder {file.parent}")


def _run(command: List[str], text: str, env: Mapping[str, str]) -> str:
    result = subprocess.run(command, input=text, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            universal_newlines=True)
    if result.returncode != 0:
        raise console.Failure(result.stderr.strip())
    return result.stdout


def _goal_as_json(layout: Layout, options: argparse.Namespace, env: Mapping[str, str]) -> str:
    """Converts the goal with the Python of the build: the Python that runs ./ur may lack YAML and the messages."""
    return _run([str(layout.python), str(ROOT / "tools" / "ur_tools" / "plan_goal.py"), str(options.file), options.model], "", env)


def run(options: argparse.Namespace, layout: Layout) -> int:
    env = {**run_environment(layout), "PYTHONDONTWRITEBYTECODE": "1"}
    goal = _goal_as_json(layout, options, env)
    try:
        answer = _run([str(program(layout, "ur_ros_rtde_trajectory", "plan_trajectory"))], goal, env)
    except console.Failure as failure:
        raise console.Failure(f"{options.file}: {failure}") from None
    plan = json.loads(answer)
    use = plan["use"]
    console.line(f"{len(plan['waypoint_times'])} waypoints, {plan['duration']:.3f} s, planned in "
                 f"{1e3 * plan['planning_time']:.1f} ms")
    console.line(f"largest use of the limits: velocity {use['velocity']:.4f}, acceleration {use['acceleration']:.4f}, "
                 f"jerk {use['jerk']:.4f}")
    if options.json:
        options.json.write_text(answer)
        console.line(f"samples: {options.json}")
    if options.plot:
        _run([str(layout.python), str(ROOT / "tools" / "ur_tools" / "plan_figure.py"), str(options.plot)], answer, env)
        console.line(f"figure: {options.plot}")
    if options.view:
        return _view(layout, options, answer, env)
    return 0


def _view(layout: Layout, options: argparse.Namespace, plan: str, env: Mapping[str, str]) -> int:
    """Runs the viewer until Ctrl-C."""
    with tempfile.TemporaryDirectory() as folder, Programs(layout.log / "plan") as programs:
        file = pathlib.Path(folder, options.file.stem + ".json")
        file.write_text(plan)
        shown = viewer.start(programs, layout, env, "--plan", str(file), "--model", options.model, "--port", "0")
        while shown.running:
            time.sleep(0.2)
        raise shown.failure()


if __name__ == "__main__":
    sys.exit(simulation.main(parse, run, check))
