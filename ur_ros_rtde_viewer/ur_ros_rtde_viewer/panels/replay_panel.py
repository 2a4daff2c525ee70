"""Replays a recording in the scene: a CSV file from the browser, or what was recorded last."""

from typing import Any, Callable

from ..errors import ViewerError
from ..playback.motion import read_csv
from ..playback.player import Player
from ..state.robot_state import RobotState


class ReplayPanel:
    def __init__(self, tab: Any, gui: Any, player: Player, post: Callable[..., None]):
        with tab:
            self._upload = gui.add_upload_button("Replay a CSV file", mime_type=".csv,text/csv")
            self.message = gui.add_markdown("")
        self.player = player
        self._upload.on_upload(lambda _event: post(self._replay_upload))

    def _replay_upload(self) -> None:
        self.replay(self._upload.value.name, self._upload.value.content)

    def replay(self, name: str, content: bytes) -> None:
        """Shows a recording in the scene, or why this is not possible."""
        try:
            motion = read_csv(name, content)
            self.player.load(motion)
        except ViewerError as error:
            self.message.content = str(error)
            return
        self.message.content = f"`{name}`: {motion.duration:.1f} s, {len(motion.times)} rows"

    def update(self, state: RobotState) -> None:
        self.player.update(state)

    def close(self) -> None:
        pass
