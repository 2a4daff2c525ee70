"""`ur compare` finds the shift between two recordings, and how far their outputs differ."""

import numpy as np
import pytest
from ur_ros_rtde_cli import main
from ur_ros_rtde_cli.recording import Recording
from ur_ros_rtde_cli.recording_comparison import compare

BACKGROUND = True


def recording(name, start, error=0.0, rate=500.0):
    """A move of joint 0 by 1 rad from `start` s to `start` + 2 s, first too far by `error`, then not far enough."""
    times = np.arange(0.0, 5.0, 1.0 / rate)
    phase = np.clip((times - start) / 2.0, 0.0, 1.0)
    joint = 0.5 - 0.5 * np.cos(np.pi * phase) + error * np.sin(2.0 * np.pi * phase)
    joints = np.stack([joint, np.zeros_like(joint)], axis=1)
    return Recording(name, times, {"actual_q": joints, "robot_mode": np.full((len(times), 1), 7.0)}, [])


def test_finds_the_shift_and_the_difference():
    comparison = compare(recording("a", 1.0), recording("b", 1.7, error=0.01, rate=125.0), [], None)
    assert comparison.shift == pytest.approx(-0.7, abs=0.005)
    difference = comparison.differences["actual_q"]
    assert difference.largest[0] == pytest.approx(0.01, rel=0.1) and min(abs(difference.at[0] - at) for at in (1.5, 2.5)) < 0.1
    assert 0.0 < difference.rms[0] < difference.largest[0] and difference.largest[1] == difference.rms[1] == 0.0
    assert comparison.differences["robot_mode"].largest[0] == 0.0


@pytest.mark.parametrize("is_first", [True, False])
def test_finds_a_short_recording_in_a_long_one(is_first):
    whole, part = recording("a", 1.0), recording("b", 1.0)
    rows = slice(800, 950)  # 1.6 to 1.9 s
    part = Recording("b", part.times[rows] - part.times[800], {name: values[rows] for name, values in part.outputs.items()}, [])
    comparison = compare(part, whole, ["actual_q"], None) if is_first else compare(whole, part, ["actual_q"], None)
    assert comparison.shift == pytest.approx(-1.6 if is_first else 1.6, abs=0.005)


def test_equal_recordings_do_not_differ():
    comparison = compare(recording("a", 1.0), recording("b", 1.0), ["actual_q"], None)
    assert comparison.shift == pytest.approx(0.0, abs=1e-9) and comparison.differences["actual_q"].largest[0] < 1e-9


def test_a_given_shift_is_used():
    assert compare(recording("a", 1.0), recording("b", 1.5), [], 0.0).differences["actual_q"].largest[0] > 0.3


def write(path, *columns):
    rows = [[0.1 * i, *(i for _ in columns)] for i in range(20)]
    path.write_text("\n".join(",".join(map(str, row)) for row in (["timestamp", *columns], *rows)) + "\n")


def test_prints_a_table_and_draws_both(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "a.csv", "speed_scaling", "height")
    write(tmp_path / "b.csv", "height")
    assert main.main(["compare", "a.csv", "b.csv"]) == 0
    printed = capsys.readouterr().out
    assert "b.csv is moved by +0.000 s; 20 rows of a.csv are compared" in printed and printed.splitlines()[-1] == "a_b.png"
    assert any(line.split() == ["height", "0", "0.000", "0", "m"] for line in printed.splitlines()), printed
    assert (tmp_path / "a_b.png").stat().st_size > 10000


@pytest.mark.parametrize("columns, arguments, message", [
    (["other"], [], "a.csv and b.csv have no output in common: height; other"),
    (["height"], ["speed"], "a.csv has no output speed. It has: height"),
    (["height_0", "height_1"], ["height"], "height has 1 elements in a.csv, 2 in b.csv"),
    (["height"], ["--shift", "100"], "the recordings do not overlap in time with --shift 100"),
])
def test_reports_what_cannot_be_compared(tmp_path, monkeypatch, capsys, columns, arguments, message):
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "a.csv", "height")
    write(tmp_path / "b.csv", *columns)
    assert main.main(["compare", "a.csv", "b.csv", *arguments]) == 2
    assert message in capsys.readouterr().err


def test_rejects_time_that_goes_back(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "a.csv", "height")
    (tmp_path / "b.csv").write_text("timestamp,height\n0,1\n0.5,1\n0.2,1\n")
    assert main.main(["compare", "a.csv", "b.csv"]) == 2
    assert "b.csv: the time of row 3 is earlier than that of the row before" in capsys.readouterr().err
