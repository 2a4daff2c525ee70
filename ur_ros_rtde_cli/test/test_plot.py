"""`ur plot` reads recordings, draws their outputs, and reports what it cannot read."""

import pathlib

import numpy as np
import pytest
from ur_ros_rtde_cli import main
from ur_ros_rtde_cli.errors import CliError
from ur_ros_rtde_cli.recording import Recording
from ur_ros_rtde_cli.recording_figure import labels

BACKGROUND = True
HEADER = ["timestamp", *(f"actual_q_{joint}" for joint in range(6)), "robot_mode", "event"]


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "run.csv"
    rows = [[10.0 + 0.002 * i, *(0.1 * joint + 0.01 * i for joint in range(6)), 7, "contact" if i == 3 else ""] for i in range(5)]
    path.write_text("\n".join(",".join(map(str, row)) for row in (HEADER, *rows)) + "\n")
    return path


def test_reads_a_file_of_the_rtde_client_library(tmp_path):
    path = tmp_path / "robot_data.csv"
    path.write_text("timestamp actual_qd_0 actual_qd_1\n5.0 1 2\n5.002 3 4\n\n")
    recording = Recording.read(path)
    np.testing.assert_allclose(recording.outputs["actual_qd"], [[1, 2], [3, 4]])
    np.testing.assert_allclose(recording.times, [0.0, 0.002], atol=1e-9)


def test_reads_columns_with_other_names_and_a_given_rate(tmp_path):
    path = tmp_path / "log.csv"
    path.write_text("qd_0, qd_1, speed\n1, 2, 3\n4, 5, 6\n")
    recording = Recording.read(path, {"actual_qd": "qd", "speed_scaling": "speed"}, 125.0)
    assert list(recording.outputs) == ["actual_qd", "speed_scaling"] and list(recording.times) == [0.0, 0.008]
    np.testing.assert_allclose(recording.outputs["actual_qd"], [[1, 2], [4, 5]])


def test_reads_vectors_numbers_and_events(file):
    recording = Recording.read(file)
    assert list(recording.outputs) == ["actual_q", "robot_mode"] and recording.outputs["actual_q"].shape == (5, 6)
    np.testing.assert_allclose(recording.times, 0.002 * np.arange(5), atol=1e-9)
    assert recording.events == [(pytest.approx(0.006), "contact")]


def test_elements_have_names_and_units():
    assert labels("actual_qd", 6) == ("rad/s", ("shoulder pan", "shoulder lift", "elbow", "wrist 1", "wrist 2", "wrist 3"))
    assert labels("actual_TCP_force", 6)[0] == "N, N m" and labels("force", 3) == ("N", ("x", "y", "z"))
    assert labels("robot_mode", 1) == ("", ["robot_mode"]) and labels("joint_temperatures", 6)[0] == "°C"


@pytest.mark.parametrize("arguments, name", [([], "run.png"), (["actual_q", "--output", "q.svg"], "q.svg")])
def test_writes_a_figure(file, monkeypatch, capsys, arguments, name):
    monkeypatch.chdir(file.parent)
    assert main.main(["plot", "run.csv", *arguments]) == 0
    assert capsys.readouterr().out.strip() == name
    assert (file.parent / name).stat().st_size > 10000


@pytest.mark.parametrize("text, arguments, message", [
    ("time,a\n0,1\n1,1\n", [], "has no column timestamp: record with `ur record run.csv timestamp actual_q`"),
    ("", [], "has no column timestamp"),
    ("timestamp,a\n0,1\n", [], "has 1 rows: expected 2 or more"),
    ("timestamp,a\n0,1\n1\n", [], "run.csv:3 has 1 values: expected 2"),
    ("timestamp,a\n0,1\n1,x\n", [], "run.csv:3: could not convert string to float: 'x'"),
    ("timestamp\n0\n1\n", [], "run.csv has no output besides timestamp: record with `ur record run.csv timestamp actual_q`"),
    ("timestamp,a\n0,1\n1,2\n", ["b"], "run.csv has no output b. It has: a"),
    ("timestamp,a\n0,1\n1,2\n", ["--output", "figure.doc"], "figure.doc: the name of a figure ends with .png, .pdf, .svg"),
])
def test_reports_what_cannot_be_drawn(tmp_path, monkeypatch, capsys, text, arguments, message):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "run.csv").write_text(text)
    assert main.main(["plot", "run.csv", *arguments]) == 2
    assert message in capsys.readouterr().err


def test_a_file_that_cannot_be_written_is_a_failure_and_no_wrong_argument(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "run.csv").write_text("timestamp,a\n0,1\n1,2\n")
    assert main.main(["plot", "run.csv", "--output", "/proc/figure.png"]) == 1
    assert "/proc/figure.png cannot be written" in capsys.readouterr().err


def test_reports_a_missing_file():
    with pytest.raises(CliError, match="nowhere.csv cannot be read: No such file"):
        Recording.read(pathlib.Path("nowhere.csv"))
