"""STOP: decelerates the arm, by the fastest way that the driver offers.

The action `stop` is never rejected because the arm is busy, ends the goal that moves the arm, and stops the robot program if the
controller does not carry it out. If command_server does not accept the goal in time, or sends nothing more while the arm decelerates,
dashboard_server stops the program.
"""

import time
from enum import Enum
from typing import Any, Callable, Optional

from rclpy.action import ActionClient

from ur_ros_rtde_msgs.action import DashboardCommand, Stop

from .control_node import ControlNode, create_steady_timer
from .goals import Goals

ACCEPTANCE_TIMEOUT = 0.3  # s; the driver needs 2 ms
SILENCE_TIMEOUT = 0.5  # s, until the next feedback or the result; the driver sends feedback at 20 Hz
DASHBOARD_TIMEOUT = 3.0  # s; a controller needs up to 1 s
CHECKS = 5  # for an answer, within a timeout
REPEAT_GAP = 1.0  # s; presses that follow each other faster are those of one button that is held


class Outcome(Enum):
    STOPPING = "The arm decelerates."
    STOPPED = "Stopped."
    PROGRAM = "The robot program is being stopped through dashboard_server:"
    FAILED = "STOP failed:"


Report = Callable[[Outcome, str], None]


class Stopper:
    def __init__(self, control: ControlNode, goals: Goals):
        self._control = control
        self._stop = goals.client("stop", Stop)
        self._dashboard = goals.client("dashboard/stop", DashboardCommand)
        self._hold = _Hold()

    def press(self, report: Report) -> None:
        """Stops the arm. `report` is called in the thread of the node. An answer that comes late is reported, too."""
        self._control.post(lambda: self._start(report))

    def _start(self, report: Report) -> None:
        if time.monotonic() - self._hold.last_press > REPEAT_GAP:
            self._hold = _Hold()
        self._hold.last_press = time.monotonic()
        _Press(self._control, self._stop, self._dashboard, self._hold, report).start()


class _Hold:
    """The presses while the button is held: the time until standstill counts from the first one."""

    def __init__(self) -> None:
        self.begin = self.last_press = time.monotonic()
        self.rest: Optional[float] = None  # time of the standstill after a press


class _Silence:
    """Calls `on_silence` once if nothing is heard for `timeout` s. Lives in the thread of the node, and counts only time in which
    this thread could have taken an answer: a thread that was late by more than the timeout finds the answer and its own timer together."""

    def __init__(self, node: Any, timeout: float, on_silence: Callable[[], None]):
        self._node, self._on_silence = node, on_silence
        self._missed = 0  # checks since an answer
        self._timer = create_steady_timer(node, timeout / CHECKS, self._check)

    def _check(self) -> None:
        self._missed += 1
        if self._missed == CHECKS:
            self._on_silence()

    def heard(self) -> None:
        self._missed = 0

    def end(self) -> None:
        self._node.destroy_timer(self._timer)


class _Press:
    """One press of the button. All methods run in the thread of the node."""

    def __init__(self, control: ControlNode, stop: ActionClient, dashboard: ActionClient, hold: _Hold, report: Report):
        self._node = control.node
        self._stop, self._dashboard, self._hold, self._report = stop, dashboard, hold, report
        self._silence: Optional[_Silence] = None  # while an answer is expected
        self._fell_back = False  # to dashboard_server
        self._begin = time.monotonic()

    def start(self) -> None:
        if not self._stop.server_is_ready():
            self._stop_program("command_server does not answer")
            return
        self._expect_answer(ACCEPTANCE_TIMEOUT, lambda: self._stop_program("command_server did not accept the stop"))
        self._stop.send_goal_async(Stop.Goal(), feedback_callback=lambda message: self._on_feedback()).add_done_callback(
            lambda future: self._on_response(future.result()))

    def _on_response(self, handle: Any) -> None:
        if not handle.accepted:
            self._stop_program("command_server rejected the stop")
            return
        handle.get_result_async().add_done_callback(lambda future: self._on_result(future.result().result))
        if not self._fell_back:
            if self._hold.rest is None:
                self._report(Outcome.STOPPING, "")
            self._expect_answer(SILENCE_TIMEOUT, lambda: self._stop_program("command_server has not answered since it accepted the stop"))

    def _on_feedback(self) -> None:
        if self._silence is not None and not self._fell_back:
            self._silence.heard()

    def _on_result(self, result: Any) -> None:
        if not result.success:
            self._stop_program(result.message)
            return
        self._expect_nothing()
        if self._hold.rest is not None and (result.time_to_standstill == 0.0 or self._begin < self._hold.rest):
            return  # this standstill has been reported
        self._hold.rest = time.monotonic()
        self._report(Outcome.STOPPED, f"At rest after {self._hold.rest - self._hold.begin:.2f} s, at {time.strftime('%H:%M:%S')}.")

    def _expect_answer(self, timeout: float, on_silence: Callable[[], None]) -> None:
        """`on_silence` ends the expectation."""
        self._expect_nothing()
        self._silence = _Silence(self._node, timeout, on_silence)

    def _expect_nothing(self) -> None:
        if self._silence is not None:
            self._silence.end()
            self._silence = None

    def _stop_program(self, reason: str) -> None:
        if self._fell_back:
            return
        self._expect_nothing()
        self._fell_back = True
        if not self._dashboard.server_is_ready():
            self._report(Outcome.FAILED, "neither command_server nor dashboard_server answers. Use the emergency stop button, then check "
                                         "that the driver runs with this ROS_DOMAIN_ID")
            return
        self._report(Outcome.PROGRAM, reason)
        self._expect_answer(DASHBOARD_TIMEOUT, lambda: self._report_failure(f"no answer within {DASHBOARD_TIMEOUT:g} s"))
        self._dashboard.send_goal_async(DashboardCommand.Goal()).add_done_callback(
            lambda future: self._on_dashboard_response(future.result()))

    def _on_dashboard_response(self, handle: Any) -> None:
        if handle.accepted:
            handle.get_result_async().add_done_callback(lambda future: self._on_dashboard_result(future.result().result))
        else:
            self._report_failure("rejected")

    def _on_dashboard_result(self, result: Any) -> None:
        if not result.success:
            self._report_failure(result.message)
            return
        self._expect_nothing()
        self._report(Outcome.STOPPED, "The robot program was stopped.")

    def _report_failure(self, reason: str) -> None:
        self._expect_nothing()
        self._report(Outcome.FAILED, f"dashboard/stop: {reason}. Use the emergency stop button")
