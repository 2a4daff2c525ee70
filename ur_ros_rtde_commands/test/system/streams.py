"""Shared by the tests of the teleoperation topics: messages, their pauses, and parameters of the driver."""

import time

import pytest
from geometry_msgs.msg import TwistStamped
from sensor_msgs.msg import JointState
from support import JOINTS

from ur_ros_rtde_msgs.action import Stop

TIMEOUT = 0.5  # s; allows for delays of the publisher by other tests
STREAM_PARAMETERS = [f"stream_timeout:={TIMEOUT}", "watchdog_frequency:=1.0"]  # the program outlasts a stall of more than TIMEOUT


def joint_message(positions, names=JOINTS):
    return JointState(name=list(names), position=[float(p) for p in positions])


def twist_message(frame, z=0.0):
    message = TwistStamped()
    message.header.frame_id = frame
    message.twist.linear.z = z
    return message


def log_lines(driver, text):
    return [line for line in list(driver.lines) if text in line]


def pause():
    time.sleep(TIMEOUT + 0.1)


@pytest.fixture
def no_active_teleoperation(robot):
    """Stops any motion that late messages of an earlier test started, and waits for the timeout of the topics."""
    robot.send(Stop, "stop").succeeded()
    pause()
