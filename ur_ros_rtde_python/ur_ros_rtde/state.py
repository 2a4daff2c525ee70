"""The state of the robot as attributes and as a stream."""

import collections
import functools
import queue
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy

from .connection import Connection, until
from .conversions import Array, numbers
from .errors import NoDriver, RobotError

INCOMPLETE_SAMPLES = 500  # samples of which a topic is missing; the oldest are dropped


@dataclass(frozen=True)
class _Field:
    topic: str
    kind: str  # "sensor_msgs/msg/JointState"
    read: Callable[[Any], Array]


STREAMS = {
    "joint_positions": _Field("actual_joint_states", "sensor_msgs/msg/JointState", lambda message: numbers(message.position)),
    "joint_velocities": _Field("actual_joint_states", "sensor_msgs/msg/JointState", lambda message: numbers(message.velocity)),
    "joint_efforts": _Field("actual_joint_states", "sensor_msgs/msg/JointState", lambda message: numbers(message.effort)),
    "target_joint_positions": _Field("target_joint_states", "sensor_msgs/msg/JointState", lambda message: numbers(message.position)),
    "target_joint_velocities": _Field("target_joint_states", "sensor_msgs/msg/JointState", lambda message: numbers(message.velocity)),
    "tcp_pose": _Field("tcp_pose", "geometry_msgs/msg/PoseStamped", lambda message: numbers(message.pose)),
    "tcp_speed": _Field("tcp_speed", "geometry_msgs/msg/TwistStamped", lambda message: numbers(message.twist)),
    "wrench": _Field("wrench", "geometry_msgs/msg/WrenchStamped", lambda message: numbers(message.wrench)),
    "digital_inputs": _Field("io_state", "ur_ros_rtde_msgs/msg/IOState", lambda message: numpy.array(message.digital_inputs)),
    "digital_outputs": _Field("io_state", "ur_ros_rtde_msgs/msg/IOState", lambda message: numpy.array(message.digital_outputs)),
}


def _seconds(stamp: Any) -> float:
    return float(stamp.sec) + 1e-9 * float(stamp.nanosec)


