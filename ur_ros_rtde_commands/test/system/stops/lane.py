"""A simulated robot with its driver, clients and a holder of threads, which execute cases one after the other.

    python3 -m stops.lane --address 127.0.3.1 --log FOLDER     seeds on stdin, one report in JSON per line on stdout
"""

import argparse
import json
import os
import pathlib
import signal
import sys
import time
import traceback
from dataclasses import asdict
from random import Random
from typing import Any, List, Optional

import messages
from ros_client import Goal
from support import HOME, wait_for

from ur_ros_rtde_msgs.action import MoveJ
from ur_ros_rtde_msgs.msg import ErrorCode

from . import goal_kinds, properties, running
from .cases import Case, draw, profile_of
from .holds import Hold, Holder, threads_of, why_impossible
from .motion import Trace
from .page import Page
from .report import Report
from .robot import READY_LIMIT, RETRY_INTERVAL, Robot
from .stalls import Stalls

ATTEMPTS = 3  # of a case, while the host excuses it
QUIET = 150_000_000  # ns, after which nothing may have moved again
LATE_BEGIN = 100_000_000  # ns after the end of a hold, in which what the threads were told before it begins
MOTION_LIMIT = 5.0  # s, for a goal to move the arm
MODE_LIMIT = 0.8  # s, for a mode, which may not move it


