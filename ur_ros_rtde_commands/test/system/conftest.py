import functools

import pytest
from plugin_prefix import create_plugin_prefix
from robot_fixtures import addresses, client, destroy_subscriptions_after_test, driver, processes, robot, simulator, start_slow_robot
from streams import no_active_teleoperation

__all__ = ["addresses", "client", "destroy_subscriptions_after_test", "driver", "no_active_teleoperation", "processes", "robot",
           "simulator", "start_slow_robot"]


@pytest.fixture
def plugin_prefix(tmp_path):
    """Returns a function that creates an ament prefix with one plugin package in the test's temporary folder."""
    return functools.partial(create_plugin_prefix, tmp_path)
