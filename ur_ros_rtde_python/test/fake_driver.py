"""A driver without a robot, whose answers can be delayed and interrupted."""

import time

from action_msgs.msg import GoalStatus
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.task import Future
from ros_client import Client

from ur_ros_rtde_msgs.action import ForceMode, Freedrive, MoveJ, Stop, Trigger
from ur_ros_rtde_msgs.srv import StartRecording, StopRecording

NAMESPACE = "fake"
ACTIONS = {"move_j": MoveJ, "freedrive": Freedrive, "force_mode_start": ForceMode, "force_mode_stop": Trigger, "stop": Stop}
LASTING = ("move_j", "freedrive")  # until they are canceled
DELAY = 0.3  # s, from an event in the driver to its answer


class FakeDriver:
    """`received`: names of the requests, and "cancel NAME". `events`: function by name, called before a delayed answer; after a
    force_mode_start has succeeded. `failures`: message by name of what fails. `rejected`: names of actions."""

    def __init__(self):
        self.received, self.events, self.failures, self.rejected = [], {}, {}, []
        self._client = Client(NAMESPACE, name="fake_driver")
        node = self._client.node
        node.create_service(StartRecording, "start_recording", lambda _, response: self._respond("start_recording", response))
        node.create_service(StopRecording, "stop_recording", lambda _, response: self._respond("stop_recording", response))
        self._servers = [self._client.call_in_executor(lambda name=name, kind=kind: self._server(name, kind))
                         for name, kind in ACTIONS.items()]

    def close(self):
        for server in self._servers:
            server.destroy()
        self._client.close()

    def _happen(self, name):
        if name in self.events:
            self.events.pop(name)()
            time.sleep(DELAY)

    def _respond(self, name, response):
        self.received.append(name)
        self._happen(name)
        response.success = name not in self.failures
        response.message = self.failures.get(name, "")
        return response

    def _server(self, name, kind):
        ended = Future()

        def accept(_):
            return GoalResponse.REJECT if name in self.rejected else GoalResponse.ACCEPT

        def cancel(_):
            self.received.append(f"cancel {name}")
            ended.set_result(True)
            return CancelResponse.ACCEPT

        async def execute(handle):
            self.received.append(name)
            if name in LASTING:
                await ended
                handle.canceled()
            elif name in self.failures:
                handle.abort()
            else:
                handle.succeed()
            self._happen(name)
            return kind.Result(success=handle.status == GoalStatus.STATUS_SUCCEEDED, message=self.failures.get(name, ""))

        return ActionServer(self._client.node, kind, name, execute, goal_callback=accept, cancel_callback=cancel)
