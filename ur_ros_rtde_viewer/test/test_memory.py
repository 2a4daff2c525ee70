"""The memory of the viewer does not grow with its updates: without a page, with one, and with one that does not read."""

import contextlib
import ctypes
import gc
import sys
import threading

import msgspec
import numpy as np
import pytest
import rclpy
import viser
from geometry_msgs.msg import PoseStamped, WrenchStamped
from rclpy.action import ActionClient
from running_viewer import until
from sensor_msgs.msg import JointState
from ur_ros_rtde_description.models import JOINTS
from ur_ros_rtde_viewer.control import control, robot_control
from ur_ros_rtde_viewer.panels import plots_panel, state_panel
from ur_ros_rtde_viewer.program import parse
from ur_ros_rtde_viewer.ros.nodes import Nodes
from ur_ros_rtde_viewer.scene import trail
from ur_ros_rtde_viewer.viewer import Viewer
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from ur_ros_rtde_msgs.action import MoveJ

ACTIONS = 40  # in the ROS graph
UPDATES, ROUNDS = 500, 4
LARGEST_GROWTH = 300.0  # bytes per update, in the round with the smallest one: objects that come and go
SMALL_OBJECT = 512  # bytes, the largest one that Python does not allocate with malloc()
CAMERA = {"type": "ViewerCameraMessage", "wxyz": (1.0, 0.0, 0.0, 0.0), "position": (0.0, 0.0, 1.0), "fov": 1.0, "near": 0.1, "far": 100.0,
          "image_height": 800, "image_width": 1000, "look_at": (0.0, 0.0, 0.0), "up_direction": (0.0, 0.0, 1.0)}


class MallocState(ctypes.Structure):
    _fields_ = [(name, ctypes.c_size_t) for name in ("arena", "free_chunks", "fast_chunks", "mapped_chunks", "mapped", "unused",
                                                     "fast", "used", "free", "releasable")]


def allocated():
    """Returns an upper bound of the bytes in use. Python alone does not know what C libraries allocate."""
    gc.collect()
    mallinfo2 = ctypes.CDLL(None).mallinfo2
    mallinfo2.restype = MallocState
    state = mallinfo2()
    return state.used + state.mapped + SMALL_OBJECT * sys.getallocatedblocks()


class Robot:
    """Publishes the state of an arm that moves, and serves actions."""

    def __init__(self):
        self._context = rclpy.Context()
        rclpy.init(context=self._context)
        self._node = rclpy.create_node("memory_test", context=self._context)
        self._publishers = [self._node.create_publisher(kind, name, 1) for kind, name in
                            ((JointState, "joint_states"), (PoseStamped, "tcp_pose"), (WrenchStamped, "wrench"))]
        self._clients = [ActionClient(self._node, MoveJ, f"action_{index}") for index in range(ACTIONS)]
        self._time = 0.0

    def move(self):
        self._time += 0.1
        wave = float(np.sin(self._time))
        joints = JointState(name=list(JOINTS), position=[wave] * 6, velocity=[wave] * 6, effort=[0.0] * 6)
        joints.header.stamp.sec, joints.header.stamp.nanosec = int(self._time), int(self._time % 1.0 * 1e9)
        pose, wrench = PoseStamped(), WrenchStamped()
        pose.pose.position.x, wrench.wrench.force.z = wave, 30.0 * wave
        for publisher, message in zip(self._publishers, (joints, pose, wrench)):
            publisher.publish(message)

    def close(self):
        self._node.destroy_node()
        self._context.try_shutdown()


@pytest.fixture
def robot():
    started = Robot()
    yield started
    started.close()


@pytest.fixture
def viewer(server, monkeypatch):
    """Does in each update what it otherwise does at most once per second."""
    for module, period in ((plots_panel, "DRAW_PERIOD"), (state_panel, "ARM_PERIOD"), (trail, "PERIOD"), (control, "EXPAND_PERIOD"),
                           (robot_control, "ACTIONS_PERIOD")):
        monkeypatch.setattr(module, period, 0.0)
    nodes = Nodes()
    created = Viewer(server, nodes, parse(["--control", "--model", "ur10e"]))
    yield created
    created.close()
    nodes.close()


def read_until_closed(connection):
    with contextlib.suppress(ConnectionClosed):
        while True:
            connection.recv()


@contextlib.contextmanager
def page(server, reads):
    """The connection of a page."""
    with connect(f"ws://127.0.0.1:{server.get_port()}", subprotocols=[f"viser-v{viser.__version__}"], compression=None,
                 max_size=None) as connection:
        connection.send(msgspec.msgpack.encode(CAMERA))
        thread = threading.Thread(target=read_until_closed, args=(connection,))
        if reads:
            thread.start()
        yield
    if reads:
        thread.join()


@pytest.mark.parametrize("kind", ["no page", "a page", "a page that does not read"])
def test_memory_does_not_grow_with_the_updates(server, viewer, robot, kind):
    def update(count):
        for _ in range(count):
            robot.move()
            viewer.update()
            viewer.nodes.spin_once(0.0)

    def growth():
        before = allocated()
        update(UPDATES)
        return (allocated() - before) / UPDATES

    with page(server, kind == "a page") if kind != "no page" else contextlib.nullcontext():
        until(lambda: update(UPDATES // 10) or len(viewer.control._robots[0].action_types) >= ACTIONS, "the actions")
        update(UPDATES)
        grown = [growth() for _ in range(ROUNDS)]
    assert viewer.robots[0].state.joints.stamp > 0.0
    print(f"bytes per update: {', '.join(f'{value:.0f}' for value in grown)}")
    assert min(grown) < LARGEST_GROWTH
