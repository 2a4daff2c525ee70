"""A simulated robot with its driver, clients and a holder of threads, which execute cases one after the other.

    python3 -m stops.lane --address 127.0.3.1 --log FOLDER     seeds on stdin, one report in JSON per line on stdout
"""

import argparse
import json
import os
import pathlib
import socket
import sys
import time
import traceback
from dataclasses import asdict, dataclass, field
from random import Random
from typing import Any, Dict, List, Optional

import messages
from cell import StatusTrackingClient
from own_domain import Domain
from plugin_prefix import TEST_COMMANDS, environment_of_test_commands
from programs import Process, Simulator, start_node
from rclpy.qos import QoSProfile
from ros_client import Goal
from support import HOME, wait_for

from ur_ros_rtde_msgs.action import MoveJ
from ur_ros_rtde_msgs.msg import ErrorCode

from . import goal_kinds, properties, running
from .cases import PROFILES, Case, draw, profile_of
from .holds import Hold, Holder, threads_of, why_impossible
from .motion import CYCLE, Trace
from .page import Page
from .stalls import Stalls

STALL_WINDOW = round(1e9 * properties.WINDOW_CYCLES * CYCLE)  # ns after the event, in which the deceleration has to begin
QUIET = 150_000_000  # ns, after which nothing may have moved again
LATE_BEGIN = 100_000_000  # ns after the end of a hold, in which what the threads were told before it begins
MOTION_LIMIT = 0.8  # s, for a goal that may not move at all
READY_LIMIT = 10.0  # s, from the end of a disturbance to the first accepted motion
RETRY_INTERVAL = 0.05  # s
DISCOVERY_LIMIT = 20.0  # s


@dataclass
class Report:
    """What is known about an executed case."""

    seed: int
    case: str
    kind: str
    event: str
    held: bool
    violations: List[str] = field(default_factory=list)
    excused: List[str] = field(default_factory=list)  # exceeded limits that a stall of the host explains
    latency: Optional[float] = None  # s of the robot, to the first decelerating cycle
    standstill: Optional[float] = None  # s of the robot, from the event
    result: Optional[float] = None  # s, from the standstill, the end of the hold or the event, whichever is last
    ready: Optional[float] = None  # s, until the next goal was accepted
    deceleration: Optional[float] = None
    stall: float = 0.0  # s
    seconds: float = 0.0  # of the host, for the whole case


