"""The robot of one driver."""

import atexit
import contextlib
import os
import signal
import threading
from collections.abc import Sequence
from types import FrameType, TracebackType
from typing import Any, ClassVar

from .commands import Commands, StartedCommands
from .connection import Connection, own_signals
from .errors import RobotError
from .goal import Goal
from .modes import Modes
from .recording import Recording
from .state import State
from .streams import Streams


class Robot(Commands):
    """The robot of one driver. Every command is a method: `arm.move_j([...], speed=0.5)`, `arm.dashboard.power_on()`.

    `namespace` is that of the driver. `timeout` (s) limits the waits for the driver, its responses and its samples. A goal that takes
    longer than `result_timeout` (s) is canceled.

    Use it in a `with` statement. At the end, running goals are canceled, streams end, and the arm is at standstill. In the main thread,
    SIGTERM and SIGHUP end the program like Ctrl-C, unless it has handlers of its own.
    """

    def __init__(self, namespace: str = "", *, timeout: float = 5.0, result_timeout: float = 600.0):
        connection = Connection(namespace, timeout, result_timeout)
        goals: set[Goal] = set()
        super().__init__(connection, goals)
        self._connection, self._goals = connection, goals
        self.start = StartedCommands(connection, goals)
        self.state = State(connection)
        self.modes = Modes(connection, self, self.start)
        self.stream = Streams(connection)
        self._signals = _EndBySignal()
        atexit.register(self.close)

    def record(self, file: str | os.PathLike[str], fields: Sequence[str] = (), frequency: float = 0.0) -> Recording:
        """Records RTDE outputs to a CSV file while the returned context manager is active.

        `file` is a path on the host of the driver and must not exist. `fields` are names of RTDE outputs; by default timestamp, actual_q,
        actual_qd and actual_TCP_pose. `frequency` is in Hz; 0: every package.
        """
        return Recording(self._connection, file, fields, frequency)

    def close(self) -> None:
        """Ends streams, cancels the running goals, waits until the arm is at standstill, and removes the node."""
        atexit.unregister(self.close)
        try:
            with own_signals():
                try:
                    self.stream.close()
                    running = list(self._goals)
                    for goal in running:
                        with contextlib.suppress(RobotError):
                            goal.request_cancel()
                    for goal in running:
                        goal.abandon()
                finally:  # also after Ctrl-C: a driver without its client stops the arm
                    self._connection.close()
        finally:
            self._signals.restore()

    def __enter__(self) -> "Robot":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"Robot(namespace={self._connection.namespace!r})"


def _exit(number: int, frame: FrameType | None) -> Any:
    raise SystemExit(128 + number)


class _EndBySignal:
    """Raises SystemExit at SIGTERM and SIGHUP, so that `finally` and `with` are executed. Python would end without them.

    The handlers stay until the last Robot is closed."""

    _users: ClassVar[set["_EndBySignal"]] = set()

    def __init__(self) -> None:
        self._users.add(self)
        if threading.current_thread() is threading.main_thread():
            with own_signals():  # those of rclpy.init() stay in front of it
                for number in (signal.SIGTERM, signal.SIGHUP):
                    if signal.getsignal(number) == signal.SIG_DFL:
                        signal.signal(number, _exit)

    def restore(self) -> None:
        self._users.discard(self)
        if not self._users and threading.current_thread() is threading.main_thread():
            with own_signals():
                for number in (signal.SIGTERM, signal.SIGHUP):
                    if signal.getsignal(number) is _exit:
                        signal.signal(number, signal.SIG_DFL)
