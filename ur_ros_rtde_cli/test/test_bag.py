"""`ur plot` and `ur compare` read recordings of rosbag2, of this driver and of others."""

import math
import pathlib

import numpy as np
import pytest
from ur_ros_rtde_cli import bag, main
from ur_ros_rtde_cli.errors import CliError
from ur_ros_rtde_cli.recording import read

pytest.importorskip("rosbags", reason=bag.NEEDS_ROSBAGS)
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

BACKGROUND = True
STORE = get_typestore(Stores.ROS2_HUMBLE)
BEGIN = 1_800_000_000  # s
JOINTS = [f"left_{joint}" for joint in bag.JOINTS]
ALPHABETICAL = sorted(JOINTS)


def _type(name):
    return STORE.types[name]


def _header(stamp):
    seconds = math.floor(stamp)
    time = _type("builtin_interfaces/msg/Time")(BEGIN + seconds, round((stamp - seconds) * 1e9))
    return _type("std_msgs/msg/Header")(time, "base")


def joint_state(stamp, positions, names=JOINTS, effort=()):
    return _type("sensor_msgs/msg/JointState")(_header(stamp), list(names), np.array(positions, float), np.zeros(len(names)),
                                               np.array(effort, float))


def pose(stamp, position, rotation):
    message = _type("geometry_msgs/msg/Pose")(_type("geometry_msgs/msg/Point")(*position), _type("geometry_msgs/msg/Quaternion")(*rotation))
    return _type("geometry_msgs/msg/PoseStamped")(_header(stamp), message)


def text(stamp, words):
    del stamp
    return _type("std_msgs/msg/String")(words)


def write(folder, messages, storage=StoragePlugin.MCAP):
    """Messages: topic, stamp in s, message."""
    with Writer(folder, version=9, storage_plugin=storage) as writer:
        connections = {}
        for topic, stamp, message in messages:
            kind = message.__msgtype__
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=STORE)
            writer.write(connections[topic], int((BEGIN + stamp) * 1e9), STORE.serialize_cdr(message, kind))
    return pathlib.Path(folder)


def joints_at(times, topic="/joint_states", names=JOINTS):
    for time in times:
        values = {joint: index + time for index, joint in enumerate(JOINTS)}
        yield topic, time, joint_state(time, [values[name] for name in names], names)


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3], ids=["mcap", "sqlite3"])
def test_joints_come_in_the_order_of_the_arm(tmp_path, storage):
    folder = write(tmp_path / "run", joints_at([0.0, 0.1, 0.2], names=ALPHABETICAL), storage)
    for path in (folder, next(file for file in folder.iterdir() if file.suffix in bag.SUFFIXES)):
        recording = read(path)
        assert list(recording.outputs) == ["actual_q", "actual_qd"], "without an effort in the messages"
        np.testing.assert_allclose(recording.outputs["actual_q"], [np.arange(6) + time for time in (0.0, 0.1, 0.2)], atol=1e-6)
        np.testing.assert_allclose(recording.times, [0.0, 0.1, 0.2], atol=1e-6)


def test_a_row_has_the_newest_pose_as_rotation_vector(tmp_path):
    half = math.sqrt(0.5)
    poses = [("/tcp_pose", 0.05, pose(0.05, (1, 2, 3), (half, 0, 0, half))),
             ("/tcp_pose", 0.25, pose(0.25, (4, 5, 6), (0, 0, -half, -half)))]
    messages = sorted([*joints_at([0.0, 0.1, 0.2, 0.3]), *poses], key=lambda message: message[1])
    recording = read(write(tmp_path / "run", messages))
    np.testing.assert_allclose(recording.times, [0.0, 0.1, 0.2], atol=1e-6, err_msg="the first row is older than the first pose")
    np.testing.assert_allclose(recording.outputs["actual_TCP_pose"],
                               [[1, 2, 3, math.pi / 2, 0, 0], [1, 2, 3, math.pi / 2, 0, 0], [4, 5, 6, 0, 0, math.pi / 2]], atol=1e-9)


def test_outputs_of_two_robots_have_their_namespaces(tmp_path):
    messages = sorted([*joints_at([0.0, 0.1], "/left/joint_states"), *joints_at([0.0, 0.1], "/right/joint_states")],
                      key=lambda message: message[1])
    names = {f"{side}/actual_{name}" for side in ("left", "right") for name in ("q", "qd")}
    assert set(read(write(tmp_path / "run", messages)).outputs) == names


def test_plot_and_compare(tmp_path, capsys):
    slow = write(tmp_path / "slow", joints_at(np.arange(0.0, 1.0, 0.1)))
    fast = write(tmp_path / "fast", joints_at(np.arange(0.0, 1.0, 0.01)))
    assert main.main(["plot", str(slow), "actual_q"]) == 0
    assert (tmp_path / "slow.png").stat().st_size > 10000
    assert main.main(["compare", str(slow), str(fast), "actual_q", "--shift", "0"]) == 0
    assert "shoulder pan" in capsys.readouterr().out


@pytest.mark.parametrize("make, message", [
    (lambda folder: folder.mkdir(), "cannot be read as a recording of rosbag2"),
    (lambda folder: write(folder, [("/chatter", 0.0, text(0.0, "hello"))]), r"It has: /chatter \(std_msgs/msg/String\)"),
    (lambda folder: write(folder, joints_at([0.0])), "has 1 messages since all its topics have begun: expected 2 or more"),
], ids=["no recording", "other topics", "one message"])
def test_says_what_it_cannot_read(tmp_path, make, message):
    folder = tmp_path / "run"
    make(folder)
    with pytest.raises(CliError, match=message):
        read(folder)


def test_a_damaged_file_is_an_error(tmp_path):
    file = next(file for file in write(tmp_path / "run", joints_at(np.arange(0.0, 1.0, 0.01))).iterdir() if file.suffix == ".mcap")
    content = file.read_bytes()
    for size in (0, 20, len(content) // 2):
        file.write_bytes(content[:size])
        with pytest.raises(CliError, match="cannot be read as a recording of rosbag2"):
            read(file)
