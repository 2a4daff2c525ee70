import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, str(pathlib.Path(__file__).parents[3] / "rcl_cxx/test/support"))
from ros2 import Launch, ready
from ros_domain import reserve

reserve()


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
