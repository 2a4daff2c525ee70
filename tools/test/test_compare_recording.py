"""./ur compare-recording with recordings of an ideal robot, whose motions are computed here."""

import os
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest
from ur_ros_rtde_description.kinematics import flange_pose, nominal_origins
from ur_ros_rtde_description.models import find_model

ROOT = pathlib.Path(__file__).parents[2]
HOME = np.array([0.3, -1.4, 1.6, -1.8, -1.5, 0.2])  # rad
PERIOD, REST, LAG = 0.008, 1.0, 0.5e-3  # s
START_RAMP = 0.16  # s
SPEED, ACCELERATION = 1.05, 1.4


def way(times, distance, velocity, acceleration):
    """Returns the way of a trapezoid of the speed that starts a program, in steps of 1/20 period, by integration."""
    fine = np.arange(0.0, times[-1] + PERIOD, PERIOD / 20)
    trajectory_time = np.concatenate(([0.0], np.cumsum(np.minimum((fine[:-1] + PERIOD / 40) / START_RAMP, 1.0)) * PERIOD / 20))
    duration = distance / velocity + velocity / acceleration
    speed = np.minimum(np.minimum(acceleration * trajectory_time, velocity), acceleration * np.maximum(duration - trajectory_time, 0.0))
    path = np.concatenate(([0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(trajectory_time))))
    return np.interp(times, fine, path)


def joints_of(origins, pose, seed):
    """Returns the joints of a flange pose by Newton's method."""
    joints = seed.copy()
    for _ in range(20):
        def error(values):
            return (flange_pose(origins, values)[:3] - pose[:3]).ravel()
        slopes = np.stack([(error(joints + step) - error(joints - step)) / 2e-6 for step in 1e-6 * np.eye(6)], axis=1)
        joints = joints - np.linalg.lstsq(slopes, error(joints), rcond=None)[0]
    return joints


def write(path, targets, separator=",", names=("timestamp", "target_q", "actual_q"), rest=REST):
    """Writes a recording of these targets, between two rests."""
    count = round(rest / PERIOD)
    targets = np.concatenate((np.repeat(targets[:1], count, axis=0), targets, np.repeat(targets[-1:], count, axis=0)))
    random = np.random.default_rng(1)
    speeds = np.gradient(targets, PERIOD, axis=0)
    actual = targets - LAG * speeds + random.normal(0.0, 1.7e-5, targets.shape)
    header = [names[0]] + [f"{name}_{joint}" for name in names[1:] for joint in range(6)]
    rows = np.column_stack((PERIOD * np.arange(len(targets)), targets, actual))
    np.savetxt(path, rows, "%.8f", separator, header=separator.join(header), comments="")
    return path


def compare(*arguments):
    env = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT / "tools"), os.environ.get("PYTHONPATH", "")])}
    result = subprocess.run([sys.executable, "-u", "-m", "ur_tools.compare_recording", *map(str, arguments)], env=env,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=100)
    return result.returncode, result.stdout


def figures(printed, name):
    """Returns what the row of this name contains for robot and simulator."""
    found = re.search(rf"^ +{re.escape(name)} +(\S+) +(\S+)", printed, re.MULTILINE)
    assert found, printed
    return [None if text == "-" else float(text) for text in found.groups()]


def movej(distance=0.8):
    times = np.arange(0.0, 3.0, PERIOD)
    direction = np.array([1.0, -0.5, 0.25, 0.0, 0.1, -0.9])
    return HOME + way(times, distance, SPEED, ACCELERATION)[:, None] * direction


