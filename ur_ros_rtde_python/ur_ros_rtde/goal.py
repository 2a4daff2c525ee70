"""A running goal, and several that belong together."""

import asyncio
import concurrent.futures
import contextlib
import threading
import time
from collections.abc import Callable, Generator
from types import TracebackType
from typing import Any

from ur_ros_rtde_cli.driver_watch import CANCEL_TIMEOUT, CHECK_PERIOD, DriverWatch, loss

from .connection import Connection, load, own_signals
from .conversions import interface
from .errors import INVALID_GOAL, CommandFailed, NoDriver, Rejected, RobotError, Timeout

Progress = Callable[[Any], object]


class Goal:
    """A goal that the driver executes. `arm.start.…` creates it.

    `await goal` and `goal.result()` return the result. As a context manager, a goal is canceled at the end of the block; if
    it has failed before, CommandFailed is raised there.
    """

    def __init__(self, connection: Connection, name: str, message: Any, on_finished: Callable[["Goal"], None]):
        self.name = name
        self._connection, self._message, self._on_finished = connection, message, on_finished
        self._client: Any = None
        self._handle: Any = None
        self._driver: DriverWatch | None = None  # to which the goal was sent
        self._answered: concurrent.futures.Future[Any] = concurrent.futures.Future()
        self._finished: concurrent.futures.Future[Any] = concurrent.futures.Future()
        self._changed = threading.Condition()
        self._unreported: list[Any] = []  # feedback
        self._feedback: Any = None
        self._cancel_requested = self._queued = self._abandoned = False

    @property
    def feedback(self) -> Any:
        """The newest feedback, or None."""
        return self._feedback

    @property
    def is_finished(self) -> bool:
        return self._finished.done()

    @property
    def may_have_succeeded(self) -> bool:
        """Whether the goal was sent, and has succeeded or its answer or result is not known."""
        if not self.is_finished:
            return self._queued
        return self._handle is not None and self._has_succeeded(self._finished.result())

    def send(self) -> "Goal":
        """Sends the goal and returns when it is accepted. Raises Rejected or NoDriver."""
        with own_signals():
            return self._send_and_wait()

    def _send_and_wait(self) -> "Goal":
        try:
            self._client = self._connection.action_client(self.name)
            self._queued = True
            self._connection.in_executor(self._send)
            if not self._connection.wait(self._answered, self._connection.timeout):
                raise NoDriver(f"{self.name}: the driver did not answer within {self._connection.timeout:g} s")
        except BaseException:
            self.abandon()
            raise
        handle = self._answered.result()
        if not handle.accepted:
            rejection = self._connection.rejection(bytes(handle.goal_id.uuid))
            raise Rejected(self.name, getattr(rejection, "error_code", INVALID_GOAL),
                          getattr(rejection, "message", "rejected; see the log of the driver for the reason"))
        return self

    def result(self, timeout: float | None = None, on_progress: Progress | None = None) -> Any:
        """Waits and returns the result message. Raises CommandFailed, NoDriver or Timeout, and RobotError if the Robot is closed.

        `on_progress` is called with each feedback message. Any exception, also one of `on_progress`, and Ctrl-C cancel the goal; it
        propagates when the arm is at standstill. The same applies after `timeout` s.
        """
        with own_signals():
            try:
                if not self._wait(timeout, on_progress):
                    raise Timeout(f"{self.name} has not ended within {timeout:g} s; it was canceled")
            except BaseException:
                self.abandon()
                raise
        return self._outcome()

    def wait(self, timeout: float) -> bool:
        """Waits at most `timeout` s. Returns whether the goal has ended. Does not cancel it."""
        return self._wait(timeout, None)

    def cancel(self, timeout: float = CANCEL_TIMEOUT) -> Any:
        """Cancels the goal, waits until the arm is at standstill, and returns the result message."""
        self.request_cancel()
        if not self._wait(timeout, None):
            raise Timeout(f"{self.name} has not ended within {timeout:g} s after it was canceled")
        response = self._finished.result()
        return None if response is None else response.result

    def abandon(self) -> None:
        """Cancels the goal and waits for its end, at most CANCEL_TIMEOUT. Used while an exception propagates; works once."""
        try:
            if self._queued and not self.is_finished and not self._abandoned:
                self._abandoned = True
                with contextlib.suppress(RobotError):
                    self._connection.over_open_connection(self._cancel_over)
        finally:
            self._on_finished(self)

    def _cancel_over(self, connection: Connection) -> None:
        """Cancels the goal and waits for its end over the connection of the Robot, or over another one."""
        if connection is self._connection:
            self.cancel()
            return
        if self._handle is None:
            return
        action, goal_id = load(self.name, self._connection.types[self.name]), self._handle.goal_id
        cancel = interface("action_msgs/srv/CancelGoal")
        request = cancel.Request()
        request.goal_info.goal_id = goal_id
        connection.request(cancel, f"{self.name}/_action/cancel_goal", request, connection.timeout)
        result = action.Impl.GetResultService
        connection.request(result, f"{self.name}/_action/get_result", result.Request(goal_id=goal_id), CANCEL_TIMEOUT)

    def __await__(self) -> Generator[Any, None, Any]:
        return self._await().__await__()

    async def _await(self) -> Any:
        try:
            finished = asyncio.wrap_future(self._finished)
            while not self.is_finished:
                await asyncio.wait([finished], timeout=CHECK_PERIOD)  # a canceled task does not cancel the future
                self._check_driver()
        except BaseException:  # the task was canceled, or the driver is gone
            await asyncio.shield(self._abandon_in_thread())
            raise
        return self._outcome()

    def _abandon_in_thread(self) -> "asyncio.Future[None]":
        """In a thread of its own: those of the event loop may all be busy with what the program waits for."""
        done: concurrent.futures.Future[None] = concurrent.futures.Future()

        def abandon() -> None:
            try:
                self.abandon()
            finally:
                done.set_result(None)

        threading.Thread(target=abandon, name="ur_ros_rtde_cancel").start()
        return asyncio.wrap_future(done)

    def __enter__(self) -> "Goal":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if kind is not None:
            self.abandon()
        elif not self.is_finished:
            try:
                self.cancel()
            except Timeout:
                raise
            except BaseException:  # Ctrl-C, or a closed connection
                self.abandon()
                raise
        elif not self._cancel_requested:
            self._outcome()

    # In the thread of the caller

    def _wait(self, timeout: float | None, on_progress: Progress | None) -> bool:
        """Returns whether the goal has ended within `timeout` s. Raises NoDriver, and RobotError if the connection is closed."""
        end = None if timeout is None else time.monotonic() + timeout
        while True:
            with self._changed:
                rest = CHECK_PERIOD if end is None else min(CHECK_PERIOD, end - time.monotonic())
                self._changed.wait_for(lambda: self.is_finished or (on_progress and self._unreported), max(0.0, rest))
                feedback, self._unreported = self._unreported, []
            for message in feedback if on_progress else ():
                on_progress(message)  # type: ignore[misc]
            if self.is_finished:
                return True
            if end is not None and time.monotonic() >= end:
                return False
            self._check_driver()

    def _check_driver(self) -> None:
        """Raises NoDriver if the driver has been missing for a while, and RobotError if the connection is closed."""
        if self.is_finished:
            return
        is_lost = self._driver is not None and self._connection.ask(self._driver.is_gone)
        if is_lost and not self.is_finished:
            raise NoDriver(loss(self.name))

    def request_cancel(self) -> None:
        """Cancels the goal without waiting for its end."""
        self._cancel_requested = True
        handle = self._handle
        if handle is not None and not self.is_finished:
            self._connection.in_executor(handle.cancel_goal_async)

    def _outcome(self) -> Any:
        response = self._finished.result()
        if not self._has_succeeded(response):
            raise CommandFailed(self.name, response.result)
        return response.result

    @staticmethod
    def _has_succeeded(response: Any) -> bool:
        succeeded = interface("action_msgs/msg/GoalStatus").STATUS_SUCCEEDED
        return response.status == succeeded and bool(getattr(response.result, "success", True))

    # In the executor's thread

    def _send(self) -> None:
        if self._cancel_requested:
            self._finish(None)
            return
        self._driver = DriverWatch(self._connection.node, self._client, self._connection.full_name(self.name))
        self._client.send_goal_async(self._message, feedback_callback=self._on_feedback).add_done_callback(self._on_answer)

    def _on_answer(self, future: Any) -> None:
        handle = future.result()
        if handle.accepted:
            self._handle = handle
            if self._driver is not None:
                self._driver.remember()
            handle.get_result_async().add_done_callback(self._on_result)
            if self._cancel_requested:
                handle.cancel_goal_async()
        else:
            self._finish(None)
        self._answered.set_result(handle)

    def _on_feedback(self, message: Any) -> None:
        with self._changed:
            self._feedback = message.feedback
            self._unreported.append(message.feedback)
            del self._unreported[:-1000]
            self._changed.notify_all()

    def _on_result(self, future: Any) -> None:
        self._finish(future.result())

    def _finish(self, response: Any) -> None:
        """`response` is None if the goal was not accepted."""
        with self._changed:
            self._finished.set_result(response)
            self._changed.notify_all()
        self._on_finished(self)


