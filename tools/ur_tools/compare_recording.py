"""./ur compare-recording FILE: compares a recording of a robot with the simulator.

Finds the motions in the targets of the recording. A movej or movel is recognized by its speed, with velocity and acceleration, and
executed in the simulator; any other motion is followed by servoj. Prints for the robot and for the simulator: duration and speed of the
target, lag and largest error of the joints, settling time, and the noise at rest.

    ./ur compare-recording run.csv --model ur5e
    ./ur compare-recording log.csv --model ur5e --column target_q=tq --column actual_q=q --rate 125 --output motion.png

FILE is a CSV file as of `ur record` or of UR's RTDE client library: separated by commas or spaces, with the columns timestamp,
target_q_0 to target_q_5 and actual_q_0 to actual_q_5; it may have target_qd, actual_qd, actual_current, actual_TCP_force, ...
"""

import argparse
import os
import pathlib
import sys
from typing import List

from . import simulation
from .environment import program, run_environment
from .layout import PROGRAM, ROOT, Layout
from .processes import Programs

LIMIT = 3600.0  # s: the simulator takes as long as the robot did


def parse(arguments: List[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog=f"{PROGRAM} compare-recording", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=pathlib.Path, help="recording of a robot, CSV")
    parser.add_argument("--model", type=str.lower, choices=simulation.MODELS, required=True, metavar="MODEL",
                        help="the robot: " + ", ".join(simulation.MODELS))
    parser.add_argument("--column", action="append", default=[], metavar="OUTPUT=COLUMN",
                        help="an output that has another name in the file, a vector without the number of the element; repeatable")
    parser.add_argument("--rate", type=float, metavar="HZ", help="rows per second, if the file has no time stamps")
    parser.add_argument("--output", type=pathlib.Path, metavar="FILE", help="draw the first motion of both: png, pdf or svg")
    options = parser.parse_args(arguments)
    if options.rate is not None and not 1.0 <= options.rate <= 1000.0:
        parser.error(f"--rate {options.rate:g}: must be from 1 to 1000")
    return options


def packages(_options: argparse.Namespace) -> List[str]:
    return ["ur_ros_rtde_cli", "ur_simulator"]


def run(options: argparse.Namespace, layout: Layout) -> int:
    env = {**run_environment(layout), "PYTHONDONTWRITEBYTECODE": "1",
           "UR_SIMULATOR_PROGRAM": str(program(layout, "ur_simulator", "ur_simulator"))}
    env["PYTHONPATH"] = os.pathsep.join([str(ROOT / "ur_simulator" / "python"), env["PYTHONPATH"]])
    command = [layout.python, ROOT / "compare_recording" / "robot_comparison.py", options.file, "--model", options.model]
    command += [part for pair in options.column for part in ("--column", pair)]
    command += ["--rate", options.rate] if options.rate is not None else []
    command += ["--output", options.output] if options.output is not None else []
    with Programs(layout.log / "compare_recording") as programs:
        return programs.run([str(part) for part in command], env, LIMIT)


if __name__ == "__main__":
    sys.exit(simulation.main(parse, run))
