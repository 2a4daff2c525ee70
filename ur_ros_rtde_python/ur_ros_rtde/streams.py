"""Streams of setpoints: the arm follows the calls of send() in a loop, and decelerates when they stop."""

import contextlib
import copy
from types import TracebackType
from typing import Any, ClassVar

import numpy
from ur_ros_rtde_cli import fields

from .connection import Connection, end_even_if_interrupted, ending, own_signals
from .conversions import JOINT_COUNT, interface, kinds_of, numbers, plain
from .errors import INVALID_GOAL, TIMEOUT, Rejected, RobotError, StreamEnded
from .teleoperation import Teleoperation


class Stream:
    """Setpoints that move the arm during a `with` block. `arm.stream.…` creates it.

    The block begins when the driver accepts setpoints. Each setpoint, also the first one, is due within the driver's `stream_timeout`. At
    the end of the block, also after an exception or Ctrl-C, the arm decelerates to standstill.

    Raises Rejected if another command is running or the robot is not ready, NoDriver, and StreamEnded if the driver has ended the stream
    before the end of the block.
    """

    _name: ClassVar[str]
    _topic: ClassVar[str]
    _kind: ClassVar[str]  # of the messages
    _field: ClassVar[str]  # of a message: the setpoint
    _size: ClassVar[int]  # of a setpoint

    def __init__(self, connection: Connection, streams: set["Stream"]):
        self._connection, self._streams = connection, streams
        self._session: Teleoperation | None = None

    def send(self, setpoint: Any) -> None:
        """Publishes the next setpoint. Does not wait.

        Raises Rejected if it is invalid; nothing is published then. Raises StreamEnded if the driver has ended the stream, or if the
        last setpoint is older than `stream_timeout`: only a new stream moves the arm again. Raises NoDriver if the driver has ended.
        """
        session = self._session
        if session is None:
            self._connection.check_open()
            raise RobotError(f"{self._name}: the stream is closed; send() belongs into its `with` block")
        session.publish(self._message(session, setpoint))

    def close(self) -> None:
        """Ends the stream and returns when the arm is at standstill. May be called again."""
        session = self._session
        if session is None:
            return
        try:
            end_even_if_interrupted(self._name, lambda: session.stop(self._brake(session)))
        finally:
            self._session = None
            self._streams.discard(self)
            session.remove()

    def __enter__(self) -> "Stream":
        try:
            with own_signals():
                self._session = Teleoperation(self._connection, self._name, self._topic, self._kind)
                self._streams.add(self)
                self._session.start(self._hold)
        except BaseException:
            with ending(self._name):
                self.close()
            raise
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        session = self._session
        if session is None:
            return
        end = session.end()
        with contextlib.nullcontext() if kind is None else ending(self._name):
            self.close()
        last = session.end()
        if end is None and last is not None and last[0] != TIMEOUT:
            end = last  # the arm was still decelerating
        if kind is None and end is not None:
            raise StreamEnded(self._name, *end)

    def _message(self, session: Teleoperation, setpoint: Any) -> Any:
        """Returns the message with a setpoint. Raises Rejected."""
        message = self._next(session)
        try:
            fields.fill(message, {self._field: plain(kinds_of(message)[self._field], setpoint)})
        except fields.FieldError as error:
            raise Rejected(self._name, INVALID_GOAL, str(error), fields.field_name(error.path)) from None
        values = numbers(getattr(message, self._field))
        if values.size != self._size:
            raise Rejected(self._name, INVALID_GOAL, f"{self._field} has {values.size} values: expected a list of {self._size} numbers")
        if not numpy.isfinite(values).all():
            index = int(numpy.argmin(numpy.isfinite(values)))
            raise Rejected(self._name, INVALID_GOAL, f"{self._field}[{index}] is {values[index]:g}, it must be finite")
        return message

    def _hold(self) -> Any:
        """Returns a message that commands no motion, with the stamp of the newest state."""
        raise NotImplementedError

    def _next(self, session: Teleoperation) -> Any:
        """Returns a message with those values that a setpoint may leave out."""
        raise NotImplementedError

    def _brake(self, session: Teleoperation) -> Any:
        """Returns a message that decelerates the arm, or None."""
        return None

    def _joint_state(self) -> Any:
        return self._connection.call("ur_ros_rtde_msgs/srv/GetJointState", "get_joint_state").joint_state


class JointStream(Stream):
    """Joint positions from shoulder_pan to wrist_3, rad."""

    _name, _topic, _kind, _field = "stream.joints", "servo_joint", "sensor_msgs/msg/JointState", "position"
    _size = JOINT_COUNT

    def _hold(self) -> Any:
        state = self._joint_state()
        return type(state)(header=state.header, name=state.name, position=state.position)

    def _next(self, session: Teleoperation) -> Any:
        return type(session.last)(name=session.last.name)


class PoseStream(Stream):
    """Poses of the active TCP in the base frame, as commands take them. A position alone keeps the orientation of the last setpoint."""

    _name, _topic, _kind, _field = "stream.pose", "servo_pose", "geometry_msgs/msg/PoseStamped", "pose"
    _size = 7

    def _hold(self) -> Any:
        return self._connection.call("ur_ros_rtde_msgs/srv/GetTcpPose", "get_tcp_pose").tcp_pose

    def _next(self, session: Teleoperation) -> Any:
        last = session.last
        return type(last)(header=last.header, pose=type(last.pose)(orientation=copy.copy(last.pose.orientation)))


class TwistStream(Stream):
    """Twists of the active TCP: m/s and rad/s."""

    _name, _topic, _kind, _field = "stream.twist", "twist", "geometry_msgs/msg/TwistStamped", "twist"
    _size = 6

    def __init__(self, connection: Connection, streams: set[Stream], frame_id: str):
        super().__init__(connection, streams)
        self._frame_id = frame_id

    def _hold(self) -> Any:
        message = interface(self._kind)(header=self._joint_state().header)
        message.header.frame_id = self._frame_id
        return message

    def _next(self, session: Teleoperation) -> Any:
        return type(session.last)(header=session.last.header)

    def _brake(self, session: Teleoperation) -> Any:
        return None if session.last is None else self._next(session)


class Streams:
    """Setpoints from a loop of the program, as context managers. Only the newest setpoint counts."""

    def __init__(self, connection: Connection):
        self._connection = connection
        self._open: set[Stream] = set()

    def joints(self) -> Stream:
        """Joint positions from shoulder_pan to wrist_3, rad. Begin at the arm: `arm.state.joint_positions`."""
        return JointStream(self._connection, self._open)

    def pose(self) -> Stream:
        """Poses of the active TCP in the base frame, as the commands take them. Begin at the arm: `arm.state.tcp_pose`.

        A position alone keeps the orientation of the setpoint before.
        """
        return PoseStream(self._connection, self._open)

    def twist(self, frame_id: str = "base") -> Stream:
        """Twists of the active TCP, m/s and rad/s, in the frame `base` or `tool0_controller`."""
        return TwistStream(self._connection, self._open, frame_id)

    def close(self) -> None:
        """Ends the open streams."""
        for stream in list(self._open):
            with contextlib.suppress(RobotError):
                stream.close()
