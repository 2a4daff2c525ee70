"""Recordings and plans: reading, bad input, and playing in the scene."""

import json
import time

import numpy as np
import pytest
from ur_ros_rtde_viewer.arguments import RobotOptions
from ur_ros_rtde_viewer.errors import ViewerError
from ur_ros_rtde_viewer.playback.motion import Motion, read_csv, read_file, read_plan
from ur_ros_rtde_viewer.playback.player import Player
from ur_ros_rtde_viewer.scene.robot_scene import RobotScene
from ur_ros_rtde_viewer.state.robot_state import RobotState

HEADER = ["timestamp", *(f"actual_q_{joint}" for joint in range(6)), "actual_qd_0"]


def table(*rows, header=HEADER):
    return "\n".join(",".join(map(str, row)) for row in (header, *rows)).encode()


def row(stamp, position):
    return [stamp, *[position] * 6, 0.5]


def test_reads_a_recording_and_interpolates():
    motion = read_csv("run.csv", table(row(10.0, 0.0), row(10.5, 1.0), row(11.0, 1.0)))
    assert motion.duration == pytest.approx(1.0)
    assert [motion.at(t)[0] for t in (-1.0, 0.0, 0.25, 0.5, 5.0)] == pytest.approx([0.0, 0.0, 0.5, 1.0, 1.0])


def test_a_recording_without_time_has_the_rate_of_the_controller():
    motion = read_csv("run.csv", table(*([0.1] * 6 for _ in range(501)), header=HEADER[1:7]))
    assert motion.duration == pytest.approx(1.0)


@pytest.mark.parametrize("content, message", [
    (b"", "no columns actual_q_0"),
    (b"a,b\n1,2\n", "no columns actual_q_0"),
    (b"\xff\xfe\x00", "is no text"),
    (table(), "has 0 rows"),
    (table(row(0.0, 0.0)), "has 1 rows"),
    (table(row(0.0, 0.0), row(0.1, "fast")), 'run.csv:3: "fast" is no number'),
    (table(row(0.0, 0.0), [0.1, 2.0]), "run.csv:3 has 2 values: expected 8"),
    (table(row(0.0, 0.0), row(0.1, "nan")), "no finite number"),
    (table(row(1.0, 0.0), row(0.5, 0.0)), "the time of row 2 is earlier"),
])
def test_a_wrong_file_is_rejected_with_the_reason(content, message):
    with pytest.raises(ViewerError) as rejection:
        read_csv("run.csv", content)
    assert message in str(rejection.value)


def test_a_file_that_cannot_be_shown_is_not_read(tmp_path, monkeypatch):
    file = tmp_path / "night.csv"
    with pytest.raises(ViewerError, match="night.csv cannot be read: No such file"):
        read_file(file, lambda: False)
    with file.open("wb") as content:
        content.truncate(300_000_000)  # without blocks on the disk
    monkeypatch.setattr(type(file), "read_bytes", lambda _: pytest.fail("it was read"))
    with pytest.raises(ViewerError, match="night.csv has 300 MB"):
        read_file(file, lambda: False)


def test_reading_ends_with_the_page():
    with pytest.raises(ViewerError, match="closed"):
        read_csv("run.csv", table(row(0.0, 0.0), row(0.1, 0.0)), lambda: True)


def test_reads_a_plan():
    plan = {"samples": {"time": [0.0, 2.0], "position": [[0.0] * 6, [1.0] * 6]}}
    assert read_plan("plan.json", json.dumps(plan)).at(1.0) == pytest.approx([0.5] * 6)


@pytest.mark.parametrize("text", ["", "{}", "[1]", *('{"samples": {"time": %s, "position": %s}}' % values for values in (
    ("[0, 1]", "[[0, 1], [2, 3]]"), ("5", "[[0, 0, 0, 0, 0, 0]]"), ("[[0], [1]]", "[[0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0]]"),
    ("[0, 1]", "5"), ("null", "null"), ("[0, 1" + 400 * "0" + "]", "[[0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0]]")))])
def test_a_file_that_is_no_plan_is_rejected(text):
    with pytest.raises(ViewerError, match="plan.json"):
        read_plan("plan.json", text)


@pytest.fixture
def player(server):
    scene = RobotScene(server.scene, RobotOptions("", "ur5e"))
    created = Player(server.gui.add_folder("player"), server, scene, lambda function: function())
    yield created
    created.remove()
    scene.remove()


@pytest.fixture
def clock(monkeypatch):
    now = [1000.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    return now


MOTION = Motion("ramp", np.array((0.0, 2.0)), np.array(([0.0] * 6, [1.0] * 6)))


def test_a_motion_plays_repeats_and_pauses(player, clock):
    player.load(MOTION)
    shown = []
    for step in (0.0, 1.0, 0.5, 1.0, 0.25):
        clock[0] += step
        player.update(RobotState())
        shown.append(player.arm.positions[0])
    assert shown == pytest.approx([0.0, 0.5, 0.75, 0.0, 0.125])
    player.toggle()
    clock[0] += 1.0
    player.update(RobotState())
    assert not player.playing and player.arm.positions[0] == pytest.approx(0.125)


def test_without_repetition_a_motion_ends_at_its_end_and_starts_again(player, clock):
    player.load(MOTION)
    player._loop.value = False
    clock[0] += 3.0
    player.update(RobotState())
    assert not player.playing and player.arm.positions[0] == pytest.approx(1.0)
    player.toggle()
    assert player.playing and player.arm.positions[0] == pytest.approx(0.0)


def test_a_replay_never_moves_the_robots_arm(player):
    player.load(MOTION)
    player.seek(1.0)
    assert np.isnan(player._robot_scene.arm.positions).all() and player.arm is not player._robot_scene.arm


def test_a_replay_stands_where_the_robot_is_mounted(server):
    scene = RobotScene(server.scene, RobotOptions("mounted", "ur5e", (0.0, 0.4, 0.8)))
    player = Player(server.gui.add_folder("mounted"), server, scene, lambda function: function())
    player.load(MOTION)
    assert server.scene.get_handle_by_name(player.arm.link_path("base_link")).position == pytest.approx((0.0, 0.4, 0.8))
    player.remove()
    scene.remove()


def test_without_a_model_a_replay_is_rejected(server):
    scene = RobotScene(server.scene, RobotOptions("unknown"))
    with pytest.raises(ViewerError, match="--model"):
        Player(server.gui.add_folder("unknown"), server, scene, lambda function: function()).load(MOTION)