class State:
    """The state of the robot. Each attribute returns the newest value from the driver, as numpy array where it has several numbers.

    Raises NoDriver without a driver, and RobotError with the reason if the driver has no connection to the controller.
    """

    def __init__(self, connection: Connection):
        self._connection = connection
        self._latest: dict[str, tuple[Any, frozenset[bytes]]] = {}  # of transient local topics, with their publishers
        self._subscribed: set[str] = set()

    @property
    def joint_names(self) -> list[str]:
        """Names of the joints from shoulder_pan to wrist_3, with the prefix of the arm."""
        return list(self._joints().name)

    @property
    def joint_positions(self) -> Array:
        """Joint positions from shoulder_pan to wrist_3, rad."""
        return numbers(self._joints().position)

    @property
    def joint_velocities(self) -> Array:
        """Joint velocities, rad/s."""
        return numbers(self._joints().velocity)

    @property
    def joint_efforts(self) -> Array:
        """Joint torques, Nm."""
        return numbers(self._joints().effort)

    @property
    def tcp_pose(self) -> Array:
        """Pose of the active TCP in the base frame: x, y, z (m) and the quaternion x, y, z, w."""
        return numbers(self._get("GetTcpPose", "get_tcp_pose").tcp_pose.pose)

    @property
    def wrench(self) -> Array:
        """Force (N) and torque (Nm) of the environment on the tool, in the orientation of the TCP."""
        return numbers(self._get("GetWrench", "get_wrench").wrench.wrench)

    @property
    def digital_inputs(self) -> Any:
        """Digital inputs by pin number: 0-7 standard, 8-15 configurable, 16-17 tool."""
        return numpy.array(self._io().digital_inputs)

    @property
    def digital_outputs(self) -> Any:
        """Digital outputs by pin number: 0-7 standard, 8-15 configurable, 16-17 tool."""
        return numpy.array(self._io().digital_outputs)

    @property
    def analog_inputs(self) -> Array:
        """Analog inputs of the control box, A or V."""
        return numbers(self._io().analog_inputs)

    @property
    def analog_outputs(self) -> Array:
        """Analog outputs of the control box, A or V."""
        return numbers(self._io().analog_outputs)

    @property
    def robot_mode(self) -> str:
        """Name of a constant of ur_ros_rtde_msgs/RobotMode, for example "RUNNING"."""
        return str(self._latched("robot_mode", "ur_ros_rtde_msgs/msg/RobotMode").name)

    @property
    def safety_mode(self) -> str:
        """Name of a constant of ur_ros_rtde_msgs/SafetyMode, for example "NORMAL"."""
        return str(self._latched("safety_mode", "ur_ros_rtde_msgs/msg/SafetyMode").name)

    @property
    def driver_state(self) -> str:
        """DISCONNECTED, CONNECTING, READY (motions are accepted) or STOPPED."""
        return str(self._latched("driver_state", "ur_ros_rtde_msgs/msg/DriverState").name)

    @property
    def driver_message(self) -> str:
        """Cause and remedy of a driver_state other than READY."""
        return str(self._latched("driver_state", "ur_ros_rtde_msgs/msg/DriverState").message)

    @property
    def program_running(self) -> bool:
        return bool(self._latched("program_running", "std_msgs/msg/Bool").data)

    @property
    def speed_scaling(self) -> float:
        """Fraction of the programmed speed, 0 to 1."""
        return float(self._latched("speed_scaling", "std_msgs/msg/Float64").data)

    def wait_until(self, condition: Callable[["State"], Any], timeout: float) -> bool:
        """Waits at most `timeout` s until `condition(state)` is true. Returns whether it is."""
        return bool(until(lambda: condition(self), timeout, 0.02))

    def stream(self, *fields: str, duration: float, newest: bool = False) -> Iterator[Any]:
        """Yields samples of these fields for `duration` s of the state's time, one for each control cycle.

        A sample is a named tuple with `time` (s since the epoch) and the fields, all of the same control cycle. The fields are
        joint_positions, joint_velocities, joint_efforts, target_joint_positions, target_joint_velocities, tcp_pose, tcp_speed, wrench,
        digital_inputs and digital_outputs. At 500 Hz, each topic takes about a tenth of a processor core.

        Samples wait while the loop is busy. With `newest`, it gets only the newest of them: for control, where old ones are of no use.
        """
        wanted = fields or ("joint_positions",)
        for name in wanted:
            if name not in STREAMS:
                raise ValueError(f"there is no field {name}; the fields are: {', '.join(STREAMS)}")
        return self._samples(wanted, duration, newest)

    def _samples(self, fields: tuple[str, ...], duration: float, newest: bool) -> Iterator[Any]:
        make_type: Any = collections.namedtuple
        sample_type = make_type("Sample", ("time", *fields))
        topics = {STREAMS[name].topic: STREAMS[name].kind for name in fields}
        complete: queue.SimpleQueue[dict[str, Any] | None] = queue.SimpleQueue()  # None: the end
        parts: dict[float, dict[str, Any]] = {}  # messages by topic, by time stamp; used in the executor's thread

        first: float | None = None
        has_all = False

        def add(topic: str, message: Any) -> None:
            nonlocal first, has_all
            stamp = _seconds(message.header.stamp)
            if has_all or (first is not None and stamp - first > duration):
                if not has_all:
                    complete.put(None)
                has_all = True
                return
            sample = parts.setdefault(stamp, {})
            sample[topic] = message
            if len(sample) == len(topics):
                complete.put(parts.pop(stamp))
                first = stamp if first is None else first
            elif len(parts) > INCOMPLETE_SAMPLES:
                del parts[min(parts)]

        self._connection.check_open()
        subscriptions: list[Any] = []
        try:
            for topic, kind in topics.items():
                subscriptions.append(self._connection.subscribe(kind, topic, functools.partial(add, topic)))
            while True:
                try:
                    sample = complete.get(timeout=self._connection.timeout)
                except queue.Empty:
                    self._connection.check_open()
                    raise NoDriver(f"no messages on {', '.join(topics)}: {self._reason()}") from None
                while newest and sample is not None and not complete.empty():
                    sample = complete.get()
                if sample is None:
                    return
                now = _seconds(next(iter(sample.values())).header.stamp)
                yield sample_type(now, *(STREAMS[name].read(sample[STREAMS[name].topic]) for name in fields))
        finally:
            for subscription in subscriptions:
                self._connection.unsubscribe(subscription)

    def _reason(self) -> str:
        try:
            self._joints()
        except RobotError as error:
            return str(error)
        return "the host is too busy, or its network loses messages"

    def _joints(self) -> Any:
        return self._get("GetJointState", "get_joint_state").joint_state

    def _io(self) -> Any:
        return self._get("GetIOState", "get_io_state").io_state

    def _get(self, kind: str, service: str) -> Any:
        return self._connection.call(f"ur_ros_rtde_msgs/srv/{kind}", service)

    def _latched(self, topic: str, kind: str) -> Any:
        """Returns the newest message of a topic whose last value late subscribers receive."""
        def store(message: Any) -> None:
            self._latest[topic] = (message, self._connection.publishers(topic))

        def newest() -> tuple[Any] | None:
            found = self._latest.get(topic)
            if found and found[1] and found[1].isdisjoint(self._connection.publishers(topic)):
                return None  # its driver has ended
            return (found[0],) if found else None

        self._connection.check_open()
        if topic not in self._subscribed:
            self._subscribed.add(topic)
            self._connection.subscribe(kind, topic, store, latched=True)
        found = self._connection.until(newest, self._connection.timeout)
        if found is None:
            raise NoDriver(f"no message on {self._connection.full_name(topic)} within {self._connection.timeout:g} s: start the driver")
        return found[0]
