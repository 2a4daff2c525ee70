"""The way to where a stream begins is slow: no message has said yet how fast the arm is to be."""

import pytest
from arm_state import get_joint_state, get_tcp_pose, home_plus
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState
from support import start_node, wait_for
from test_streams import Publisher, joint_message
from trajectories import TargetSpeedRecorder


@pytest.fixture(scope="module")
def driver(simulator):
    # Short enough for the first messages to ask for a haste that the arm is capable of.
    driver = start_node("driver", simulator.address, "ur_type:=ur10e", "stream_timeout:=0.2", "stream_max_joint_jump:=0.5",
                  "stream_max_linear_jump:=0.5")
    yield driver
    driver.stop()
    print(driver.output())


def watch(simulator):
    recorder = TargetSpeedRecorder(simulator)
    return recorder


def test_of_joint_positions(robot, simulator):
    recorder = watch(simulator)
    with Publisher(robot, JointState, "servo_joint", lambda t: joint_message(home_plus(0.4))):
        wait_for(lambda: recorder.update() and get_joint_state(robot).position[0] > 0.39, 20.0, "the arm to be there")
    assert 0.5 < max(recorder.update()) < 1.05 * 1.05


def test_of_poses(robot, simulator):
    start = get_tcp_pose(robot)
    message = PoseStamped()
    message.header.frame_id = "base"
    message.pose = get_tcp_pose(robot)
    message.pose.position.z -= 0.2
    with Publisher(robot, PoseStamped, "servo_pose", lambda t: message):
        speeds = []

        def there():
            state_ = simulator.state()
            speeds.append(abs(state_["target_tcp_speed"][2]))
            return state_["actual_tcp_pose"][2] < start.position.z - 0.195

        wait_for(there, 20.0, "the TCP to be there")
    assert 0.1 < max(speeds) < 0.25 * 1.1
