"""Records RTDE outputs of the robot to a CSV file, offers it for download, and replays it in the scene."""

import os
import pathlib
import time
from typing import Any, Callable, Optional

from ur_ros_rtde_msgs.srv import StartRecording, StopRecording

from ..panels.replay_panel import ReplayPanel
from ..playback.motion import read_file
from ..ros.service_call import ServiceCaller
from ..state.robot_state import RobotState

# viser encodes a download within its event loop, 1 s for 300 MB: STOP of all browser tabs would wait.
MAX_DOWNLOAD = 2_000_000  # bytes; 0.5 s at 30 Mbit/s, in which no answer to STOP is shown
DEFAULT_FIELDS = "timestamp actual_q actual_qd actual_TCP_pose actual_TCP_force"


def _hint(file: pathlib.Path) -> str:
    """Returns how to use a file that is too large for a download, or an empty text. Raises OSError."""
    size = file.stat().st_size
    if size <= MAX_DOWNLOAD:
        return ""
    return (f"The file is on the host of the viewer. It has {size / 1e6:.1f} MB; at most {MAX_DOWNLOAD / 1e6:g} MB can be downloaded, "
            f"because STOP would wait. Draw it there: `ur plot {file}`")


class RecordingPanel:
    """`folder`: where the driver writes its files. A small file is offered for download if it is on this machine."""

    def __init__(self, tab: Any, server: Any, services: ServiceCaller, replay: ReplayPanel, folder: pathlib.Path,
                 post: Callable[..., None]):
        self._services, self._replay, self._folder, self._post = services, replay, folder, post
        self._file: Optional[pathlib.Path] = None
        gui = server.gui
        with tab:
            self._fields = gui.add_text("RTDE outputs", DEFAULT_FIELDS)
            self._button = gui.add_button("Record")
            self._message = gui.add_markdown("")
            self._download = gui.add_button("Download", visible=False)
        self._button.on_click(lambda _event: post(self.toggle))
        self._download.on_click(lambda event: self._send(event.client))
        self.is_recording = self._closed = False
        self._is_pending = False  # a request was not answered yet

    def toggle(self) -> None:
        if self._is_pending:  # a second click
            return
        self._button.disabled = self._is_pending = True
        if self.is_recording:
            self._services.call(StopRecording, "stop_recording", self._stopped)
            return
        self._file = self._folder / time.strftime("recording_%Y%m%d_%H%M%S.csv")
        self._services.call(StartRecording, "start_recording", self._started, on_late=self._started_late,
                            filename=str(self._file), fields=self._fields.value.split())

    def _started(self, response: Optional[Any], reason: str) -> None:
        self._show_state(response is not None and response.success)
        if response is None or not response.success:
            self._message.content = reason if response is None else response.message
            return
        self._message.content = f"Recording to `{self._file}`"
        if self._closed:  # in the meantime
            self.close()

    def _started_late(self, response: Any) -> None:
        """Stops the recording: its start was reported as failed."""
        if response.success:
            self._message.content = "The recording has started too late and was stopped."
            self._stop()

    def _stopped(self, response: Optional[Any], reason: str) -> None:
        self._show_state(response is None)  # without an answer, the recording may go on
        if response is None or not response.success:
            self._message.content = reason if response is None else response.message
            return
        lost = f", {response.lost} lost" if response.lost else ""
        self._message.content = f"`{response.filename}`: {response.rows} rows{lost}"
        self._file = pathlib.Path(response.filename)
        file_is_here = os.access(self._file, os.R_OK)
        hint = _hint(self._file) if file_is_here else ""
        self._download.visible = file_is_here and not hint
        if hint:
            self._message.content += f"\n\n{hint}"
        if file_is_here:
            file = self._file
            self._replay.replay(file.name, lambda ended: read_file(file, ended))

    def _show_state(self, recording: bool) -> None:
        self.is_recording, self._is_pending = recording, False
        self._button.label, self._button.disabled = "Stop" if recording else "Record", False
        self._fields.disabled = recording

    def _send(self, client: Any) -> None:
        """Runs in a thread of the server. The file may have grown: the next recording has begun."""
        file = self._file
        if file is None:
            return
        try:
            text = _hint(file)
            if not text:
                client.send_file_download(file.name, file.read_bytes())
                return
        except OSError as error:
            text = f"{file}: {error.strerror}"
        self._post(lambda: setattr(self._message, "content", text))

    def update(self, _state: RobotState) -> None:
        pass

    def close(self) -> None:
        self._closed = True
        if self.is_recording:
            self._stop()

    def _stop(self) -> None:
        self._services.call(StopRecording, "stop_recording", lambda _response, _reason: None)
