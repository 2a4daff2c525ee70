"""Scripts of the page with --control in a headless Chromium, without a robot: uploads."""

import pytest
from running_viewer import RunningViewer, Tab, until
from ur_ros_rtde_viewer.page import uploads
from ur_ros_rtde_viewer.panels.replay_panel import ReplayPanel

BROWSER = True


@pytest.fixture(scope="module")
def viewer():
    started = RunningViewer("--control")
    yield started
    started.close()


@pytest.fixture(scope="module")
def tab(browser, viewer):
    return Tab(browser, viewer.url)


def choose_file(tab, name, size):
    """Chooses a file for the replay."""
    tab.page.set_input_files("input[type=file]", {"name": name, "mimeType": "text/csv", "buffer": size * b"\n"})


def test_a_large_file_is_not_uploaded_where_there_is_stop(tab, viewer):
    replay, = (panel for panel in viewer.viewer.robots[0].panels if isinstance(panel, ReplayPanel))
    tab.open("Record")
    choose_file(tab, "large.csv", uploads.MAX_BYTES + 100_000)
    tab.wait_for_text("large.csv has 1.1 MB. Where there is STOP, at most 1 MB are uploaded")
    choose_file(tab, "small.csv", uploads.MAX_BYTES)
    until(lambda: "csv" in replay.message.content, "the file")
    until(lambda: "Reading" not in replay.message.content, "the end of reading")
    assert replay.message.content.startswith("small.csv has no columns")
    tab.page.get_by_text("Where there is STOP").wait_for(state="hidden")
