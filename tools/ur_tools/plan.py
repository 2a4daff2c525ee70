"""./ur plan FILE: plans a trajectory without a robot, and says how long it takes and how much of the limits it uses.

FILE is YAML with the fields of a goal of execute_trajectory (model, waypoints, max_velocity, max_acceleration, max_jerk,
speed_fraction, blend_tolerance), or with points of their own times:

    model: ur10e                                        |    model: ur10e
    blend_tolerance: 0.05                               |    points:
    waypoints:                                          |      - {time: 0.0, positions: [0, -1.57, 1.57, -1.57, -1.57, 0]}
      - [0.0, -1.57, 1.57, -1.57, -1.57, 0.0]           |      - {time: 2.0, positions: [1, -1.20, 1.30, -1.57, -1.57, 0]}
      - [1.0, -1.20, 1.30, -1.57, -1.57, 0.0]           |

A plan that would exceed a limit is refused with the first one.
"""

import argparse
import json
import pathlib
import subprocess
import sys
from typing import List

from . import cell, say
from .environment import program, run_environment
from .layout import PROGRAM, ROOT, Layout


def parse(arguments: List[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog=f"{PROGRAM} plan", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=pathlib.Path, help="the goal as YAML")
    parser.add_argument("--plot", type=pathlib.Path, metavar="PNG",
                        help="draw positions, velocities, accelerations and jerks against their limits")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="write the plan's samples")
    return parser.parse_args(arguments)


def _run(command: List[str], text: str, env) -> str:
    result = subprocess.run(command, input=text, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            universal_newlines=True)
    if result.returncode != 0:
        raise say.Failure(result.stderr.strip())
    return result.stdout


def _as_json(layout: Layout, file: pathlib.Path, env) -> str:
    """By the Python of the build: the one that runs this need not have a YAML parser."""
    code = "import json, sys, yaml; print(json.dumps(yaml.safe_load(sys.stdin)))"
    try:
        text = file.read_text()
    except OSError as error:
        raise say.Failure(f"{file}: {error.strerror}") from None
    return _run([str(layout.python), "-c", code], text, env)


def run(options: argparse.Namespace, layout: Layout) -> int:
    env = {**run_environment(layout), "PYTHONDONTWRITEBYTECODE": "1"}
    answer = _run([str(program(layout, "ur_ros_rtde", "plan_trajectory"))], _as_json(layout, options.file, env), env)
    plan = json.loads(answer)
    use = plan["use"]
    say.line(f"{len(plan['waypoint_times'])} waypoints, {plan['duration']:.3f} s, planned in "
             f"{1e3 * plan['planning_time']:.1f} ms")
    say.line(f"largest use of the limits: velocity {use['velocity']:.4f}, acceleration {use['acceleration']:.4f}, "
             f"jerk {use['jerk']:.4f}")
    if options.json:
        options.json.write_text(answer)
        say.line(f"samples: {options.json}")
    if options.plot:
        _run([str(layout.python), str(ROOT / "tools" / "ur_tools" / "plan_figure.py"), str(options.plot)], answer, env)
        say.line(f"figure: {options.plot}")
    return 0


if __name__ == "__main__":
    sys.exit(cell.main(parse, run))
