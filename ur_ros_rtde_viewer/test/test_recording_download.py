"""The panel that records, without ROS and without a browser: downloads."""

from types import SimpleNamespace
from unittest.mock import MagicMock

import pytest
from ur_ros_rtde_viewer.control.recording_panel import MAX_DOWNLOAD, RecordingPanel

BACKGROUND = True


@pytest.fixture
def panel(server, tmp_path):
    return RecordingPanel(server.gui.add_folder("record"), server, MagicMock(), MagicMock(), tmp_path, lambda function: function())


def ended(panel, file, size):
    """The end of a recording."""
    file.write_bytes(size * b"1")
    panel._stopped(SimpleNamespace(success=True, filename=str(file), rows=1, lost=0), "")


def test_a_small_recording_is_downloaded(panel, tmp_path):
    client, file = MagicMock(), tmp_path / "small.csv"
    ended(panel, file, MAX_DOWNLOAD)
    assert panel._download.visible and panel._message.content == f"`{file}`: 1 rows"
    panel._send(client)
    client.send_file_download.assert_called_once_with("small.csv", MAX_DOWNLOAD * b"1")


def test_a_large_recording_is_not_downloaded_but_named(panel, tmp_path):
    file = tmp_path / "large.csv"
    ended(panel, file, MAX_DOWNLOAD + 100_000)
    assert not panel._download.visible
    assert f"`{file}`: 1 rows" in panel._message.content and "It has 2.1 MB; at most 2 MB" in panel._message.content
    assert f"`ur plot {file}`" in panel._message.content and panel._replay.replay.called


def test_a_file_that_has_grown_since_the_button_was_shown_is_not_downloaded(panel, tmp_path):
    client, file = MagicMock(), tmp_path / "grows.csv"
    ended(panel, file, 100)
    file.write_bytes((MAX_DOWNLOAD + 1) * b"1")
    panel._send(client)
    assert not client.send_file_download.called and f"`ur plot {file}`" in panel._message.content


def test_a_file_that_is_gone_is_reported(panel, tmp_path):
    client, file = MagicMock(), tmp_path / "gone.csv"
    ended(panel, file, 100)
    file.unlink()
    panel._send(client)
    assert not client.send_file_download.called and panel._message.content == f"{file}: No such file or directory"
