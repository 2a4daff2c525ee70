"""A client of the nodes, in a thread of its own."""

import threading
import time

import own_domain  # noqa: F401 -- reserves a domain
import rclpy
from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from support import seconds, wait_for

from ur_ros_rtde_msgs.msg import GoalRejected
from ur_ros_rtde_msgs.srv import GetJointState

TRANSIENT_LOCAL = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Goal:
    def __init__(self, client, future):
        self._client, self._future = client, future
        self.feedback = []
        self.result_at = 0  # ns since the epoch; 0: there is none yet
        self._result = None

    def answered(self):
        """Returns whether the goal has been accepted or rejected."""
        return self._future.done()

    @property
    def handle(self):
        return wait_for(lambda: self._future.done() and self._future.result(), 10.0, "the goal response")

    @property
    def accepted(self):
        return self.handle.accepted

    @property
    def id(self):
        return bytes(self.handle.goal_id.uuid)

    def request_result_when_accepted(self):
        """Requests the result on acceptance, in the executor's thread. Otherwise is_finished() requests it."""

        def request_result(future):
            handle = future.result()
            if handle is not None and handle.accepted:
                self._request_result(handle)

        self._future.add_done_callback(request_result)

    def _request_result(self, handle):
        def on_result(_future):
            self.result_at = time.time_ns()

        if self._result is None:
            self._result = handle.get_result_async()
            self._result.add_done_callback(on_result)
        return self._result

    def is_finished(self):
        """Returns whether the result has been received."""
        assert self.accepted, self._client.rejection(self)
        if self._result is None:
            self._client.call_in_executor(lambda: self._request_result(self.handle))
        return self.result_at > 0

    def wait_until(self, condition, limit, what):
        """Waits until `condition()` is true. Fails with the goal's result if the goal ends before."""

        def holds_or_ended():
            return "holds" if condition() else "ended" if self.is_finished() else ""

        assert wait_for(holds_or_ended, limit, what) == "holds", f"the goal ended before {what}: {self.result().message}"

    def wait_for_result(self, limit=30.0):
        """Returns the status and the result."""
        wait_for(self.is_finished, limit, "the result")
        answer = self._result.result()
        return answer.status, answer.result

    def result(self, limit=30.0):
        return self.wait_for_result(limit)[1]

    def succeeded(self, limit=30.0):
        """Asserts that the goal succeeds and returns its result."""
        status, result = self.wait_for_result(limit)
        assert status == GoalStatus.STATUS_SUCCEEDED and result.success, (status, result.error_code, result.message)
        assert result.error_code == 0
        return result

    def cancel(self):
        future = self._client.call_in_executor(self.handle.cancel_goal_async)
        return wait_for(lambda: future.done() and future.result(), 10.0, "the cancel response")


class Client:
    """A node with action and service clients, spun in a thread of its own."""

    def __init__(self, namespace="", domain=None, name="test_client"):
        self.context = rclpy.Context()
        rclpy.init(context=self.context, domain_id=domain)
        # The executor checks every entity on each wake-up: services that no test uses cost processor time.
        self.node = rclpy.create_node(name, namespace=namespace or None, context=self.context, start_parameter_services=False,
                                      enable_rosout=False)
        self._executor = SingleThreadedExecutor(context=self.context)
        self._executor.add_node(self.node)
        self._actions, self._services, self._subscriptions = {}, {}, []
        self.rejections = []
        self.node.create_subscription(GoalRejected, "goal_rejections", self.rejections.append, TRANSIENT_LOCAL)
        self._thread = threading.Thread(target=self._executor.spin, daemon=True)
        self._thread.start()

    def close(self):
        self._executor.shutdown()
        self._thread.join(10.0)
        self.node.destroy_node()
        self.context.try_shutdown()

    def call_in_executor(self, send):
        """Calls `send` in the executor's thread and returns its result.

        rclpy loses a response that arrives while another thread is still sending the request."""
        task = self._executor.create_task(send)
        return wait_for(lambda: task.done() and task.result(), 10.0, "the executor to send the request")

    def send(self, action, name, **fields):
        return self.send_goal(action, name, action.Goal(**fields))

    def send_goal(self, action, name, message):
        client = self.wait_for_server(action, name)
        goal = Goal(self, None)
        goal._future = self.call_in_executor(lambda: client.send_goal_async(
            message, feedback_callback=lambda message: goal.feedback.append(message.feedback)))
        return goal

    def sees(self, name):
        """Returns whether the server of an action that was used before is known."""
        return self._actions[name].server_is_ready()

    def destroy_action_client(self, name):
        """Destroys an action client. This saves processor time: the executor checks every action client on each wake-up."""
        client = self._actions.pop(name, None)
        if client is not None:
            self.call_in_executor(lambda: client.destroy() or True)

    def wait_for_server(self, action, name):
        """Returns the client of an action whose server has been found."""
        if name not in self._actions:
            self._actions[name] = self.call_in_executor(lambda: ActionClient(self.node, action, name))
        client = self._actions[name]
        try:
            wait_for(client.server_is_ready, 60.0, f"the action {name}")
            return client
        except AssertionError as error:
            topics = {topic: self.node.count_publishers(f"{name}/_action/{topic}") for topic in ("feedback", "status")}
            services = sorted(service for service, _ in self.node.get_service_names_and_types() if f"/{name}/_action/" in service)
            raise AssertionError(f"{error}; found topics {topics} and services {services}") from None

    def rejection(self, goal):
        return self.rejection_of(goal.id)

    def rejection_of(self, goal_id: bytes):
        return wait_for(lambda: next((r for r in list(self.rejections) if bytes(r.goal_id.uuid) == goal_id), None), 10.0,
                        "the message on goal_rejections")

    def call(self, service, name, limit=10.0, **fields):
        if name not in self._services:
            self._services[name] = self.node.create_client(service, name)
        client = self._services[name]
        wait_for(client.service_is_ready, 20.0, f"the service {name}")
        future = self.call_in_executor(lambda: client.call_async(service.Request(**fields)))
        return wait_for(lambda: future.done() and future.result(), limit, f"the response of {name}")

    def subscribe(self, message, topic, transient_local=False):
        """Returns a list to which all received messages are appended."""
        messages = []
        qos = TRANSIENT_LOCAL if transient_local else QoSProfile(depth=2000, reliability=ReliabilityPolicy.RELIABLE)
        self._subscriptions.append(self.node.create_subscription(message, topic, messages.append, qos))
        return messages

    def destroy_subscriptions(self):
        """Destroys all subscriptions. A few of them at 500 Hz delay goal responses in Python considerably."""
        subscriptions, self._subscriptions = self._subscriptions, []
        for subscription in subscriptions:
            self.call_in_executor(lambda s=subscription: self.node.destroy_subscription(s))

    def messages_until_now(self, states):
        """Returns the received messages of a state topic up to the current time. Topics lag behind results."""
        now = seconds(self.call(GetJointState, "get_joint_state").joint_state.header.stamp)
        wait_for(lambda: states and seconds(states[-1].header.stamp) >= now, 20.0, "the current state on the topic")
        return list(states)
