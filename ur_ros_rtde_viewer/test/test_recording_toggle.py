"""Start and stop of recordings, without ROS: clicks that follow each other at once, and answers that are late."""

from types import SimpleNamespace
from unittest.mock import MagicMock

import pytest
from rclpy.task import Future
from ur_ros_rtde_viewer.control.recording_panel import RecordingPanel
from ur_ros_rtde_viewer.ros import service_call
from ur_ros_rtde_viewer.ros.service_call import TIMEOUT, ServiceCaller

from ur_ros_rtde_msgs.srv import StartRecording, StopRecording

BACKGROUND = True


class Driver:
    """The services of a driver that answers when the test lets it, and a clock."""

    def __init__(self, monkeypatch):
        self.now, self.requests = 100.0, []
        monkeypatch.setattr(service_call.time, "monotonic", lambda: self.now)
        node = MagicMock()
        node.create_client = lambda kind, name: MagicMock(call_async=lambda request: self._add(kind))
        self.services = ServiceCaller(SimpleNamespace(node=node), lambda name: f"/{name}")

    def _add(self, kind):
        self.requests.append((kind, Future()))
        return self.requests[-1][1]

    @property
    def kinds(self):
        self.services.update()
        return [kind for kind, _ in self.requests]

    def answer(self, success, message="", number=-1):
        self.services.update()
        self.requests[number][1].set_result(SimpleNamespace(success=success, message=message, filename="", rows=0, lost=0))
        self.services.update()

    def wait(self, seconds):
        self.services.update()
        self.now += seconds
        self.services.update()


@pytest.fixture
def driver(monkeypatch):
    return Driver(monkeypatch)


@pytest.fixture
def panel(server, driver, tmp_path):
    return RecordingPanel(server.gui.add_folder("record"), server, driver.services, MagicMock(), tmp_path, lambda function: function())


def test_a_second_click_is_ignored_until_the_first_one_is_answered(driver, panel):
    panel.toggle()
    panel.toggle()
    assert driver.kinds == [StartRecording]
    driver.answer(True)
    assert panel.is_recording and panel._button.label == "Stop"
    panel.toggle()
    panel.toggle()
    assert driver.kinds == [StartRecording, StopRecording]
    driver.answer(True)
    assert not panel.is_recording and panel._button.label == "Record"


def test_a_start_that_fails_leaves_the_page_as_it_was(driver, panel):
    panel.toggle()
    driver.answer(False, "run.csv is being recorded: end that first (ur record --stop)")
    assert not panel.is_recording and not panel._button.disabled and "end that first" in panel._message.content
    panel.toggle()
    assert driver.kinds == [StartRecording] * 2


@pytest.mark.parametrize("success", [True, False])
def test_a_recording_that_starts_after_the_timeout_is_stopped(driver, panel, success):
    panel.toggle()
    driver.wait(1.1 * TIMEOUT)
    assert not panel.is_recording and "did not answer" in panel._message.content
    driver.answer(success)
    assert driver.kinds == ([StartRecording, StopRecording] if success else [StartRecording])


def test_a_recording_whose_stop_is_not_answered_can_be_stopped_again(driver, panel):
    panel.toggle()
    driver.answer(True)
    panel.toggle()
    driver.wait(1.1 * TIMEOUT)
    assert panel.is_recording and not panel._button.disabled
    panel.close()
    assert driver.kinds == [StartRecording, StopRecording, StopRecording]
