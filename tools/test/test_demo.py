"""The demo as its user runs it, but for the build: pushes ignored, contact stops, both files written."""

import csv
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PNG = b"\x89PNG\r\n\x1a\n"


def demo(*arguments):
    env = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT / "tools"), os.environ.get("PYTHONPATH", "")])}
    return subprocess.run([sys.executable, "-m", "ur_tools.demo", *arguments], env=env, capture_output=True, text=True,
                          timeout=120)


def test_two_pushes_are_ignored_and_the_contact_stops_the_arm(tmp_path):
    result = demo("--address", os.environ.get("UR_TEST_ADDRESS", "127.0.1.201"), "--drop", "0.2", "--speed", "0.15",
                  "--output", str(tmp_path))
    assert result.returncode == 0, result.stdout + result.stderr
    assert result.stdout.count("ignored: ") == 2
    assert "success (0)" in result.stdout and "standstill" in result.stdout
    assert (tmp_path / "force_experiment.png").read_bytes().startswith(PNG)
    with (tmp_path / "force_experiment.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["event"] for row in rows if row["event"]] == ["ignored x", "ignored y", "stop z"]
    assert max(abs(float(rows[-1][joint])) for joint in ("shoulder_lift", "elbow", "wrist_1")) < 0.01


def test_options_out_of_range_are_named_with_their_limits():
    result = demo("--threshold", "1000")
    assert result.returncode == 2
    assert "--threshold 1000: must be from 5 to 100" in result.stderr


def test_help_explains_the_options():
    result = demo("--help")
    assert result.returncode == 0
    for option in ("--model", "--threshold", "--speed", "--keep-running"):
        assert option in result.stdout
