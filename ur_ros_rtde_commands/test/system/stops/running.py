"""What a lane has started, in one form: a goal of its own client, a goal of a client in another process, or a stream of messages."""

import contextlib
import json
import pathlib
import sys
import threading
import time

import messages
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseStamped, TwistStamped
from programs import Process
from sensor_msgs.msg import JointState
from support import HOME, JOINTS, wait_for
from unique_identifier_msgs.msg import UUID

from .goal_kinds import SPEED

RESULT_TIMEOUT = 25.0  # s; the properties are stricter
STREAM_TIMEOUT = 100_000_000  # ns, the default of the parameter stream_timeout
PERIOD = 0.02  # s, of messages
STANDSTILL = 0.1  # s, of the targets at the start of a stream
GAP = 0.25  # s, in a stream that goes on although the arm was stopped: longer than STREAM_TIMEOUT
AFTER_GAP = 0.1  # s
TERMINAL = (GoalStatus.STATUS_SUCCEEDED, GoalStatus.STATUS_CANCELED, GoalStatus.STATUS_ABORTED)


class RunningGoal:
    def __init__(self, lane, kind, fields):
        self._lane = lane
        action = messages.load(kind.type)
        self._goal = lane.client.send_goal(action, kind.action, messages.fill(action.Goal(), goal_fields(fields)))

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
        """Returns when it came, ns since the epoch."""
        self._goal.wait_for_result(RESULT_TIMEOUT)
        return self._goal.result_at

    def outcome(self):
        """Returns the status and the error code of the result."""
        status, result = self._goal.wait_for_result(RESULT_TIMEOUT)
        return status, result.error_code

    def check_single_result(self):
        status, _result = self._goal.wait_for_result(RESULT_TIMEOUT)
        states = self._lane.client.get_terminal_states(self._goal)
        self._lane.client.forget(self._goal)
        return "" if states == {status} else f"the goal has several final states: {states}, its result {status}"

    def pause(self):
        pass

    def close(self):
        pass


class ForeignGoal:
    """A goal of a client that ends. Its result is requested by the client of the lane."""

    def __init__(self, lane, kind, fields):
        self._lane, self._kind = lane, kind
        self.client = lane.take_client()
        self.client.write(json.dumps({"type": kind.type, "action": kind.action, "fields": goal_fields(fields)}) + "\n")
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
        self._result = answer
        return time.time_ns()

    def outcome(self):
        return self._result.status, self._result.result.error_code

    def check_single_result(self):
        return "" if self._result.status in TERMINAL else f"the goal has the status {self._result.status}"

    def pause(self):
        pass

    def close(self):
        self.client.kill()


class Stream:
    """Publishes at 50 Hz until it is closed, at first a target at standstill, because the publisher has been used before."""

    def __init__(self, publisher, message):
        self._publisher, self._message = publisher, message
        self._ended, self._sends = threading.Event(), threading.Event()
        self._sends.set()
        self.last = 0
        self._thread = threading.Thread(target=self._publish, daemon=True)
        self._thread.start()

    def _publish(self):
        begin = due = time.monotonic()
        while not self._ended.is_set():
            self._sends.wait()
            message = self._message(min(max(0.0, time.monotonic() - begin - STANDSTILL), 3.0))
            self.last = time.time_ns()
            self._publisher.publish(message)
            due = max(due + PERIOD, time.monotonic())
            self._ended.wait(due - time.monotonic())

    def pause(self):
        """As a bad network does, or a page whose button is held. Returns when messages have been sent again."""
        self._sends.clear()
        time.sleep(GAP)
        self._sends.set()
        self._ended.wait(AFTER_GAP)

    def close(self):
        self._ended.set()
        self._thread.join(5.0)


class Messages:
    """Of a stream whose target moves at a constant speed, in s since it began to move."""

    def __init__(self, scene, speed):
        self._scene, self._speed = scene, speed

    def servo_joint(self, seconds):
        return JointState(name=JOINTS, position=[HOME[0] + self._speed * seconds, *HOME[1:]])

    def servo_pose(self, seconds):
        message = PoseStamped()
        message.header.frame_id = "base"
        messages.fill(message.pose, self._scene.pose(y=self._speed * 0.5 * seconds))
        return message

    def twist(self, seconds):
        message = TwistStamped()
        message.header.frame_id = "base"
        message.twist.linear.y = 0.4 * self._speed if seconds > 0.0 else 0.0
        return message


class RunningTopic:
    """A stream that moves the arm. It has no result."""

    def __init__(self, lane, kind, fields):
        publisher = lane.publisher(messages.load(kind.type), kind.action)
        self._stream = Stream(publisher, getattr(Messages(lane.scene, fields[SPEED]), kind.action))

    def rejection(self):
        return None

    def cancel(self):
        """Ends the stream. Returns when it is found to have ended, ns since the epoch."""
        self.close()
        return self._stream.last + STREAM_TIMEOUT

    def has_ended(self):
        return False

    def wait_for_result(self):
        return time.time_ns()

    def outcome(self):
        return None

    def check_single_result(self):
        return ""

    def pause(self):
        self._stream.pause()

    def close(self):
        self._stream.close()


def goal_fields(fields):
    return {name: value for name, value in fields.items() if name != SPEED}


@contextlib.contextmanager
def source(lane, kind, fields):
    """Publishes the poses that the goal follows, if it follows any."""
    if not kind.source:
        yield
        return
    stream = Stream(lane.publisher(PoseStamped, kind.source), Messages(lane.scene, fields[SPEED]).servo_pose)
    try:
        yield
    finally:
        stream.close()


def start(lane, kind, fields, needs_client):
    if kind.is_topic:
        return RunningTopic(lane, kind, fields)
    return ForeignGoal(lane, kind, fields) if needs_client else RunningGoal(lane, kind, fields)


def start_client(env):
    program = pathlib.Path(__file__).with_name("client.py")
    return Process([sys.executable, program], env=env, stdin=True)
