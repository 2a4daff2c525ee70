"""The memory of the viewer does not grow with its updates: without a page, with one, and with one that does not read."""

import contextlib
import ctypes
import gc
import itertools
import sys
import threading
import time

import msgspec
import numpy as np
import pytest
import rclpy
import viser
from rclpy.action import ActionClient
from running_viewer import until
from ur_ros_rtde_viewer.control import control, robot_control
from ur_ros_rtde_viewer.page import origin
from ur_ros_rtde_viewer.panels import plots_panel, state_panel
from ur_ros_rtde_viewer.program import parse
from ur_ros_rtde_viewer.ros.nodes import Nodes
from ur_ros_rtde_viewer.scene import trail
from ur_ros_rtde_viewer.state.robot_state import Joints, Pose
from ur_ros_rtde_viewer.viewer import Viewer
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from ur_ros_rtde_msgs.action import MoveJ

ACTIONS = 40  # in the ROS graph
UPDATES, ROUNDS = 200, 5
LARGEST_GROWTH = 100.0  # bytes per update, in the round with the smallest one: objects that come and go
QUIET = 0.1  # s
SMALL_OBJECT = 64  # bytes, about, of those that Python does not allocate with malloc()
CAMERA = {"type": "ViewerCameraMessage", "wxyz": (1.0, 0.0, 0.0, 0.0), "position": (0.0, 0.0, 1.0), "fov": 1.0, "near": 0.1, "far": 100.0,
          "image_height": 800, "image_width": 1000, "look_at": (0.0, 0.0, 0.0), "up_direction": (0.0, 0.0, 1.0)}


class MallocState(ctypes.Structure):
    _fields_ = [(name, ctypes.c_size_t) for name in ("arena", "free_chunks", "fast_chunks", "mapped_chunks", "mapped", "unused",
                                                     "fast", "used", "free", "releasable")]


def allocated():
    """Returns about how many bytes are in use. Python alone does not know what C libraries allocate."""
    gc.collect()
    mallinfo2 = ctypes.CDLL(None).mallinfo2
    mallinfo2.restype = MallocState
    state = mallinfo2()
    return state.used + state.mapped + SMALL_OBJECT * sys.getallocatedblocks()


@pytest.fixture
def actions():
    """Actions in the ROS graph."""
    context = rclpy.Context()
    rclpy.init(context=context)
    node = rclpy.create_node("memory_test", context=context)
    clients = [ActionClient(node, MoveJ, f"action_{index}") for index in range(ACTIONS)]
    yield clients
    node.destroy_node()
    context.try_shutdown()


def move(state, time):
    """Sets the state of an arm that moves. The memory of a publisher in this process would be counted, too."""
    wave = np.sin(time)
    state.joints = Joints(time, np.full(6, wave), np.full(6, wave), np.zeros(6))
    state.tcp_pose, state.wrench = Pose(np.array((wave, 0.2, 0.3)), np.array((1.0, 0.0, 0.0, 0.0))), np.full(6, 30.0 * wave)
    state.age = 0.0


@pytest.fixture
def viewer(server, monkeypatch):
    """Does in each update what it otherwise does at most once per second."""
    for module, period in ((plots_panel, "DRAW_PERIOD"), (state_panel, "ARM_PERIOD"), (trail, "PERIOD"), (control, "EXPAND_PERIOD"),
                           (robot_control, "ACTIONS_PERIOD")):
        monkeypatch.setattr(module, period, 0.0)
    monkeypatch.setattr(origin, "LOSS_TIMEOUT", 600.0)  # s; a page that does not read keeps its connection
    nodes = Nodes()
    created = Viewer(server, nodes, parse(["--control", "--model", "ur10e"]))
    monkeypatch.setattr(created.robots[0].topics, "poll", lambda: None)
    yield created
    created.close()
    nodes.close()


class Page:
    """The connection of a page."""

    def __init__(self, server, reads):
        self._reads, self._received = reads, 0
        self._connection = connect(f"ws://127.0.0.1:{server.get_port()}", subprotocols=[f"viser-v{viser.__version__}"], compression=None,
                                   max_size=None)
        self._connection.send(msgspec.msgpack.encode(CAMERA))
        self._thread = threading.Thread(target=self._read_until_closed)
        if reads:
            self._thread.start()

    def _read_until_closed(self):
        with contextlib.suppress(ConnectionClosed):
            while True:
                self._connection.recv()
                self._received += 1

    def has_received_everything(self):
        """Returns whether nothing arrives for QUIET s: messages on their way are memory, too."""
        before = self._received
        time.sleep(QUIET)
        return self._received == before

    def close(self):
        self._connection.close()
        if self._reads:
            self._thread.join()


def test_goals_of_one_action_need_one_subscription(viewer, actions):
    goal = viewer.robots[0]._goal

    def repeat():
        goal.on_holder("/action_3, goal 1")
        goal.on_holder("")
        return goal._subscriptions

    until(repeat, "the action")
    count = len(list(viewer.nodes.node.subscriptions))
    for _ in range(10):
        repeat()
    assert len(goal._subscriptions) == 1 and len(list(viewer.nodes.node.subscriptions)) == count


@pytest.mark.parametrize("kind", ["no page", "a page", "a page that does not read"])
def test_memory_does_not_grow_with_the_updates(server, viewer, actions, kind):
    instants = itertools.count()

    def update(count):
        for _ in range(count):
            move(viewer.robots[0].state, 0.1 * next(instants))
            viewer.update()
            viewer.nodes.spin_once(0.0)

    def settle():
        if page is not None:
            until(page.has_received_everything, "the messages on their way")

    def growth():
        settle()
        before = allocated()
        update(UPDATES)
        settle()
        return (allocated() - before) / UPDATES

    with contextlib.closing(Page(server, kind == "a page")) if kind != "no page" else contextlib.nullcontext() as page:
        until(lambda: update(UPDATES // 10) or len(viewer.control._robots[0].action_types) >= ACTIONS, "the actions")
        update(2 * UPDATES)
        grown = [growth() for _ in range(ROUNDS)]
    print(f"bytes per update: {', '.join(f'{value:.0f}' for value in grown)}")
    assert min(grown) < LARGEST_GROWTH
