"""An action whose server is created for its first client, as ROS tools and rclpy see it."""

import os

import pytest
from conftest import LIMIT, eventually, result_of
from rclpy.action import ActionClient
from rclpy.action.graph import get_action_names_and_types, get_action_server_names_and_types_by_node
from test_msgs.action import Fibonacci

pytestmark = pytest.mark.skipif(os.environ.get("ROS_DISTRO") == "humble", reason="Humble does not report new subscriptions")
NAME = "/on_demand"
TYPE = ["test_msgs/action/Fibonacci"]


def endpoints(node):
    """The endpoints of the action that the test node has."""
    of_node = (node.get_service_names_and_types_by_node, node.get_publisher_names_and_types_by_node)
    return sorted(name.removeprefix(f"{NAME}/_action/") for find in of_node for name, _ in find("test_node", "/")
                  if name.startswith(f"{NAME}/_action/"))


def test_is_listed_with_its_type_before_the_server_exists(ros, test_node):
    eventually(lambda: ("test_node", "/") in ros.node.get_node_names_and_namespaces())
    eventually(lambda: (NAME, TYPE) in get_action_names_and_types(ros.node))
    eventually(lambda: "/forgetful/_action/send_goal" in dict(ros.node.get_service_names_and_types_by_node("test_node", "/")))
    assert (NAME, TYPE) in get_action_server_names_and_types_by_node(ros.node, "test_node", "/")
    assert endpoints(ros.node) == ["feedback"]


def test_the_first_client_gets_a_result_with_its_feedback(ros, test_node):
    client = ros.call_in_executor(lambda: ActionClient(ros.node, Fibonacci, NAME))
    feedback = []
    eventually(client.server_is_ready)
    goal = result_of(ros.call_in_executor(lambda: client.send_goal_async(Fibonacci.Goal(order=8), feedback.append)))
    result = result_of(ros.call_in_executor(goal.get_result_async), LIMIT)
    assert list(result.result.sequence) == [0, 1, 1, 2, 3, 5, 8, 13]
    eventually(lambda: feedback)
    assert endpoints(ros.node) == ["cancel_goal", "feedback", "get_result", "send_goal", "status"]
    ros.call_in_executor(lambda: client.destroy() or True)


def test_the_server_stays_when_its_client_is_gone(ros, test_node):
    eventually(lambda: ros.node.count_subscribers(f"{NAME}/_action/feedback") == 0)
    assert "send_goal" in endpoints(ros.node)
