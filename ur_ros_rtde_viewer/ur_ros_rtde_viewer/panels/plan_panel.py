"""Animates a plan of `./ur plan FILE --view`."""

import pathlib
from typing import Any

from ..errors import ViewerError
from ..playback.motion import Motion, read_plan
from ..playback.player import Player
from ..state.robot_state import RobotState


def load_plan(file: pathlib.Path) -> Motion:
    """Raises ViewerError if the file cannot be read or is no plan."""
    try:
        return read_plan(file.name, file.read_text())
    except (OSError, UnicodeDecodeError) as error:
        raise ViewerError(f"--plan {file}: {getattr(error, 'strerror', None) or 'this is no text'}") from None


class PlanPanel:
    def __init__(self, tab: Any, gui: Any, motion: Motion, player: Player):
        with tab:
            gui.add_markdown(f"`{motion.name}`: {motion.duration:.3f} s")
        self._player = player
        player.load(motion)

    def update(self, state: RobotState) -> None:
        self._player.update(state)

    def close(self) -> None:
        pass