class Lane:
    def __init__(self, address: str, log: pathlib.Path, holds: bool = True):
        self._log = log
        self._domain = Domain()
        self._env = {"ROS_DOMAIN_ID": str(self._domain.number), **self._plugins()}
        self._address, self._profile = address, ""
        self.driver: Optional[Process] = None
        self.simulator = Simulator(address, recovery_time_factor=0.02)
        self.scene = goal_kinds.Scene(self.simulator.state()["actual_tcp_pose"])
        self.client = StatusTrackingClient(self._domain.number, "stops")
        self.page = Page(self.client)
        self._holder = Holder() if holds else None
        self._spare: Optional[Process] = None
        self._publishers: dict = {}
        self.case: Case
        self.running: Any = None  # see running.start()
        self.trace: Optional[Trace] = None
        self.fields: dict = {}  # of the goal
        self.held_threads: list = []
        self.holds: Optional[Hold] = None
        self._others: list = []  # goals of the event itself
        self.preempting_goal: Optional[Goal] = None  # the goal that has preempted the one of the case
        self.waiting_goal: Optional[Goal] = None  # the goal that waited for the arm when the event came

    def _plugins(self) -> Dict[str, str]:
        """Returns the environment in which the driver finds the plugins that are built with the tests."""
        environment = environment_of_test_commands(self._log / f"prefix_{TEST_COMMANDS}_{os.getpid()}")
        self.packages = ["ur_ros_rtde_tutorials", *([TEST_COMMANDS] if environment else [])]
        return environment

    def close(self) -> None:
        if self._spare is not None:
            self._spare.kill()
        if self._holder is not None:
            self._holder.close()
        if self.driver is not None:
            self.driver.stop()
        self.client.close()
        self.simulator.stop()
        self._domain.close()

    # --- For events ---

    def now(self) -> int:
        return time.time_ns()

    def sleep_until(self, when: float) -> None:
        time.sleep(max(0.0, 1e-9 * (when - time.time_ns())))

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

    def take_client(self):
        client = self._spare or running.start_client(self._env)
        self._spare = None
        client.wait_for_output("ready", 30.0)
        return client

    def publisher(self, kind, topic: str):
        if topic not in self._publishers:
            create = self.client.node.create_publisher
            self._publishers[topic] = self.client.call_in_executor(lambda: create(kind, topic, QoSProfile(depth=1)))
        publisher = self._publishers[topic]
        wait_for(lambda: publisher.get_subscription_count() > 0, 20.0, f"a subscription of {topic}")
        return publisher

    # --- The driver ---

    def restart_driver(self, profile: str = "") -> None:
        """With the URCap, what follows its node in the program of the operator moves the arm: it must not be reached."""
        if self.driver is not None:
            self.driver.stop()
            # Until then, the client sends its requests to the driver that has ended.
            wait_for(lambda: not self.client.sees("move_j"), DISCOVERY_LIMIT, "the driver to disappear")
        self._profile = profile or self._profile
        parameters = PROFILES[self._profile]
        if self._profile == "urcap":
            port = unused_port()
            parameters = (*parameters, f"urcap_port:={port}")
            next_motion = f"movej({goal_kinds.home_plus(0.3)}, a=5, v=1)"
            self.simulator.control("store_external_control", host="127.0.0.1", port=port, next=next_motion)
        self.driver = start_node("driver", self._address, "ur_type:=ur10e", *parameters, env=self._env)
        if self._profile == "urcap":
            self.driver.wait_for_output("start the program with the External Control node", 30.0)
        self._move_home(30.0)

    def _move_home(self, limit: float, accepts_at_once: bool = False) -> List[str]:
        """Moves home, as soon as the driver accepts it. Returns the violations."""
        violations: List[str] = []

        def has_moved():
            assert self.driver.running(), "the driver has exited"
            self._play()
            goal = self.client.send(MoveJ, "move_j", joint_positions=HOME, speed=3.0, acceleration=15.0)
            if not goal.accepted:
                rejection = self.client.rejection(goal)
                if rejection.error_code == ErrorCode.BUSY:
                    violations.append(f"the lease is not free: {rejection.message}")
                elif accepts_at_once:
                    violations.append(f"the next goal was rejected: {rejection.message}")
                return time.sleep(RETRY_INTERVAL)
            self._accepted = self.now()
            _status, result = goal.wait_for_result()
            self.client.forget(goal)
            if not result.success:
                (violations if accepts_at_once else []).append(f"the next goal failed: {result.message}")
                return time.sleep(RETRY_INTERVAL)
            return True

        wait_for(has_moved, limit, "the driver to move the arm home")
        return violations[:3]

    def _play(self) -> None:
        """With the URCap, the operator starts the program when it is stopped."""
        if self._profile == "urcap" and self.simulator.state()["program"]["state"] == "STOPPED":
            self.simulator.may("play")

    # --- A case ---

    def execute(self, seed: int) -> Report:
        profile = profile_of(seed)
        first_line, self.fields, self.held_threads, self.trace = 0, {}, [], None
        case = draw(seed, goal_kinds.of_packages(self.packages), self._holder is not None)
        report = Report(seed, case.text(), case.kind.name, case.event.name, case.hold is not None)
        begin = time.monotonic()
        try:
            if profile != self._profile:
                self.restart_driver(profile)
            begin = time.monotonic()
            first_line = len(self.driver.lines)
            self._execute(case, report)
        except Exception as error:  # what a case meets is a result, and the next cases run
            report.violations.append(f"{type(error).__name__}: {error}")
            self._write_log(case, report, first_line, traceback.format_exc())
            self._start_over()
        else:
            if report.violations or report.excused:
                self._write_log(case, report, first_line)
        report.seconds = time.monotonic() - begin
        return report

    def _execute(self, case: Case, report: Report) -> None:
        self.case, self._others, self.preempting_goal, self.waiting_goal, self.holds = case, [], None, None, None
        self.second_request: Optional[int] = None  # of an event that has two, ns since the epoch
        self.page.clear()
        self._stalls = self._measure_stalls()
        for action, kind, fields in case.kind.before:
            self._send_before(action, messages.load(kind), fields)
        self._wait_until_commands_have_returned()
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
            self._play()
            goal = self.client.send_goal(kind, action, messages.fill(kind.Goal(), fields))
            if not goal.accepted:
                return time.sleep(RETRY_INTERVAL)
            goal.succeeded()
            return True

        wait_for(has_succeeded, READY_LIMIT, f"the driver to accept {action}")

    def _on_rejection(self, rejection, report: Report) -> None:
        """The robot was ready before. A stall of the host may have interrupted its connection."""
        report.stall = self._stalls.seconds()
        lost = rejection.error_code in (ErrorCode.LINK_LOST, ErrorCode.NOT_READY, ErrorCode.PROGRAM_STOPPED)
        found = report.excused if lost and report.stall > properties.LONG_STALL else report.violations
        found.append(f"the goal was rejected: {rejection.message}")

    def _interrupt(self, case: Case, report: Report) -> None:
        if case.waits_for_motion:
            self._wait_for_motion()
        at = self.now() + int(1e9 * case.delay)
        self._prepare_hold(case, at)
        if case.waiting is not None:
            self.sleep_until(at - int(1e9 * case.waiting))
            self._send_waiting_goal()
        if case.local:
            self.simulator.control("remote_control", on=False)
        self.sleep_until(at)
        self._stalls = self._measure_stalls()
        self.when = case.event.cause(self)
        self.sleep_until(self.when + STALL_WINDOW)
        report.stall = self._stalls.seconds()

    def _measure_stalls(self) -> Stalls:
        return Stalls([self.driver.pid, self.simulator.process.pid, os.getpid()])

    def _prepare_hold(self, case: Case, at: int) -> None:
        self.held_threads = []
        if case.hold is not None and self._holder is not None:
            self.held_threads = case.hold.choose(threads_of(self.driver.pid), case.kind)
            assert self.held_threads, "there is no thread that moves the arm"
            self.holds = self._holder.request([thread for thread, _name in self.held_threads], at + int(1e9 * case.hold.begin),
                                              case.hold.seconds)

    def _wait_for_motion(self) -> None:
        end = time.monotonic() + MOTION_LIMIT
        while time.monotonic() < end:
            state = self.simulator.state()
            if max(map(abs, [*state["target"]["velocity"], *state["actual"]["velocity"]])) > 0.02:
                return
            time.sleep(0.005)

    def _move_on(self, case: Case, report: Report) -> None:
        """From the event to the next goal: results, recovery, a quiet time, the next goal."""
        checks = properties.Checks(self, case, report)
        self._wait_for_results(case, report, checks)
        if self.preempting_goal is None:
            self._quiet(case, checks)
        assert self.trace is not None
        self.trace.update()
        checks.evaluate(self.trace)
        if case.event.ends_driver:
            assert case.event.recover is not None
            case.event.recover(self)
        if self.preempting_goal is not None:
            self.preempting_goal.succeeded()
            self.client.forget(self.preempting_goal)
        keeps = self._keeps_program(case) and case.hold is None and not self.page.fell_back()
        report.violations += self._move_home(READY_LIMIT, keeps and report.stall < properties.LONG_STALL)
        report.ready = 1e-9 * (self._accepted - self.when)

    def _wait_for_results(self, case: Case, report: Report, checks: "properties.Checks") -> None:
        if case.event.has_result:
            checks.result_at = self.running.wait_for_result()
            if self.waiting_goal is not None:
                checks.result_at = max(checks.result_at, self._end_of_waiting_goal(report))
            checks.stall_until_result = self._stalls.seconds()
            problem = self.running.check_single_result()
            report.violations += [problem] if problem else []
        for other in self._others:
            if other.accepted and not case.event.ends_driver:
                other.wait_for_result()
                self.client.forget(other)
        report.violations += self.page.wait(case.hold is not None or report.stall > properties.LONG_STALL, case.local)
        if self.holds is not None:
            checks.hold = self.holds.wait()

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
            wait_for(lambda: not self.driver.running(), 60.0, "the end of the driver")
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
            self._wait_until_program_runs()
        self.sleep_until(self.now() + QUIET)
        after = self.simulator.state()["actual"]["position"]
        checks.drift = max(abs(a - b) for a, b in zip(before, after))

    def _keeps_program(self, case: Case) -> bool:
        return case.event.keeps_program and case.waiting is None and not case.local and case.profile != "urcap"

    def _wait_until_program_runs(self) -> None:
        """The driver starts its program again: from now on, an old goal could use it. An arm that is pressed on something while the driver
        is held may come to a protective stop."""
        def runs():
            self._play()
            state = self.simulator.state()
            if state["safety_mode"] == "PROTECTIVE_STOP":
                self.simulator.unlock_protective_stop()
            return state["program"]["state"] == "PLAYING" and state["clients"]["rtde_control"] > 0

        wait_for(runs, READY_LIMIT, "the control program")

    def _wait_until_commands_have_returned(self) -> None:
        """The driver rejects a goal of a command whose abandoned goal has not returned: one that never looks, of the case before."""
        def lines(text: str) -> int:
            return sum(text in line for line in list(self.driver.lines))

        wait_for(lambda: lines("its command has returned after its result was sent") >= lines("the command did not return after that"),
                 READY_LIMIT, "the return of an abandoned command")

    def _start_over(self) -> None:
        """After a failure that has left the robot or the driver in an unknown state."""
        self.driver.stop()
        self.simulator.kill()
        self.simulator.start()
        self.restart_driver()

    def _write_log(self, case: Case, report: Report, first_line: int, text: str = "") -> None:
        self._log.mkdir(parents=True, exist_ok=True)
        lines = [f"{key}: {value}" for key, value in asdict(report).items()]
        lines += [f"fields: {self.fields}", f"stop: {case.stop}", f"held threads: {self.held_threads}", text, "driver:",
                  *self.driver.lines[first_line:]]
        lines += properties.describe(self)
        (self._log / f"case_{case.seed}.txt").write_text("\n".join(lines) + "\n")


def unused_port() -> int:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


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
