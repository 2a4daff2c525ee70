"""Replays a recording in the scene: a CSV file from the browser, or what was recorded last."""

import logging
import threading
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Callable

from viser import UploadedFile

from ..errors import ViewerError
from ..playback.motion import Motion, read_csv
from ..playback.player import Player
from ..state.robot_state import RobotState

logger = logging.getLogger(__name__)
NO_FILE = UploadedFile("", b"")


def _reason(error: Exception) -> str:
    """Returns why a recording is not shown, and logs an error that is not expected."""
    if isinstance(error, ViewerError):
        return str(error)
    logger.error("a recording cannot be shown", exc_info=error)
    return f"The recording cannot be shown: {type(error).__name__}: {error}"


class ReplayPanel:
    """Reads a recording in a thread of its own: a long one takes a minute."""

    def __init__(self, tab: Any, gui: Any, player: Player, post: Callable[..., None]):
        with tab:
            self._upload = gui.add_upload_button("Replay a CSV file", mime_type=".csv,text/csv")
            self.message = gui.add_markdown("")
        self.player, self._post = player, post
        self._reader, self._closed = ThreadPoolExecutor(1, "replay"), threading.Event()
        self._upload.on_upload(lambda _event: post(self._replay_upload))

    def _replay_upload(self) -> None:
        file = self._upload.value
        if file is NO_FILE:  # two uploads arrived together
            return
        self._upload._impl.value = NO_FILE  # viser would keep the content, and its setter of `value` takes no files
        self.replay(file.name, lambda ended: read_csv(file.name, file.content, ended))

    def replay(self, name: str, read: Callable[[Callable[[], bool]], Motion]) -> None:
        """Shows a recording in the scene, or why this is not possible. `read` is called in another thread, with a function that
        tells whether it is to give up."""
        self.message.content = f"Reading `{name}`"
        self._reader.submit(self._read, read)

    def _read(self, read: Callable[[Callable[[], bool]], Motion]) -> None:
        try:
            motion = read(self._closed.is_set)
        except Exception as error:
            text = _reason(error)
            self._post(lambda: setattr(self.message, "content", text))
            return
        self._post(lambda: self._show(motion))

    def _show(self, motion: Motion) -> None:
        try:
            self.player.load(motion)
        except Exception as error:
            self.message.content = _reason(error)
            return
        self.message.content = f"`{motion.name}`: {motion.duration:.1f} s, {len(motion.times)} rows"

    def update(self, state: RobotState) -> None:
        self.player.update(state)

    def close(self) -> None:
        self._closed.set()
        self._reader.shutdown()
