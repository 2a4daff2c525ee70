"""Clients of rcl_cxx with servers of rclpy."""

import threading

import pytest
import rclpy
from conftest import LIMIT, eventually
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from std_msgs.msg import String
from std_srvs.srv import SetBool
from test_msgs.action import Fibonacci


class Servers:
    """An action server and a service of rclpy whose behavior depends on the order."""

    def __init__(self, node):
        group = ReentrantCallbackGroup()
        self.canceled = threading.Event()
        self.action = ActionServer(node, Fibonacci, "/py_fibonacci", self.execute, callback_group=group,
                                   goal_callback=self.check, cancel_callback=lambda _: CancelResponse.ACCEPT)
        self.service = node.create_service(SetBool, "/py_set_bool", self.answer, callback_group=group)

    @staticmethod
    def check(goal):
        return GoalResponse.REJECT if goal.order < 0 else GoalResponse.ACCEPT

    def execute(self, goal):
        sequence = [0, 1]
        while len(sequence) < goal.request.order:
            if goal.is_cancel_requested:
                goal.canceled()
                self.canceled.set()
                return Fibonacci.Result()
            sequence.append(sequence[-1] + sequence[-2])
            goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
            if goal.request.order > 40:
                sequence = [0, 1]
                threading.Event().wait(0.01)
        if goal.request.order == 3:
            goal.abort()
        else:
            goal.succeed()
        return Fibonacci.Result(sequence=sequence)

    @staticmethod
    def answer(request, response):
        response.message = "yes" if request.data else "no"
        return response


@pytest.fixture(scope="module")
def servers(test_node):
    context = rclpy.Context()
    rclpy.init(context=context)
    node = rclpy.create_node("servers", context=context)
    servers = Servers(node)
    executor = MultiThreadedExecutor(4, context=context)
    executor.add_node(node)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    yield servers
    executor.shutdown()
    thread.join(LIMIT)
    servers.action.destroy()
    node.destroy_node()
    rclpy.shutdown(context=context)


@pytest.fixture
def outcome(ros, test_node):
    """Returns a function that makes the node send one request and returns its outcome."""
    messages = ros.subscribe(String, "/outcome", 10)

    def call(kind, number):
        publisher = ros.node.create_publisher(String, f"/call_{kind}", 10)
        eventually(lambda: publisher.get_subscription_count() > 0)
        before = len(messages)
        publisher.publish(String(data=str(number)))
        eventually(lambda: len(messages) > before)
        return messages[-1].data

    return call


def test_calls_a_service(servers, outcome):
    assert outcome("service", 1) == "yes"
    assert outcome("service", 0) == "no"


def test_a_goal_succeeds(servers, outcome):
    status, elements, _ = outcome("action", 8).split()
    assert (status, elements) == ("succeeded", "8")


def test_reports_an_aborted_goal(servers, outcome):
    assert outcome("action", 3).startswith("aborted 3")


def test_reports_a_rejected_goal(servers, outcome):
    assert "goal rejected" in outcome("action", -1)


def test_cancels_a_goal_after_the_timeout(servers, outcome):
    assert "no result within the timeout, cancel requested" in outcome("action", 1000)
    assert servers.canceled.wait(LIMIT)
