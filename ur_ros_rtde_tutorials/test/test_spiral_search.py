"""The extension of this package: a loop on the controller, on the simulator."""

import math
import os

import pytest
from action_msgs.msg import GoalStatus
from support import HOME, Client, Simulator, node, wait_for

from ur_ros_rtde_msgs.action import MoveJ
from ur_ros_rtde_msgs.msg import ErrorCode
from ur_ros_rtde_tutorials.action import SpiralSearch


@pytest.fixture(scope="module")
def simulator():
    simulator = Simulator(os.environ.get("UR_TEST_ADDRESS", "127.0.1.200"))
    yield simulator
    simulator.end()


@pytest.fixture(scope="module")
def client(simulator):
    driver = node("driver", simulator.address, "ur_type:=ur10e")
    client = Client()
    yield client
    client.close()
    driver.end()
    print(driver.output())


@pytest.fixture
def robot(simulator, client):
    simulator.control("clear_surfaces")

    def home():
        goal = client.send(MoveJ, "move_j", joint_positions=HOME, speed=2.0, acceleration=5.0)
        return goal.accepted and goal.result().success

    wait_for(home, 30.0, "the driver to take a motion")
    return client


def search(client, **fields):
    return client.send(SpiralSearch, "spiral_search", **{"pitch": 0.01, "speed": 0.04, **fields})


def position(simulator):
    return simulator.state()["actual_tcp_pose"][:3]


def test_it_stops_at_the_wall_it_meets(robot, simulator):
    start = position(simulator)
    simulator.control("place_surface", point=[start[0] - 0.008, 0.0, 0.0], normal=[1, 0, 0])
    result = search(robot).succeeded(60.0)
    end = position(simulator)
    assert end[0] == pytest.approx(start[0] - 0.008, abs=0.003) and end[2] == pytest.approx(start[2], abs=0.001)
    assert result.distance == pytest.approx(math.dist(start, end), abs=0.004)


def test_it_says_that_nothing_was_met_and_has_gone_no_further_than_the_radius(robot, simulator):
    start = position(simulator)
    result = search(robot, radius=0.01).result(60.0)
    assert not result.success and result.error_code == ErrorCode.NOT_REACHED, result.message
    assert math.dist(start, position(simulator)) < 0.013


def test_cancel_ends_the_loop_on_the_controller_and_the_arm_stands_still(robot, simulator):
    goal = search(robot, radius=0.05)
    wait_for(lambda: not simulator.state()["at_rest"], 20.0, "the search to begin")
    goal.cancel()
    status, result = goal.end()
    assert status == GoalStatus.STATUS_CANCELED and result.error_code == ErrorCode.CANCELED
    assert simulator.state()["at_rest"]
    robot.send(MoveJ, "move_j", joint_positions=HOME, speed=2.0).succeeded()


def test_a_protective_stop_ends_it_with_its_own_code(robot, simulator):
    goal = search(robot, radius=0.05)
    wait_for(lambda: not simulator.state()["at_rest"], 20.0, "the search to begin")
    simulator.control("protective_stop", reason="of the test")
    assert goal.result().error_code == ErrorCode.PROTECTIVE_STOP
    assert simulator.state()["at_rest"]
