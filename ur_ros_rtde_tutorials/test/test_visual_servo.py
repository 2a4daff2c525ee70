"""Tests visual_servo on the simulated robot. The test is the camera."""

import copy
import math

import pytest
from action_msgs.msg import GoalStatus
from arm_state import get_tcp_pose
from geometry_msgs.msg import PoseStamped
from publisher import Publisher
from support import wait_for
from ur_ros_rtde_tutorials.action import VisualServo

from ur_ros_rtde_msgs.msg import ErrorCode

RATE = 30.0  # Hz
TOPIC = "visual_servo/target"


class Camera:
    """Publishes where the target is, until the test removes it."""

    def __init__(self, client, start, rate=RATE):
        self.target = copy.deepcopy(start)
        self.frame = "base"
        self._publisher = Publisher(client, PoseStamped, TOPIC, self._measure, rate=rate)

    def _measure(self, _time):
        if self.target is None:
            return None
        message = PoseStamped(pose=self.target)
        message.header.frame_id = self.frame
        return message

    def moved(self, x=0.0, z=0.0):
        pose = copy.deepcopy(self.target)
        pose.position.x += x
        pose.position.z += z
        self.target = pose

    def stop(self):
        self._publisher.stop()


@pytest.fixture
def camera(robot):
    camera = Camera(robot, get_tcp_pose(robot))
    yield camera
    camera.stop()


def servo(client, **fields):
    return client.send(VisualServo, "visual_servo", **fields)


def test_the_arm_follows_a_target_that_moves_and_stays_there(robot, simulator, camera):
    camera.moved(z=0.1)
    goal = servo(robot, tolerance=0.003, settling_time=0.3)
    wait_for(lambda: any(feedback.distance > 0.0 for feedback in list(goal.feedback)), 10.0, "a measurement")
    camera.moved(x=-0.05)
    result = goal.succeeded(30.0)
    end, target = result.final_state.tcp_pose.position, camera.target.position
    assert (end.x, end.y, end.z) == pytest.approx((target.x, target.y, target.z), abs=0.004)
    assert simulator.is_at_rest()


def test_the_arm_turns_to_a_target_that_differs_in_its_orientation_only(robot, camera):
    turned = copy.deepcopy(camera.target)
    q, (sine, cosine) = turned.orientation, (math.sin(0.15), math.cos(0.15))  # 0.3 rad about the z axis of the base
    q.x, q.y, q.z, q.w = (cosine * q.x - sine * q.y, cosine * q.y + sine * q.x, cosine * q.z + sine * q.w, cosine * q.w - sine * q.z)
    camera.target = turned
    end = servo(robot, tolerance=0.003, settling_time=0.0).succeeded(30.0).final_state.tcp_pose.orientation
    assert abs(end.x * q.x + end.y * q.y + end.z * q.z + end.w * q.w) > math.cos(0.5 * 0.03)


def test_the_arm_stops_when_the_camera_is_lost(robot, simulator, camera):
    camera.moved(z=0.25)
    goal = servo(robot)
    wait_for(lambda: not simulator.is_at_rest(), 10.0, "a motion")
    camera.target = None
    result = goal.result(20.0)
    assert result.error_code == ErrorCode.TIMEOUT and "no target for 0.5 s" in result.message, result.message
    assert simulator.is_at_rest()


def test_a_pose_in_another_frame_is_rejected(robot, simulator, camera):
    camera.frame = "camera_link"
    result = servo(robot).result(20.0)
    assert result.error_code == ErrorCode.INVALID_GOAL and '"camera_link"' in result.message, result.message
    assert simulator.is_at_rest()


def test_a_target_that_jumps_is_rejected(robot, simulator, camera):
    goal = servo(robot, settling_time=10.0)
    wait_for(lambda: goal.feedback, 10.0, "feedback")
    camera.moved(z=0.5)
    result = goal.result(20.0)
    assert result.error_code == ErrorCode.INVALID_GOAL and "from the last command, at most 0.300 m" in result.message, result.message
    assert simulator.is_at_rest()


def test_cancel_stops_the_arm(robot, simulator, camera):
    camera.moved(z=0.25)
    goal = servo(robot)
    wait_for(lambda: not simulator.is_at_rest(), 10.0, "a motion")
    goal.cancel()
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_CANCELED and result.error_code == ErrorCode.CANCELED, result.message
    assert simulator.is_at_rest()
