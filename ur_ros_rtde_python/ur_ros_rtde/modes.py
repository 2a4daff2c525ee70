"""Modes that last for a `with` block. They end at its end, also after an exception or Ctrl-C."""

import contextlib
from collections.abc import Iterator
from typing import Any

from .commands import Commands, StartedCommands
from .connection import Connection, end_even_if_interrupted, ending
from .errors import RobotError
from .goal import Goal, Progress


class Modes:
    """Modes in which the arm is compliant, as context managers. The arguments are the fields of the commands.

    Any other command that lasts until it is canceled is a mode as well: `with arm.start.jog(...):`.
    """

    def __init__(self, connection: Connection, commands: Commands, start: StartedCommands):
        self._connection, self._commands, self._start = connection, commands, start

    @contextlib.contextmanager
    def freedrive(self, *values: Any, **fields: Any) -> Iterator[Goal]:
        """The arm can be moved by hand in selected axes. Ends with this program, even if it is killed."""
        command: Any = self._start.freedrive
        with command.goal(*values, **fields) as goal:
            yield goal.send()

    @contextlib.contextmanager
    def teach_mode(self) -> Iterator[Goal]:
        """The arm can be moved by hand in all axes. Ends with this program, even if it is killed."""
        command: Any = self._start.teach_mode
        with command.goal() as goal:
            yield goal.send()

    @contextlib.contextmanager
    def force_mode(self, *values: Any, on_progress: Progress | None = None, result_timeout: float | None = None,
                   **fields: Any) -> Iterator[None]:
        """Axes of the arm are compliant while other commands move it.

        Ends with this program, even if it is killed. The mode of `outlives_client=True` lasts until `stop()` or a failed motion.
        """
        command: Any = self._start.force_mode_start
        goal: Goal = command.goal(*values, **fields)
        try:
            goal.send().result(self._connection.result_timeout if result_timeout is None else result_timeout, on_progress)
            yield
        except BaseException:
            try:
                goal.abandon()
            finally:
                if goal.may_have_succeeded:  # otherwise, a mode may be that of another client
                    with ending("force mode"):
                        end_even_if_interrupted("force mode", self._end_force_mode)
            raise
        end_even_if_interrupted("force mode", self._end_force_mode)

    def _end_force_mode(self) -> None:
        """Ends force mode, over another connection if that of the Robot is closed."""
        def end(connection: Connection) -> None:
            commands = self._commands if connection is self._connection else Commands(connection, set())
            try:
                commands.force_mode_stop()
            except RobotError:  # a motion is still running: stop() ends the motion and the mode
                commands.stop()

        self._connection.over_open_connection(end)
