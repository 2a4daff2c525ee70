import pathlib
import sys

import pytest

# These tests use the helpers and fixtures of the system tests of the driver.
sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "ur_ros_rtde_commands" / "test" / "system"))
from robot_fixtures import addresses, driver, simulator  # noqa: E402
from support import HOME, TIMEOUT_FACTOR  # noqa: E402

from ur_ros_rtde import Robot  # noqa: E402

__all__ = ["addresses", "driver", "simulator"]


@pytest.fixture(scope="module")
def connected(driver):
    with Robot(timeout=TIMEOUT_FACTOR * 20.0) as robot:
        yield robot


@pytest.fixture
def arm(connected, driver):
    """A Robot that is ready, with the arm at home."""
    assert driver.running(), driver.output()
    assert connected.state.wait_until(lambda state: state.driver_state == "READY", TIMEOUT_FACTOR * 30.0), driver.output()
    connected.move_j(HOME, speed=3.0, acceleration=15.0)
    return connected
