"""The process of a client exits while its goal is active."""

import os
import signal
import subprocess
import sys

import pytest
from action_msgs.msg import GoalStatus
from conftest import LIMIT, eventually
from test_msgs.action import Fibonacci
from unique_identifier_msgs.msg import UUID

CLIENT = """
import rclpy
from rclpy.action import ActionClient
from test_msgs.action import Fibonacci
rclpy.init()
node = rclpy.create_node("client_that_ends")
client = ActionClient(node, Fibonacci, "/fibonacci")
assert client.wait_for_server(10.0)
sent = client.send_goal_async(Fibonacci.Goal(order=1000))  # runs until it is canceled
rclpy.spin_until_future_complete(node, sent)
print(bytes(sent.result().goal_id.uuid).hex(), flush=True)
rclpy.spin(node)
"""

SHORT, LONG = 2, 60  # s, leases: a client that is killed is detected by the end of its lease
PROFILE = """<?xml version="1.0" encoding="UTF-8" ?>
<dds xmlns="http://www.eprosima.com"><profiles>
  <participant profile_name="lease" is_default_profile="true"><rtps><builtin><discovery_config>
    <leaseDuration><sec>{lease}</sec></leaseDuration>
    <leaseAnnouncement><sec>0</sec><nanosec>500000000</nanosec></leaseAnnouncement>
  </discovery_config></builtin></rtps></participant>
</profiles></dds>
"""


class ClientProcess:
    def __init__(self, **environment):
        self.process = subprocess.Popen([sys.executable, "-c", CLIENT], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                        text=True, env={**os.environ, **environment})
        self.goal_id = UUID(uuid=list(bytes.fromhex(self.process.stdout.readline())))

    def kill(self, number):
        self.process.send_signal(number)
        self.process.wait(LIMIT)


@pytest.fixture
def start(tmp_path):
    clients = []
    profile = tmp_path / "lease.xml"

    def start(lease=SHORT):
        profile.write_text(PROFILE.format(lease=lease))
        clients.append(ClientProcess(FASTDDS_DEFAULT_PROFILES_FILE=str(profile), FASTRTPS_DEFAULT_PROFILES_FILE=str(profile)))
        return clients[-1]

    yield start
    for client in clients:
        client.process.kill()
        client.process.wait(LIMIT)


def losses(test_node):
    return [line for line in test_node.errors if "its client has disappeared" in line]


def result(ros, goal_id):
    service = Fibonacci.Impl.GetResultService
    return ros.call(service, "/fibonacci/_action/get_result", service.Request(goal_id=goal_id))


@pytest.mark.parametrize("number, lease", [(signal.SIGTERM, LONG), (signal.SIGINT, LONG), (signal.SIGKILL, SHORT)])
def test_detects_that_a_client_has_exited(ros, test_node, start, number, lease):
    assert SHORT < LIMIT < LONG
    client, before = start(lease), len(losses(test_node))
    client.kill(number)
    eventually(lambda: len(losses(test_node)) == before + 1)
    assert result(ros, client.goal_id).status == GoalStatus.STATUS_ABORTED


def test_a_running_client_is_not_considered_lost(ros, test_node, start):
    client, other, before = start(), start(), len(losses(test_node))
    other.kill(signal.SIGKILL)
    eventually(lambda: len(losses(test_node)) == before + 1)
    assert result(ros, other.goal_id).status == GoalStatus.STATUS_ABORTED
    client.kill(signal.SIGTERM)
    eventually(lambda: len(losses(test_node)) == before + 2)
