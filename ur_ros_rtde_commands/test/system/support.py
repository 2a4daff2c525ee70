"""Shared by the system tests: constants, waiting and times."""

import os
import time

import own_domain  # noqa: F401 -- reserves a domain

TIMEOUT_FACTOR = float(os.environ.get("UR_TEST_PATIENCE", "1"))  # scales all timeouts; programs with a sanitizer are slower
REAL_TIME_FACTOR = float(os.environ.get("UR_TEST_REAL_TIME_FACTOR", "1"))  # slows down the simulated robot along with the driver
LONGEST_PAUSE = 0.02  # s, between two checks of a condition: a wait for a long motion takes little processor time
# Parameter of a driver that is started for a single test. With all plugins, the driver and the clients that discover its actions take
# five times as much processor time (2 s).
FEW_PLUGINS = "plugins:=[move_j,stop]"
# Arguments of a driver that is to log the names of all commands.
NAMES_COMMANDS = ("--log-level", "command_server:=debug", "--log-level", "dashboard_server:=debug")
RECOVERY_TIME_FACTOR = 0.2  # scales the simulator's durations of power on, brake release, protective stop delay and safety restart
HOME = [0.0, -1.57, 1.57, -1.57, -1.57, 0.0]
JOINTS = ["shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint", "wrist_3_joint"]


def wait_for(condition, limit, what):
    """Returns the first true value of `condition()`. Fails if there is none within `limit` s."""
    end, pause = time.monotonic() + TIMEOUT_FACTOR * limit, 0.001
    while True:
        value = condition()
        if value:
            return value
        assert time.monotonic() < end, f"timeout after {limit} s waiting for {what}"
        time.sleep(pause)
        pause = min(1.5 * pause, LONGEST_PAUSE)


def seconds(stamp):
    return stamp.sec + 1e-9 * stamp.nanosec


def robot_seconds(stamp):
    """Converts a stamp or duration of the host to seconds of the simulated robot's time."""
    return REAL_TIME_FACTOR * seconds(stamp)


def own_address(number=0):
    """Returns a loopback address of this test: each run has a ROS domain of its own, and `./ur test` reserves an address with it."""
    first, second, *others = os.environ.get("UR_TEST_ADDRESS", f"127.0.1.{os.environ.get('ROS_DOMAIN_ID', '0')}").split(".")
    return ".".join([first, str(int(second) + number), *others])
