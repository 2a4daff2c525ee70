import pathlib
import sys

import pytest

# These tests use the helpers and fixtures of the system tests of the driver.
sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "ur_ros_rtde_commands" / "test" / "system"))
from robot_fixtures import addresses, client, destroy_subscriptions_after_test, driver, robot, simulator

__all__ = ["addresses", "client", "driver", "destroy_subscriptions_after_test", "robot", "simulator"]


@pytest.fixture(scope="module")
def server():
    """A page server on a free port of the loopback interface."""
    from ur_ros_rtde_viewer.page.server import start_server, stop_server

    started = start_server("127.0.0.1", 0)
    yield started
    stop_server(started)
