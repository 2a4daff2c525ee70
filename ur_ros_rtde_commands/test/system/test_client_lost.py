"""What happens to a running goal when its client disappears."""

import os
import pathlib
import signal
import sys

import pytest
from action_msgs.msg import GoalStatus
from programs import Process, Simulator, start_node
from robot_fixtures import make_ready
from ros_client import Client
from support import FEW_PLUGINS, HOME, REAL_TIME_FACTOR, wait_for
from unique_identifier_msgs.msg import UUID

from ur_ros_rtde_msgs.action import MoveJ, Trigger
from ur_ros_rtde_msgs.msg import ErrorCode

PLUGINS = "plugins:=[move_j,stop,force_mode_start,force_mode_stop]"
TARGET = HOME[0] + 2.0  # rad, a motion of 10 s at the speed of move_j_client.py


class MoveJClient(Process):
    def __init__(self, *arguments, namespace=""):
        program = pathlib.Path(__file__).with_name("move_j_client.py")
        super().__init__([sys.executable, program, TARGET, namespace, *arguments], stdin=True)
        self.goal_id = bytes.fromhex(self.wait_for_output("goal ", 30.0).split()[1])


def wait_until_moving(simulator):
    wait_for(lambda: not simulator.is_at_rest(), 10.0, "the arm to move")


def get_result(client, goal_id, limit=30.0):
    """Returns the status and the result of a goal that another client has sent."""
    service = MoveJ.Impl.GetResultService
    answer = client.call(service, "move_j/_action/get_result", limit=limit, goal_id=UUID(uuid=list(goal_id)))
    return answer.status, answer.result


def assert_arm_was_stopped(simulator, robot, goal_id):
    status, end = get_result(robot, goal_id)
    assert simulator.is_at_rest()
    assert status == GoalStatus.STATUS_ABORTED and not end.success
    assert end.error_code == ErrorCode.CLIENT_LOST and "on_client_lost" in end.message
    assert abs(simulator.state()["actual"]["position"][0] - TARGET) > 0.2, "the arm has reached its target"
    assert simulator.state()["safety_mode"] == "NORMAL"


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_stops_the_arm_at_once_when_the_client_exits(number, robot, simulator, driver, processes):
    client = processes(MoveJClient())
    wait_until_moving(simulator)
    client.signal(number)
    client.wait(10.0)
    wait_for(simulator.is_at_rest, 2.0 + 1.0 / REAL_TIME_FACTOR, "standstill")
    assert_arm_was_stopped(simulator, robot, client.goal_id)
    driver.wait_for_output("client_lost 19")
    make_ready(robot)


def test_stops_the_arm_when_the_lease_of_a_killed_client_expires(robot, simulator, processes):
    """The lease is 3 s, from the package's Fast DDS profile, which the environment of the tests selects."""
    assert {"FASTDDS_DEFAULT_PROFILES_FILE", "FASTRTPS_DEFAULT_PROFILES_FILE"} & os.environ.keys()
    client = processes(MoveJClient())
    wait_until_moving(simulator)
    client.kill()
    wait_for(simulator.is_at_rest, 15.0, "standstill")
    assert_arm_was_stopped(simulator, robot, client.goal_id)
    make_ready(robot)


def test_stops_the_arm_when_a_running_client_destroys_its_action_client(robot, simulator, processes):
    client = processes(MoveJClient("destroy"))
    wait_until_moving(simulator)
    client.write("now\n")
    client.wait_for_output("destroyed")
    assert_arm_was_stopped(simulator, robot, client.goal_id)
    assert client.running()
    make_ready(robot)


def test_continues_the_goal_when_another_client_exits(robot, simulator, processes):
    idle = processes(Process([sys.executable, "-c", IDLE_CLIENT]))
    idle.wait_for_output("ready")
    goal = robot.send(MoveJ, "move_j", joint_positions=[HOME[0] + 0.5, *HOME[1:]], speed=0.2, acceleration=0.5)
    wait_until_moving(simulator)
    idle.signal(signal.SIGTERM)
    idle.wait(10.0)
    goal.succeeded()


