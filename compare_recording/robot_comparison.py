"""Compares the recording of a robot with the simulator; ./ur compare-recording runs it."""

import argparse
import os
import pathlib
import sys
from typing import Dict, List, Sequence

from moves import Move, recognize
from replay import record
from robot_recording import ACTUAL, TARGET, TARGET_SPEED, Motion, motions, period, read, with_rest
from rows import Row, motion_rows, noise_rows, pose_row, time_rows
from ur_ros_rtde_cli.errors import CliError
from ur_ros_rtde_cli.recording import Recording
from ur_ros_rtde_cli.recording_comparison import compare
from ur_ros_rtde_cli.recording_figure import draw
from ur_ros_rtde_cli.robot_check.connection import ConnectionFailure
from ur_ros_rtde_description.kinematics import nominal_origins
from ur_ros_rtde_description.models import find_model
from ur_simulator.robot import SimulatedRobot, SimulatorError

DRAWN = (TARGET, TARGET_SPEED, ACTUAL, "actual_qd", "actual_current", "actual_TCP_force")
LARGEST_CALIBRATION = 0.01  # m, by which a calibrated arm deviates from the nominal kinematics
LONGEST = 60.0  # s of a motion
STANDSTILL = "  sleep(1.0)\n"
OVERHEAD = 2.0  # s of the simulator for each motion


def parse(arguments: List[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    parser.add_argument("file", type=pathlib.Path)
    parser.add_argument("--model", required=True)
    parser.add_argument("--column", action="append", default=[])
    parser.add_argument("--rate", type=float)
    parser.add_argument("--output", type=pathlib.Path)
    return parser.parse_args(arguments)


def _target_row(robot: Recording, simulator: Recording) -> Row:
    difference = compare(robot, simulator, [TARGET], None).differences[TARGET]
    return Row("largest difference of the targets", "rad", None, float(difference.largest.max()))


def _print(title: str, rows: List[Row]) -> None:
    print(f"\n{title}")
    for row in rows:
        print(row.text())


def _figure(output: pathlib.Path, robot: Recording, simulator: Recording) -> None:
    names = [name for name in DRAWN if name in robot.outputs and name in simulator.outputs]
    comparison = compare(robot, simulator, names, compare(robot, simulator, [TARGET], None).shift)
    print(f"figure: {draw(comparison.first, output, comparison.second)}")


def _columns(pairs: List[str]) -> Dict[str, str]:
    for pair in pairs:
        if "=" not in pair:
            raise CliError(f"--column {pair}: write OUTPUT=COLUMN, for example target_q=tq")
    return dict(pair.split("=", 1) for pair in pairs)


def _announce(recording: Recording, found: Sequence[Motion]) -> None:
    seconds = sum(recording.times[motion.end] - recording.times[motion.begin] + OVERHEAD for motion in found)
    print(f"{recording.name}: {len(recording.times)} rows, {recording.times[-1]:.2f} s, {1.0 / period(recording):.0f} Hz, "
          f"motions: {len(found)}; the simulator needs about {seconds:.0f} s")
    print(f"  {'':34} {'robot':>10} {'simulator':>10} {'ratio':>8}")


def run(options: argparse.Namespace) -> None:
    recording = read(options.file, _columns(options.column), options.rate)
    origins = nominal_origins(find_model(options.model))
    found = motions(recording)
    _announce(recording, found)
    replays: List[Recording] = []

    def replay(row: int, script: str) -> Recording:
        joints = recording.outputs[TARGET][row]
        replays.append(record(simulator, joints, script, list(recording.outputs), 1.0 / period(recording), LONGEST))
        return replays[-1]

    with SimulatedRobot(options.model) as simulator:
        for number, motion in enumerate(found, start=1):
            around, within = with_rest(recording, motion)
            move = recognize(around, within, origins)
            replayed = replay(motion.begin, move.script)
            rows = [_target_row(around, replayed)] if isinstance(move, Move) else []
            _print(f"motion {number} at {recording.times[motion.begin]:.2f} s: {move}", rows + motion_rows(around, within, replayed))
            if number == 1 and options.output:
                _figure(options.output, around, replayed)
        first = replays[0] if replays else replay(0, STANDSTILL)
    poses = pose_row(recording, first, origins)
    _print("whole recording", time_rows(recording, first) + poses + noise_rows(recording, first))
    if any((row.robot or 0.0) > LARGEST_CALIBRATION for row in poses):
        print(f"\nThe TCP poses are not those of a {options.model}: is it another model, or did the TCP change?")


def main(arguments: List[str]) -> int:
    try:
        run(parse(arguments))
    except (CliError, ConnectionFailure, SimulatorError) as error:
        print(error, file=sys.stderr)
        return 1
    except BrokenPipeError:  # ./ur compare-recording run.csv | head
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 141
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
