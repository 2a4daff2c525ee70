"""The approach to the first target of a teleoperation topic is slow, because a single message defines no speed."""

import pytest
from arm_state import get_joint_state, get_tcp_pose, home_plus
from geometry_msgs.msg import PoseStamped
from programs import start_node
from publisher import Publisher
from sensor_msgs.msg import JointState
from streams import joint_message
from support import FEW_PLUGINS, wait_for
from trajectories import TargetRecorder


@pytest.fixture(scope="module")
def driver(simulator):
    # The jump limits and the short timeout allow first messages that would require a high speed.
    driver = start_node("driver", simulator.address, FEW_PLUGINS, "ur_type:=ur10e", "stream_timeout:=0.2",
                        "stream_max_joint_jump:=0.5", "stream_max_linear_jump:=0.5")
    yield driver
    driver.stop()
    print(driver.output())


def test_the_approach_to_joint_positions_is_slow(robot, simulator):
    recorder = TargetRecorder(simulator)
    with Publisher(robot, JointState, "servo_joint", lambda t: joint_message(home_plus(0.4))):
        wait_for(lambda: recorder.update() and get_joint_state(robot).position[0] > 0.39, 20.0, "the arm to reach the target")
    recorder.update()
    assert recorder.max_joint_speed() < 1.05 * 1.05
    assert recorder.moving_cycles_with_setpoint(joint_speed=0.1) < 1.5 * 500.0 * 0.4 / 1.05, "slower than the default speed"


def test_the_approach_to_a_pose_is_slow(robot, simulator):
    start = get_tcp_pose(robot)
    message = PoseStamped()
    message.header.frame_id = "base"
    message.pose = get_tcp_pose(robot)
    message.pose.position.z -= 0.2
    recorder = TargetRecorder(simulator)
    with Publisher(robot, PoseStamped, "servo_pose", lambda t: message):
        wait_for(lambda: recorder.update() and get_tcp_pose(robot).position.z < start.position.z - 0.195, 20.0,
                 "the TCP to reach the target")
    recorder.update()
    assert recorder.max_tcp_speed() < 0.25 * 1.1
    assert recorder.moving_cycles_with_setpoint(joint_speed=0.03) < 1.5 * 500.0 * 0.2 / 0.25, "slower than the default speed"
