"""Reads recordings of rosbag2: the topics of this driver, and of others that publish joint states, poses, twists and wrenches.

A row has the newest message of each topic. The topic with the most messages gives the times of the rows, from the moment on at which
all topics have begun.
"""

import pathlib
import sys
import time
from dataclasses import dataclass, field
from typing import Any, Callable, Dict, Iterator, List, Tuple

import numpy as np

from .errors import CliError
from .recording import Recording

SUFFIXES = (".mcap", ".db3")
JOINTS = ("shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint", "wrist_3_joint")
# The outputs of RTDE in topics of this driver. Others have the name of their topic.
OUTPUTS = {"joint_states": "actual", "target_joint_states": "target", "tcp_pose": "actual_TCP_pose", "tcp_speed": "actual_TCP_speed"}
PROGRESS_INTERVAL = 1.0  # s
NEEDS_ROSBAGS = "rosbag2 recordings need the Python package rosbags: pip install rosbags"

Values = Dict[str, List[float]]  # by output


def is_bag(path: pathlib.Path) -> bool:
    return path.is_dir() or path.suffix in SUFFIXES


def _vector(vector: Any) -> List[float]:
    return [vector.x, vector.y, vector.z]


def _joint_order(names: List[str]) -> List[int]:
    """Returns where the joints of the arm are, from the base to the tool. All joints in their order if it is no arm of UR."""
    found = [next((index for index, name in enumerate(names) if name.endswith(joint)), None) for joint in JOINTS]
    order = [index for index in found if index is not None]
    return order if len(order) == len(JOINTS) else list(range(len(names)))


def _joints(name: str, message: Any) -> Values:
    order = _joint_order(list(message.name))
    vectors = ((f"{name}_q", message.position), (f"{name}_qd", message.velocity), (f"{name}_effort", message.effort))
    return {output: [values[index] for index in order] for output, values in vectors if len(values) == len(message.name)}


def _rotation_vector(rotation: Any) -> List[float]:
    axis = np.array(_vector(rotation)) * (-1.0 if rotation.w < 0.0 else 1.0)
    sine = float(np.linalg.norm(axis))
    return [0.0, 0.0, 0.0] if sine == 0.0 else list(axis * (2.0 * np.arctan2(sine, abs(rotation.w)) / sine))


def _pose(name: str, message: Any) -> Values:
    return {name: _vector(message.pose.position) + _rotation_vector(message.pose.orientation)}


def _twist(name: str, message: Any) -> Values:
    return {name: _vector(message.twist.linear) + _vector(message.twist.angular)}


def _wrench(name: str, message: Any) -> Values:
    return {name: _vector(message.wrench.force) + _vector(message.wrench.torque)}


TYPES: Dict[str, Callable[[str, Any], Values]] = {
    "sensor_msgs/msg/JointState": _joints,
    "geometry_msgs/msg/PoseStamped": _pose,
    "geometry_msgs/msg/TwistStamped": _twist,
    "geometry_msgs/msg/WrenchStamped": _wrench,
}


@dataclass
class _Topic:
    """The values of one topic so far."""

    times: List[float] = field(default_factory=list)
    values: Dict[str, List[List[float]]] = field(default_factory=dict)

    def add(self, stamp: float, values: Values) -> None:
        if any(len(vectors[0]) != len(values.get(output, ())) for output, vectors in self.values.items()):
            return  # of another source on the same topic
        self.times.append(stamp)
        for output, vector in values.items():
            self.values.setdefault(output, []).append(vector)

    def at(self, times: np.ndarray) -> Iterator[Tuple[str, np.ndarray]]:
        """The newest values at these times, which do not precede the first message."""
        rows = np.searchsorted(np.maximum.accumulate(self.times), times, side="right") - 1
        for output, vectors in self.values.items():
            if len(vectors) == len(self.times):
                yield output, np.array(vectors)[rows]


def _stamp(message: Any, received: int) -> float:
    """Of the message, or when it was recorded if it has none; s."""
    stamp = message.header.stamp
    return stamp.sec + stamp.nanosec * 1e-9 if stamp.sec or stamp.nanosec else received * 1e-9


def _output_name(topic: str, is_only: bool) -> str:
    space, _, name = topic.strip("/").rpartition("/")
    output = OUTPUTS.get(name, name)
    return output if is_only or not space else f"{space}/{output}"


def _show_progress(messages: Iterator[Any], count: int, path: pathlib.Path) -> Iterator[Any]:
    """Tells on a terminal how much has been read."""
    begin = shown = time.monotonic()
    for index, message in enumerate(messages, 1):
        now = time.monotonic()
        if now - shown > PROGRESS_INTERVAL and sys.stderr.isatty():
            shown = now
            print(f"\rreading {path.name}: {100 * index // count} %, {(now - begin) * (count / index - 1):.0f} s left ",
                  end="", file=sys.stderr, flush=True)
        yield message
    if shown != begin:
        print(file=sys.stderr)


def _read_topics(reader: Any, path: pathlib.Path) -> Dict[str, _Topic]:
    connections = [connection for connection in reader.connections if connection.msgtype in TYPES]
    if not connections:
        topics = ", ".join(f"{topic} ({info.msgtype})" for topic, info in reader.topics.items()) or "nothing"
        raise CliError(f"{path} has no topic of {', '.join(TYPES)}. It has: {topics}")
    last_names = [topic.rpartition("/")[2] for topic in {connection.topic for connection in connections}]
    names = {connection.topic: _output_name(connection.topic, last_names.count(connection.topic.rpartition("/")[2]) == 1)
             for connection in connections}
    count = sum(connection.msgcount for connection in connections)
    result: Dict[str, _Topic] = {}
    for connection, received, data in _show_progress(reader.messages(connections=connections), count, path):
        message = reader.deserialize(data, connection.msgtype)
        values = TYPES[connection.msgtype](names[connection.topic], message)
        result.setdefault(connection.topic, _Topic()).add(_stamp(message, received), values)
    return result


def read_bag(path: pathlib.Path) -> Recording:
    """Reads the folder of a recording, or its .mcap or .db3 file."""
    try:
        from rosbags.highlevel import AnyReader, AnyReaderError
        from rosbags.typesys import Stores, get_typestore
    except ImportError:
        raise CliError(NEEDS_ROSBAGS) from None
    try:
        with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
            topics = _read_topics(reader, path)
    except CliError:
        raise
    except (AnyReaderError, OSError) as error:
        raise CliError(f"{path} cannot be read as a recording of rosbag2: {error}") from None
    except Exception as error:  # of its storage, for damaged files
        raise CliError(f"{path} cannot be read as a recording of rosbag2: {type(error).__name__}: {error}") from None
    times = np.array(max((topic.times for topic in topics.values()), key=len, default=[]))
    begin = max((topic.times[0] for topic in topics.values()), default=0.0)
    times = times[times >= begin]
    if len(times) < 2:
        raise CliError(f"{path} has {len(times)} messages since all its topics have begun: expected 2 or more")
    outputs = {output: values for topic in topics.values() for output, values in topic.at(times)}
    return Recording(path.name, times - times[0], outputs, [])