def test_a_movej_is_recognized_and_the_simulator_moves_as_the_robot(tmp_path):
    code, printed = compare(write(tmp_path / "movej.csv", movej()), "--model", "ur5e", "--output", tmp_path / "motion.png")
    assert code == 0, printed
    found = re.search(r"movej, a=(\S+) rad/s², v=(\S+) rad/s, at the start of a program", printed)
    assert found, printed
    assert float(found[1]) == pytest.approx(ACCELERATION, rel=0.01) and float(found[2]) == pytest.approx(SPEED, rel=0.001)
    assert figures(printed, "largest difference of the targets")[1] < 1e-3
    robot, simulator = figures(printed, "lag of the joints")
    assert robot == pytest.approx(0.5, abs=0.05) and 0.7 < simulator / robot < 1.3
    robot, simulator = figures(printed, "noise actual_q 0-2")
    assert 1 / 1.5 < simulator / robot < 1.5
    assert (tmp_path / "motion.png").stat().st_size > 10000


def test_a_movel_is_recognized(tmp_path):
    origins = nominal_origins(find_model("ur5e"))
    start = flange_pose(origins, HOME)
    targets = [HOME]
    for height in way(np.arange(0.0, 2.0, PERIOD), 0.1, 0.1, 0.5):
        pose = start.copy()
        pose[2, 3] -= height
        targets.append(joints_of(origins, pose, targets[-1]))
    code, printed = compare(write(tmp_path / "movel.csv", np.array(targets)), "--model", "ur5e")
    assert code == 0, printed
    found = re.search(r"movel, a=(\S+) m/s², v=(\S+) m/s", printed)
    assert found and float(found[1]) == pytest.approx(0.5, rel=0.02) and float(found[2]) == pytest.approx(0.1, rel=0.002), printed
    assert figures(printed, "largest difference of the targets")[1] < 1e-3


def test_another_motion_is_followed_by_servoj_from_a_file_with_other_names(tmp_path):
    times = np.arange(0.0, 2.0, PERIOD)
    curve = HOME + 0.2 * np.stack([(1.0 - np.cos(np.pi * (1 + joint % 2) * times)) for joint in range(6)], axis=1)
    file = write(tmp_path / "curve.txt", curve, separator=" ", names=("clock", "tq", "q"))
    code, printed = compare(file, "--model", "ur5e", "--column", "target_q=tq", "--column", "actual_q=q", "--rate", "125")
    assert code == 0 and "the simulator follows it by servoj" in printed, printed
    robot, simulator = figures(printed, "lag of the joints")
    assert 0.7 < simulator / robot < 1.3


def test_the_noise_of_a_standstill_is_compared(tmp_path):
    code, printed = compare(write(tmp_path / "rest.csv", np.repeat(HOME[None], 200, axis=0)), "--model", "ur5e")
    assert code == 0 and "motions: 0" in printed, printed
    robot, simulator = figures(printed, "noise actual_q 0-2")
    assert 1 / 1.5 < simulator / robot < 1.5


def test_time_stamps_that_do_not_increase_are_rejected_with_the_remedy(tmp_path):
    file = write(tmp_path / "whole_seconds.csv", movej())
    file.write_text(re.sub(r"^(\d+)\.\d+", r"\1", file.read_text(), flags=re.MULTILINE))
    code, printed = compare(file, "--model", "ur5e")
    assert code == 1 and "time stamps that do not increase from row to row: give the rows per second with --rate" in printed


@pytest.mark.parametrize("arguments, text", [
    ((), "has no target_q_0 to target_q_5: name the columns with --column target_q=COLUMN. It has: tq, actual_q"),
    (("--column", "target_q"), "--column target_q: write OUTPUT=COLUMN, for example target_q=tq"),
])
def test_a_file_without_targets_is_rejected_with_the_remedy(tmp_path, arguments, text):
    file = write(tmp_path / "other.csv", movej(), names=("timestamp", "tq", "actual_q"))
    code, printed = compare(file, "--model", "ur5e", *arguments)
    assert code == 1 and text in printed, printed


@pytest.mark.parametrize("arguments, text", [(("--rate", "0"), "--rate 0: must be from 1 to 1000"),
                                             (("--model", "ur6"), "invalid choice: 'ur6'")])
def test_a_wrong_option_is_rejected_before_anything_is_built(run_without_build, arguments, text):
    status, printed = run_without_build("compare-recording", "run.csv", "--model", "ur5e", *arguments)
    assert status == 2 and text in printed
