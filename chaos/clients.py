"""Clients that send one goal after another, each from its own node, and check the results."""

import contextlib
import threading
import time
from collections import Counter

import messages
from cell import CODES, StatusTrackingClient
from goals import Mix

ANSWER_LIMIT = 15.0  # s, from sending a goal to its acceptance or rejection
RESULT_LIMIT = 45.0  # s, from acceptance to the result, for the longest example with the longest fault
PAUSE = 0.02  # s, between two goals
PAUSE_AFTER_REJECTION = 0.2  # s


def describe(result):
    """Returns whether a goal has succeeded, and a text that begins with the name of the error code and a colon."""
    if hasattr(result, "error_string"):  # control_msgs/action/FollowJointTrajectory
        return result.error_code == result.SUCCESSFUL, f"{result.error_code}: {result.error_string}"
    return result.success, f"{CODES[result.error_code]}: {result.message}"


class Gate:
    """Allows or blocks new goals, and counts the active ones."""

    def __init__(self):
        self._changed = threading.Condition()
        self._open = True
        self._active = 0
        self._idle_since = time.monotonic()

    def set(self, is_open):
        with self._changed:
            self._open = is_open
            self._changed.notify_all()

    def enter(self, stop):
        """Waits until goals are allowed. Returns False when the run is over."""
        with self._changed:
            self._changed.wait_for(lambda: self._open or stop.is_set())
            if stop.is_set():
                return False
            self._active += 1
            return True

    @contextlib.contextmanager
    def bypass(self):
        """Counts a goal of the run itself, which is never blocked."""
        with self._changed:
            self._active += 1
        try:
            yield
        finally:
            self.leave()

    def leave(self):
        with self._changed:
            self._active -= 1
            self._idle_since = time.monotonic()
            self._changed.notify_all()

    def restart_idle_time(self):
        """Motions without a goal up to now are not violations."""
        with self._changed:
            self._idle_since = time.monotonic()

    def idle_for(self):
        """Returns the time since the last goal ended, s; 0 while one is active."""
        with self._changed:
            return 0.0 if self._active else time.monotonic() - self._idle_since

    def wait_until_idle(self, limit):
        with self._changed:
            return self._changed.wait_for(lambda: self._active == 0, limit)


class GoalSender:
    """A client that sends goals in its own thread."""

    def __init__(self, name, random, gate, journal):
        self._name, self._mix, self._gate, self._journal = name, Mix(random), gate, journal
        self._stop = threading.Event()
        self._client = StatusTrackingClient(name=name.replace(" ", "_"))
        self.outcomes: Counter[str] = Counter()
        self._thread = threading.Thread(target=self._run, name=name)

    def start(self):
        self._thread.start()

    def stop(self):
        self._stop.set()
        self._gate.set(True)

    def join(self):
        self._thread.join(ANSWER_LIMIT + RESULT_LIMIT)
        if self._thread.is_alive():
            self._journal.violate(self._name, "the client thread does not end")
        self._client.close()

    def _run(self):
        while self._gate.enter(self._stop):
            outcome = "rejected"
            try:
                outcome = self._execute(self._mix.next())
            except Exception as error:  # also a wrong assumption of this test, which must not go on with fewer clients
                self._journal.violate(self._name, f"{type(error).__name__}: {error}")
                return
            finally:
                self._gate.leave()
            self.outcomes[outcome] += 1
            self._stop.wait(PAUSE_AFTER_REJECTION if outcome.startswith("rejected") else PAUSE)

    def _execute(self, plan):
        self._journal.write(self._name, plan.text())
        goal = self._client.send_goal(messages.load(plan.type), plan.name, plan.message())
        if not goal.accepted:
            rejection = self._client.rejection(goal)
            self._journal.write(self._name, f"  rejected, {CODES[rejection.error_code]}: {rejection.message}")
            return f"rejected, {CODES[rejection.error_code]}"
        if plan.cancel_after is not None:
            self._cancel(goal, plan.cancel_after)
        return self._result(plan, goal)

    def _cancel(self, goal, after):
        end = time.monotonic() + after
        while time.monotonic() < end and not goal.is_finished():
            time.sleep(0.01)
        goal.cancel()

    def _result(self, plan, goal):
        status, result = goal.wait_for_result(RESULT_LIMIT)
        succeeded, text = describe(result)
        self._journal.write(self._name, f"  {plan.name} {goal.id.hex()[:8]}: {text}")
        states = self._client.get_terminal_states(goal)
        assert states == {status}, f"{plan.name}, goal {goal.id.hex()}, has several final states: {states}, result {status}"
        self._client.forget(goal)
        return "succeeded" if succeeded else f"failed, {text.partition(':')[0]}"