def wait_for_all(*goals: Goal, timeout: float | None = None) -> list[Any]:
    """Waits until all goals, of one arm or of several, have succeeded. Returns their results in the order of the goals.

    If one of them fails, the others are canceled, and its CommandFailed is raised when all arms are at standstill. The same applies to
    a lost driver (NoDriver), to `timeout` s (Timeout), and to Ctrl-C. The others begin to decelerate when the result of the failed goal
    is there, that is at the standstill of its arm.
    """
    with own_signals():
        try:
            _wait_for_success(goals, timeout)
            return [goal._outcome() for goal in goals]
        except BaseException:
            for goal in goals:  # all decelerate at the same time
                with contextlib.suppress(RobotError):
                    goal.request_cancel()
            for goal in goals:
                goal.abandon()
            raise


def _wait_for_success(goals: tuple[Goal, ...], timeout: float | None) -> None:
    """Returns when all goals have succeeded. Raises what ends the wait before."""
    end = None if timeout is None else time.monotonic() + timeout
    while running := [goal for goal in goals if not goal.is_finished]:
        rest = CHECK_PERIOD if end is None else min(CHECK_PERIOD, end - time.monotonic())
        if rest <= 0.0:
            names = ", ".join(goal.name for goal in running)
            raise Timeout(f"not ended within {timeout:g} s: {names}; all goals were canceled")
        concurrent.futures.wait([goal._finished for goal in running], rest, concurrent.futures.FIRST_COMPLETED)
        for goal in goals:
            if goal.is_finished:
                goal._outcome()
            else:
                goal._check_driver()