class Lane(Robot):
    def __init__(self, address: str, log: pathlib.Path, holds: bool = True):
        super().__init__(address, log)
        self._log = log
        self.scene = goal_kinds.Scene(self.simulator.state()["actual_tcp_pose"])
        self.page = Page(self.client)
        self._holder = Holder() if holds else None
        self.case: Case
        self.running: Any = None  # see running.start()
        self.trace: Optional[Trace] = None
        self.stalls: Any = None  # since the begin of the case
        self.when = self.took_effect = 0  # the event, and what it did if that can be later, ns since the epoch
        self.fields: dict = {}  # of the goal
        self.held_threads: list = []
        self.holds: Optional[Hold] = None
        self._others: list = []  # goals of the event itself
        self.preempting_goal: Optional[Goal] = None  # the goal that has preempted the one of the case
        self.waiting_goal: Optional[Goal] = None  # the goal that waited for the arm when the event came

    def close(self) -> None:
        if self._holder is not None:
            self._holder.close()
        super().close()

    # --- For events ---

    def send_in_executor(self, action, name: str, **fields) -> int:
        """Sends a goal that belongs to the event. Returns when, ns since the epoch."""
        self.client.wait_for_server(action, name)
        when = self.now()
        self._others.append(self.client.send(action, name, **fields))
        return when

    def press_stop_of_the_page(self) -> int:
        return self.page.press()

    def preempt(self) -> int:
        when = self.now()
        self.preempting_goal = self.client.send(MoveJ, "move_j", joint_positions=HOME, speed=3.0, acceleration=15.0)
        return when

    def _send_waiting_goal(self) -> None:
        self.waiting_goal = self.client.send(MoveJ, "move_j", joint_positions=goal_kinds.home_plus(0.8), speed=0.5)
        if not self.waiting_goal.accepted:
            raise AssertionError(f"the goal that preempts was rejected: {self.client.rejection(self.waiting_goal).message}")

    # --- A case ---

    def execute(self, seed: int) -> Report:
        """Executes a case, and again while the host excuses it."""
        for attempt in range(1, ATTEMPTS + 1):
            report = self._execute_once(seed)
            report.attempts = attempt
            if report.violations or not report.excused:
                return report
        report.violations.append(f"excused {ATTEMPTS} times, by stalls of the host: {report.excused}")
        return report

    def _execute_once(self, seed: int) -> Report:
        profile = profile_of(seed)
        first_line, self.fields, self.held_threads, self.trace, self.stalls = 0, {}, [], None, None
        case = draw(seed, goal_kinds.of_packages(self.packages), self._holder is not None)
        report = Report(seed, case.text(), case.kind.name, case.event.name, case.hold is not None)
        begin = time.monotonic()
        try:
            if profile != self.profile:
                self.restart_driver(profile)
            begin = time.monotonic()
            first_line = len(self.driver.lines)
            self._execute(case, report)
        except Exception as error:  # what a case meets is a result, and the next cases run
            report.violations.append(f"{type(error).__name__}: {error}")
            self._write_log(case, report, first_line, traceback.format_exc())
            self.start_over()
        else:
            lapses = self.new_lapses()
            report.violations += [f"lapses of the control program: {lapses}"] if lapses and not case.event.breaks_off else []
            if report.violations or report.excused:
                self._write_log(case, report, first_line)
        finally:
            if self.stalls is not None:
                self.stalls.close()
        report.seconds = time.monotonic() - begin
        return report

    def _execute(self, case: Case, report: Report) -> None:
        self.case, self._others, self.preempting_goal, self.waiting_goal, self.holds = case, [], None, None, None
        self.second_request: Optional[int] = None  # of an event that has two, ns since the epoch
        self.page.clear()
        self.stalls = Stalls([self.driver.pid, self.simulator.process.pid, os.getpid()])
        self.when = self.now()
        for action, kind, fields in case.kind.before:
            self._send_before(action, messages.load(kind), fields)
        self.wait_until_commands_have_returned()
        fields = case.kind.fields(case_random(case), self.scene)
        self.fields = fields
        self.trace = Trace(self.simulator)
        with running.source(self, case.kind, fields):
            self.running = running.start(self, case.kind, fields, case.event.needs_client)
            try:
                rejection = self.running.rejection()
                if rejection is not None:
                    self._on_rejection(rejection, report)
                    return
                self._run_until_event(case, report)
                self._move_on(case, report)
            finally:
                self.running.close()

    def _run_until_event(self, case: Case, report: Report) -> None:
        try:
            for command in case.kind.around(self.scene):
                self.simulator.control(**command)
            self._interrupt(case, report)
        finally:
            for name in ("clear_pushes", "clear_surfaces"):
                self.simulator.control(name)

    def _send_before(self, action: str, kind, fields) -> None:
        """A stall of the host between two cases may have ended the control program, which is then started again."""

        def has_succeeded():
            self.play()
            goal = self.client.send_goal(kind, action, messages.fill(kind.Goal(), fields))
            if not goal.accepted:
                return time.sleep(RETRY_INTERVAL)
            goal.succeeded()
            return True

        wait_for(has_succeeded, READY_LIMIT, f"the driver to accept {action}")

    def _on_rejection(self, rejection, report: Report) -> None:
        """The robot was ready before. A stall of the host, between two cases as well, may have interrupted its connection."""
        lost = rejection.error_code in (ErrorCode.LINK_LOST, ErrorCode.NOT_READY, ErrorCode.PROGRAM_STOPPED)
        (report.excused if lost else report.violations).append(f"the goal was rejected: {rejection.message}")

    def _interrupt(self, case: Case, report: Report) -> None:
        if case.waits_for_motion:
            report.moved = self._wait_for_motion(MODE_LIMIT if case.kind.space == goal_kinds.MODE else MOTION_LIMIT)
        at = self.now() + int(1e9 * case.delay)
        if case.waiting is not None:
            self.sleep_until(at - int(1e9 * case.waiting))
            self._send_waiting_goal()
        self._prepare_hold(case, at)
        if case.local:
            self.simulator.control("remote_control", on=False)
        self.sleep_until(at)
        self.program_has_started()  # those before the event
        self.took_effect = 0
        self.when = case.event.cause(self)
        self.took_effect = max(self.took_effect, self.when)

    def _prepare_hold(self, case: Case, at: int) -> None:
        self.held_threads = []
        if case.hold is not None and self._holder is not None:
            self.held_threads = case.hold.choose(threads_of(self.driver.pid), case.kind)
            assert self.held_threads, "there is no thread that moves the arm"
            self.holds = self._holder.request([thread for thread, _name in self.held_threads], at + int(1e9 * case.hold.begin),
                                              case.hold.seconds)

    def _wait_for_motion(self, limit: float) -> bool:
        """Returns whether the arm moves."""
        end = time.monotonic() + limit
        while time.monotonic() < end:
            state = self.simulator.state()
            if max(map(abs, [*state["target"]["velocity"], *state["actual"]["velocity"]])) > 0.02:
                return True
            time.sleep(0.005)
        return False

    def _move_on(self, case: Case, report: Report) -> None:
        """From the event to the next goal: results, recovery, a quiet time, the next goal."""
        checks = properties.Checks(self, case, report)
        self._wait_for_results(case, report, checks)
        if self.preempting_goal is None:
            self._quiet(case, checks)
        assert self.trace is not None
        self.trace.update()
        checks.program_has_ended = self.program_has_started() and self._keeps_program(case)
        checks.evaluate(self.trace)
        if case.event.ends_driver:
            assert case.event.recover is not None
            case.event.recover(self)
        if self.preempting_goal is not None:
            self.preempting_goal.succeeded()
            self.client.forget(self.preempting_goal)
        keeps = self._keeps_program(case) and case.hold is None and not self.page.fell_back()
        leaks, delays = self.move_home(accepts_at_once=keeps and not checks.program_has_ended)
        report.violations += leaks
        for delay in delays:
            checks.limit_exceeded(delay, properties.LONG_STALL, self.stalls.between(self.when, self.now()))
        report.ready = 1e-9 * (self.accepted_at - self.when)

    def _wait_for_results(self, case: Case, report: Report, checks: "properties.Checks") -> None:
        if case.event.has_result:
            checks.result_at = self.running.wait_for_result()
            if self.waiting_goal is not None:
                checks.result_at = max(checks.result_at, self._end_of_waiting_goal(report))
            report.outcome = self.running.outcome()
            problem = self.running.check_single_result()
            report.violations += [problem] if problem else []
        for other in self._others:
            if not case.event.ends_driver:
                checks.problems_of_requests += self._end_of_request(other, case)
        checks.problems_of_requests += self.page.wait(case.hold is not None, case.local)
        if self.holds is not None:
            checks.hold = self.holds.wait()
            if not checks.hold["held"] and not case.event.ends_driver:
                still_run = {thread for thread, _name in threads_of(self.driver.pid)} & {thread for thread, _name in self.held_threads}
                (report.violations if still_run else report.excused).append("no thread was held")

    def _end_of_request(self, request: Goal, case: Case) -> List[str]:
        """Returns what is wrong with the result of a goal that belongs to the event."""
        if not request.accepted:
            return [] if case.hold is not None else [f"the request was rejected: {self.client.rejection(request).message}"]
        _status, result = request.wait_for_result()
        self.client.forget(request)
        return [] if result.success or case.hold is not None or case.local else [f"the request has failed: {result.message}"]

    def _end_of_waiting_goal(self, report: Report) -> int:
        goal = self.waiting_goal
        status, result = goal.wait_for_result(running.RESULT_TIMEOUT)
        states = self.client.get_terminal_states(goal)
        self.client.forget(goal)
        if result.success and goal.result_at < self.when:
            return goal.result_at  # the host was so late that it had ended before the event
        if result.success or states != {status}:
            report.violations.append(f"the goal that waited has the result {result.message}, the final states {states}")
        return goal.result_at

    def _quiet(self, case: Case, checks: "properties.Checks") -> None:
        if checks.hold is not None:
            self.sleep_until(checks.hold["end"] + LATE_BEGIN)
        wait_for(lambda: self.simulator.state()["at_rest"], 20.0, "standstill")
        if case.event.ends_driver:
            status = self.driver.wait(60.0)
            assert status == (0 if case.event.has_result else -signal.SIGKILL), f"the driver has exited with the status {status}"
        self.sleep_until(self.now() + QUIET)
        before = self.simulator.state()["actual"]["position"]
        self.running.pause()
        self.running.close()
        if case.event.recover is not None and not case.event.ends_driver:
            case.event.recover(self)
        if case.local:
            self.sleep_until(self.now() + QUIET)
            self.simulator.control("remote_control", on=True)
        if not self._keeps_program(case) and not case.event.ends_driver:
            self.wait_until_program_runs()
        self.sleep_until(self.now() + QUIET)
        after = self.simulator.state()["actual"]["position"]
        checks.drift = max(abs(a - b) for a, b in zip(before, after))

    def _keeps_program(self, case: Case) -> bool:
        return case.event.keeps_program and case.waiting is None and not case.local and case.profile != "urcap"

    def _write_log(self, case: Case, report: Report, first_line: int, text: str = "") -> None:
        self._log.mkdir(parents=True, exist_ok=True)
        lines = [f"{key}: {value}" for key, value in asdict(report).items()]
        lines += [f"fields: {self.fields}", f"stop: {case.stop}", f"held threads: {self.held_threads}", text, "driver:",
                  *self.driver.lines[first_line:]]
        lines += properties.describe(self)
        (self._log / f"case_{case.seed}.txt").write_text("\n".join(lines) + "\n")


def case_random(case: Case) -> Random:
    return Random(f"fields/{case.seed}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--address", required=True)
    parser.add_argument("--log", type=pathlib.Path, required=True)
    options = parser.parse_args()
    options.log.mkdir(parents=True, exist_ok=True)
    reason = why_impossible()
    lane = Lane(options.address, options.log, not reason)
    print(json.dumps({"holds": reason or "possible", "packages": lane.packages}), flush=True)
    try:
        for line in sys.stdin:
            print(json.dumps(asdict(lane.execute(int(line)))), flush=True)
    finally:
        lane.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
