import pathlib
import sys
from unittest.mock import MagicMock

import pytest

# These tests use the helpers and fixtures of the system tests of the driver.
sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "ur_ros_rtde_commands" / "test" / "system"))
from robot_fixtures import addresses, client, destroy_subscriptions_after_test, driver, robot, simulator
from running_viewer import RunningViewer, Tab, chromium

__all__ = ["addresses", "client", "driver", "destroy_subscriptions_after_test", "robot", "simulator"]


@pytest.fixture(scope="module")
def server():
    """A page server on a free port of the loopback interface."""
    from ur_ros_rtde_viewer.page.server import start_server, stop_server

    started = start_server("127.0.0.1", 0)
    yield started
    stop_server(started)


@pytest.fixture
def control():
    """A ControlNode without a thread."""
    created = MagicMock()
    created.post = lambda function: function()
    return created


@pytest.fixture(scope="module")
def viewer(driver):
    """A list whose last item is the running viewer: a test may restart it."""
    viewers = [RunningViewer("--control")]
    yield viewers
    viewers[-1].close()


@pytest.fixture(scope="module")
def browser():
    with chromium() as browser:
        yield browser


@pytest.fixture(scope="module")
def shared_tab(browser, viewer):
    return Tab(browser, viewer[-1].url)


@pytest.fixture
def tab(shared_tab, robot):
    return shared_tab
