import contextlib
import functools
import pathlib
import sys

import pytest

# These tests use the helpers and fixtures of the system tests of the driver.
sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "ur_ros_rtde_commands" / "test" / "system"))
from programs import Simulator, start_node
from robot_fixtures import addresses, driver, simulator
from support import FEW_PLUGINS, HOME, TIMEOUT_FACTOR, wait_for
from ur_ros_rtde import CommandFailed, Rejected, Robot

__all__ = ["addresses", "driver", "simulator"]


@contextlib.contextmanager
def connected_robot(address, namespace):
    """A simulator, a driver that is ready and its Robot, for a test in which the driver or the controller is lost."""
    simulator = Simulator(address)
    driver = start_node("driver", address, FEW_PLUGINS, namespace=namespace)
    try:
        with Robot(namespace, timeout=TIMEOUT_FACTOR * 20.0) as robot:
            assert robot.state.wait_until(lambda state: state.driver_state == "READY", TIMEOUT_FACTOR * 30.0), driver.output()
            yield robot, driver, simulator
    finally:
        driver.stop()
        simulator.stop()


@pytest.fixture
def lost_robot(addresses):
    """Returns a context manager of a Robot with a driver and a simulator of its own."""
    return functools.partial(connected_robot, addresses[1])


@pytest.fixture(scope="module")
def connected(driver):
    with Robot(timeout=TIMEOUT_FACTOR * 20.0) as robot:
        yield robot


@pytest.fixture
def arm(connected, driver):
    """A Robot that is ready, with the arm at home."""

    def is_at_home():
        try:
            return connected.move_j(HOME, speed=3.0, acceleration=15.0)
        except (Rejected, CommandFailed) as error:  # the control program may be starting
            errors.append(error)
            return None

    errors = []
    assert driver.running(), driver.output()
    wait_for(is_at_home, 30.0, f"the driver to accept a motion: {errors}")
    return connected
