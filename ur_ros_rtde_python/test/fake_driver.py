"""A driver without a robot, whose answers can be delayed and interrupted. A program of its own: Fast DDS may deadlock between two
participants of one process."""

import contextlib
import json
import os
import signal
import sys
import threading
import time

from action_msgs.msg import GoalStatus
from programs import Process
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.task import Future
from ros_client import Client
from support import wait_for

from ur_ros_rtde_msgs.action import ForceMode, Freedrive, MoveJ, Stop, Trigger
from ur_ros_rtde_msgs.srv import StartRecording, StopRecording

NAMESPACE = "fake"
ACTIONS = {"move_j": MoveJ, "freedrive": Freedrive, "force_mode_start": ForceMode, "force_mode_stop": Trigger, "stop": Stop}
LASTING = ("move_j", "freedrive")  # until they are canceled
RECEIVED, SET = "received ", "set"


class FakeDriver:
    """Starts the program. Its behavior: `interrupt`, name of the request after which it sends SIGINT to the test, as Ctrl-C; `delay`, name
    of the request that it answers 1 s late; `hold`, of one that it answers after the next set(); `failures`, message by name of what
    fails; `reject`, name of an action. An interrupted or delayed action has ended by then, and its result is on its way."""

    def __init__(self):
        self._process = Process([sys.executable, __file__], {"PYTHONPATH": os.pathsep.join(sys.path)}, stdin=True)
        self._changes = 0
        self.set()

    def set(self, **behavior):
        self._process.write(json.dumps(behavior) + "\n")
        self._changes += 1
        wait_for(lambda: self._process.lines.count(SET) == self._changes, 30.0, f"the driver: {self._process.output()}")

    @property
    def received(self):
        """The requests until now: their names, and "cancel NAME"."""
        self.set()  # what comes before it in the output was received before
        return [line[len(RECEIVED):] for line in self._process.lines if line.startswith(RECEIVED)]

    def close(self):
        self._process.stop()


class _Program:
    def __init__(self):
        self._behavior = {}
        self._released = threading.Event()
        self._client = Client(NAMESPACE, name="fake_driver")
        node = self._client.node
        node.create_service(StartRecording, "start_recording", lambda _, response: self._respond("start_recording", response))
        node.create_service(StopRecording, "stop_recording", lambda _, response: self._respond("stop_recording", response))
        self._servers = [self._client.call_in_executor(lambda name=name, kind=kind: self._server(name, kind))
                         for name, kind in ACTIONS.items()]

    def run(self):
        with contextlib.closing(self._client), contextlib.suppress(KeyboardInterrupt):
            for line in sys.stdin:
                self._released.set()
                self._behavior.update(json.loads(line))
                print(SET, flush=True)

    def _happen(self, name):
        if self._behavior.get("interrupt") == name:
            del self._behavior["interrupt"]
            os.kill(os.getppid(), signal.SIGINT)
            time.sleep(0.3)
        if self._behavior.get("delay") == name:
            time.sleep(1.0)
        if self._behavior.get("hold") == name:
            self._released.clear()
            self._released.wait()

    def _failure(self, name):
        return self._behavior.get("failures", {}).get(name, "")

    def _respond(self, name, response):
        print(RECEIVED + name, flush=True)
        self._happen(name)
        response.message = self._failure(name)
        response.success = not response.message
        return response

    def _server(self, name, kind):
        ended = Future()

        def accept(_):
            return GoalResponse.REJECT if self._behavior.get("reject") == name else GoalResponse.ACCEPT

        def cancel(_):
            print(f"{RECEIVED}cancel {name}", flush=True)
            ended.set_result(True)
            return CancelResponse.ACCEPT

        async def execute(handle):
            print(RECEIVED + name, flush=True)
            if name in LASTING:
                await ended
                handle.canceled()
            elif self._failure(name):
                handle.abort()
            else:
                handle.succeed()
            self._happen(name)
            return kind.Result(success=handle.status == GoalStatus.STATUS_SUCCEEDED, message=self._failure(name))

        return ActionServer(self._client.node, kind, name, execute, goal_callback=accept, cancel_callback=cancel)


if __name__ == "__main__":
    _Program().run()
