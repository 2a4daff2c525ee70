"""What all panels have in common."""

from typing import Protocol

from ..state.robot_state import RobotState


class Panel(Protocol):
    """A part of the page that belongs to one robot. Its methods are called in the thread of the viewer's loop.

    Callbacks of GUI elements are called in other threads: they only pass a function to Viewer.post().
    """

    def update(self, state: RobotState) -> None:
        """Shows the state. Called once per update of the viewer."""

    def close(self) -> None:
        """Ends what the panel has started: goals, recordings, fake joint states."""
