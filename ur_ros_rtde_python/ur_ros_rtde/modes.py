"""Modes that last for a `with` block. They end at its end, also after an exception or Ctrl-C."""

import contextlib
from collections.abc import Iterator
from typing import Any

from .commands import Commands, StartedCommands
from .errors import RobotError
from .goal import Goal


class Modes:
    """Modes in which the arm is compliant, as context managers. The arguments are the fields of the commands.

    Any other command that lasts until it is canceled is a mode as well: `with arm.start.jog(...):`.
    """

    def __init__(self, commands: Commands, start: StartedCommands):
        self._commands, self._start = commands, start

    def freedrive(self, *values: Any, **fields: Any) -> Goal:
        """The arm can be moved by hand in selected axes. Ends with this program, even if it is killed."""
        return self._start.freedrive(*values, **fields)

    def teach_mode(self) -> Goal:
        """The arm can be moved by hand in all axes. Ends with this program, even if it is killed."""
        return self._start.teach_mode()

    @contextlib.contextmanager
    def force_mode(self, *values: Any, **fields: Any) -> Iterator[None]:
        """Axes of the arm are compliant while other commands move it.

        Ends with this program, even if it is killed. The mode of `outlives_client=True` lasts until `stop()` or a failed motion.
        """
        self._commands.force_mode_start(*values, **fields)
        try:
            yield
        except BaseException:
            with contextlib.suppress(RobotError):
                self._end_force_mode()
            raise
        self._end_force_mode()

    def _end_force_mode(self) -> None:
        try:
            self._commands.force_mode_stop()
        except RobotError:  # a motion is still running: stop() ends the motion and the mode
            self._commands.stop()
