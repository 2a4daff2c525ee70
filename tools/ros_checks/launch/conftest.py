import os
import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from ros2 import Launch, ready

os.environ.setdefault("ROS_DOMAIN_ID", "87")
os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")


@pytest.fixture
def launch():
    """Returns a function that starts `ros2 launch`. Each launch is stopped with Ctrl-C."""
    launches = []

    def start(*arguments):
        launches.append(Launch(*arguments))
        return launches[-1]

    yield start
    for each in launches:
        each.stop()


@pytest.fixture(scope="module")
def driver():
    """The driver, started as described in the README."""
    launch = Launch("ur_ros_rtde", "driver.launch.py", "sim:=true")
    ready(launch)
    yield launch
    launch.stop()