MODE_CLIENT = """
import sys
import rclpy
from rclpy.action import ActionClient
from ur_ros_rtde_msgs.action import ForceMode
rclpy.init()
node = rclpy.create_node("mode_client")
client = ActionClient(node, ForceMode, "force_mode_start")
assert client.wait_for_server(timeout_sec=20.0)
compliant = [False, False, True, False, False, False]
sent = client.send_goal_async(ForceMode.Goal(compliant=compliant, outlives_client=sys.argv[1:] == ["outlives"]))
rclpy.spin_until_future_complete(node, sent)
result = sent.result().get_result_async()
rclpy.spin_until_future_complete(node, result)
assert result.result().result.success, result.result().result.message
print("force mode", flush=True)
rclpy.spin(node)
"""
MODE_ENDED = "the client that switched on the mode of the arm has disappeared"


@pytest.fixture
def start_mode(robot, simulator, processes):
    """Returns a function that starts a client which leaves force mode on."""

    def start(*arguments):
        client = processes(Process([sys.executable, "-c", MODE_CLIENT, *arguments]))
        client.wait_for_output("force mode", 30.0)
        assert simulator.state()["force_mode"]
        return client

    return start


def end(client):
    client.signal(signal.SIGTERM)
    client.wait(10.0)


def wait_until_mode_is_ended(driver, simulator, log):
    """Waits until the driver has ended force mode, and asserts that it did so once since line `log` of its output."""
    wait_for(lambda: not simulator.state()["force_mode"], 15.0, "the end of force mode")
    driver.wait_for_output(MODE_ENDED)
    assert sum(MODE_ENDED in line for line in driver.lines[log:]) == 1


def test_a_mode_that_outlasts_its_goal_ends_with_its_client(robot, simulator, driver, start_mode):
    log = len(driver.lines)
    end(start_mode())
    wait_until_mode_is_ended(driver, simulator, log)
    make_ready(robot)


def test_a_mode_outlives_its_client_on_request(robot, simulator, driver, start_mode):
    log = len(driver.lines)
    end(start_mode("outlives"))
    end(start_mode())
    wait_until_mode_is_ended(driver, simulator, log)
    make_ready(robot)


def test_a_mode_does_not_end_with_the_client_of_an_earlier_one(robot, simulator, driver, start_mode):
    log = len(driver.lines)
    earlier = start_mode()
    robot.send(Trigger, "force_mode_stop").succeeded()
    later = start_mode("outlives")
    end(earlier)
    end(start_mode())
    wait_until_mode_is_ended(driver, simulator, log)
    assert later.running()
    make_ready(robot)


IDLE_CLIENT = """
import rclpy
from rclpy.action import ActionClient
from ur_ros_rtde_msgs.action import MoveJ
rclpy.init()
node = rclpy.create_node("idle_client")
client = ActionClient(node, MoveJ, "move_j")
assert client.wait_for_server(timeout_sec=20.0)
print("ready", flush=True)
rclpy.spin(node)
"""


def test_continues_the_goal_of_a_lost_client_if_on_client_lost_is_continue(addresses, processes):
    simulator = processes(Simulator(addresses[1]))
    processes(start_node("driver", addresses[1], FEW_PLUGINS, "ur_type:=ur10e", "on_client_lost:=continue",
                         namespace="continuing"))
    robot = Client("continuing", name="other_client")
    try:
        make_ready(robot)
        client = processes(MoveJClient(namespace="continuing"))
        wait_until_moving(simulator)
        client.signal(signal.SIGTERM)
        client.wait(10.0)
        status, end = get_result(robot, client.goal_id, 40.0)
        assert status == GoalStatus.STATUS_SUCCEEDED and end.success, end.message
        assert simulator.state()["actual"]["position"][0] == pytest.approx(TARGET, abs=0.01)
    finally:
        robot.close()
