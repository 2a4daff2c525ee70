"""Executes a script in the simulator, and records it as the robot's motion was."""

from typing import Any, Callable, Dict, List, Sequence

import numpy as np
from robot_recording import SETTLED
from ur_ros_rtde_cli.errors import CliError
from ur_ros_rtde_cli.recording import TIME, Recording
from ur_ros_rtde_cli.robot_check.rtde import Rtde
from ur_simulator.robot import SimulatedRobot

LIMIT = 5.0  # s, of an answer
REST_BEFORE = 1.0  # s at rest before the move, for the noise
PROGRAM_STATE, PLAYING = "runtime_state", 2


def record(robot: SimulatedRobot, first: Sequence[float], script: str, outputs: Sequence[str], frequency: float,
           most: float) -> Recording:
    """`first`: rad, joints at the begin; `script`: the lines of a program, which may run for `most` s. Ends SETTLED s after it."""
    robot.control("set_joints", joints=list(map(float, first)))
    with Rtde(robot.address, LIMIT) as rtde:
        names = rtde.set_outputs(list(dict.fromkeys([TIME, PROGRAM_STATE, *outputs])), frequency)
        rtde.start()
        rows = _until(rtde, lambda row, begin: row[TIME] > begin + REST_BEFORE)
        robot.control("run_script", script=f"def recorded_motion():\n{script}end\n")
        rows += _until(rtde, lambda row, begin: row[PROGRAM_STATE] == PLAYING or row[TIME] > begin + LIMIT)
        if rows[-1][PROGRAM_STATE] != PLAYING:
            raise CliError(f"the simulator has not started the program within {LIMIT:g} s:\n{script}")
        rows += _until(rtde, lambda row, begin: row[PROGRAM_STATE] != PLAYING or row[TIME] > begin + most)
        if rows[-1][PROGRAM_STATE] == PLAYING:
            raise CliError(f"the program still runs after {most:g} s:\n{script}")
        rows += _until(rtde, lambda row, begin: row[TIME] > begin + SETTLED + 1.0 / frequency)
    columns: Dict[str, np.ndarray] = {name: np.array([np.atleast_1d(row[name]) for row in rows], float) for name in names}
    times = columns.pop(TIME)[:, 0]
    return Recording("simulator", times - times[0], columns, [])


def _until(rtde: Rtde, done: Callable[[Dict[str, Any], float], bool]) -> List[Dict[str, Any]]:
    """Returns the rows up to the first for which `done(row, time of the first row)`."""
    rows = [rtde.values()]
    while not done(rows[-1], rows[0][TIME]):
        rows.append(rtde.values())
    return rows
