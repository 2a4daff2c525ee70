"""What a lane has started, in one form: a goal of its own client, a goal of a client in another process, or a stream of messages."""

import json
import pathlib
import sys
import threading
import time

import messages
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped, TwistStamped
from sensor_msgs.msg import JointState
from support import HOME, JOINTS, Process, wait_for
from unique_identifier_msgs.msg import UUID

RESULT_TIMEOUT = 25.0  # s; the properties are stricter
STREAM_TIMEOUT = 100_000_000  # ns, the default of the parameter stream_timeout
PERIOD = 0.02  # s, of messages
STANDSTILL = 0.1  # s, of the targets at the start of a stream
TERMINAL = (GoalStatus.STATUS_SUCCEEDED, GoalStatus.STATUS_CANCELED, GoalStatus.STATUS_ABORTED)


class RunningGoal:
    def __init__(self, lane, kind, fields):
        self._lane = lane
        action = messages.load(kind.type)
        self._goal = lane.client.send_goal(action, kind.action, messages.fill(action.Goal(), fields))

    def rejection(self):
        """Returns the message on goal_rejections; None if the goal was accepted."""
        return None if self._goal.accepted else self._lane.client.rejection(self._goal)

    def cancel(self):
        """Returns when the request was sent, ns since the epoch."""
        when = []
        self._lane.client.call_in_executor(lambda: when.append(time.time_ns()) or self._goal.handle.cancel_goal_async())
        return when[0]

    def has_ended(self):
        return self._goal.is_finished()

    def wait_for_result(self):
        """Returns the error code, the message, and when they came, ns since the epoch."""
        _status, result = self._goal.wait_for_result(RESULT_TIMEOUT)
        return result.error_code, getattr(result, "message", getattr(result, "error_string", "")), self._goal.result_at

    def check_single_result(self):
        status, _result = self._goal.wait_for_result(RESULT_TIMEOUT)
        states = self._lane.client.get_terminal_states(self._goal)
        self._lane.client.forget(self._goal)
        return "" if states == {status} else f"the goal has several final states: {states}, its result {status}"

    def close(self):
        pass


class ForeignGoal:
    """A goal of a client that ends. Its result is requested by the client of the lane."""

    def __init__(self, lane, kind, fields):
        self._lane, self._kind = lane, kind
        self.client = lane.take_client()
        self.client.write(json.dumps({"type": kind.type, "action": kind.action, "fields": fields}) + "\n")
        self._answer = wait_for(lambda: next((line for line in list(self.client.lines) if line.startswith(("goal ", "rejected "))), None),
                                30.0, "the answer to the goal of a client")
        self._result = None

    def rejection(self):
        answer, goal_id = self._answer.split()
        return None if answer == "goal" else self._lane.client.rejection_of(bytes.fromhex(goal_id))

    def has_ended(self):
        return False

    def wait_for_result(self):
        service = messages.load(self._kind.type).Impl.GetResultService
        goal_id = UUID(uuid=list(bytes.fromhex(self._answer.split()[1])))
        answer = self._lane.client.call(service, f"{self._kind.action}/_action/get_result", limit=RESULT_TIMEOUT, goal_id=goal_id)
        self._result = answer.status
        return answer.result.error_code, getattr(answer.result, "message", ""), time.time_ns()

    def check_single_result(self):
        return "" if self._result in TERMINAL else f"the goal has the status {self._result}"

    def close(self):
        self.client.kill()


class RunningTopic:
    """Publishes at 50 Hz until it is closed, at first a target at standstill, because the publisher has been used before. It has no
    result."""

    def __init__(self, lane, kind, fields):
        self._lane, self._speed = lane, fields["speed"]
        self._message = getattr(self, f"_{kind.action}")
        self._publisher = lane.publisher(messages.load(kind.type), kind.action)
        self._ended = threading.Event()
        self._last = 0
        self._thread = threading.Thread(target=self._publish, daemon=True)
        self._thread.start()

    def _publish(self):
        begin = time.monotonic()
        number = 0
        while not self._ended.is_set():
            message = self._message(min(max(0.0, time.monotonic() - begin - STANDSTILL), 3.0))
            self._last = time.time_ns()
            self._publisher.publish(message)
            number += 1
            self._ended.wait(max(0.0, begin + number * PERIOD - time.monotonic()))

    def _servo_joint(self, seconds):
        return JointState(name=JOINTS, position=[HOME[0] + self._speed * seconds, *HOME[1:]])

    def _servo_pose(self, seconds):
        message = PoseStamped()
        message.header.frame_id = "base"
        pose = self._lane.scene.pose(y=self._speed * 0.5 * seconds)
        messages.fill(message.pose, pose)
        return message

    def _twist(self, seconds):
        message = TwistStamped()
        message.header.frame_id = "base"
        message.twist.linear.y = 0.4 * self._speed if seconds > 0.0 else 0.0
        return message

    def rejection(self):
        return None

    def cancel(self):
        """Ends the stream. Returns when it is found to have ended, ns since the epoch."""
        self.close()
        return self._last + STREAM_TIMEOUT

    def has_ended(self):
        return False

    def wait_for_result(self):
        return 0, "", time.time_ns()

    def check_single_result(self):
        return ""

    def close(self):
        self._ended.set()
        self._thread.join(5.0)


def start(lane, kind, fields, needs_client):
    if kind.is_topic:
        return RunningTopic(lane, kind, fields)
    return ForeignGoal(lane, kind, fields) if needs_client else RunningGoal(lane, kind, fields)


def start_client(env):
    program = pathlib.Path(__file__).with_name("client.py")
    return Process([sys.executable, program], env=env, stdin=True)


