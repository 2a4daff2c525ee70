"""Sends random goals to a simulated robot during random faults. Started by `./ur chaos`."""

import argparse
import itertools
import pathlib
import random
import sys
import time
from collections import defaultdict

ROOT = pathlib.Path(__file__).resolve().parents[1]
for folder in ("ur_ros_rtde_commands/test/system", "ur_ros_rtde_commands/test/every_command", "demo", "tools"):
    sys.path.insert(0, str(ROOT / folder))

import faults  # noqa: E402
import report  # noqa: E402
from cell import StatusTrackingClient  # noqa: E402
from clients import RESULT_LIMIT, Gate, GoalSender  # noqa: E402
from journal import Journal, Violation  # noqa: E402
from monitor import AT_REST, ArmMonitor, ResourceMonitor  # noqa: E402
from robot import Robot  # noqa: E402
from support import HOME, wait_for  # noqa: E402
from ur_tools import console  # noqa: E402

from ur_ros_rtde_msgs.action import MoveJ  # noqa: E402
from ur_ros_rtde_msgs.msg import ErrorCode  # noqa: E402

READY_LIMIT = 10.0  # s, from the end of a fault to the first accepted motion
REST_LIMIT = 1.0  # s
REST_PERIOD = 0.5  # s, after the standstill
SOAK_PERIOD = 10.0  # s, between two measurements of the driver's load without faults


class Chaos:
    def __init__(self, options, journal, robot):
        self._options, self._journal, self._robot = options, journal, robot
        self._gate = Gate()
        self._monitor = ArmMonitor(robot, self._gate, journal)
        self._resources = ResourceMonitor(robot.driver.pid, journal, options.sanitizer)
        self._probe = StatusTrackingClient(name="probe")
        self._clients = [GoalSender(f"client {number}", random.Random(f"{options.seed}/{number}"), self._gate, journal)
                         for number in range(options.clients)]
        self._status = console.Status(10.0)
        self._recoveries = defaultdict(list)
        self._begin = time.monotonic()

    def run(self):
        self._wait_until_ready(30.0)
        self._monitor.start()
        for client in self._clients:
            client.start()
        try:
            self._soak() if self._options.faults == 0 else self._faults()
            self._check_final_state()
        finally:
            for client in self._clients:
                client.stop()
            for client in self._clients:
                client.join()
            self._monitor.stop()
            self._probe.close()
            self._status.clear()

    # --- Kinds of runs ---

    def _faults(self):
        sequence = faults.sequence(random.Random(f"{self._options.seed}/faults"))
        for number, fault in enumerate(itertools.islice(sequence, self._options.faults), 1):
            if self._over():
                return
            self._show(f"fault {number} of {self._options.faults}, {fault.kind.name}")
            self._fault(fault)

    def _soak(self):
        while not self._over():
            self._show("no faults")
            self._wait(min(SOAK_PERIOD, 0.02 * 60.0 * self._options.minutes))
            self._gate.set(False)
            self._robot.clear()  # a random motion may have caused a protective stop
            self._check_standstill()
            self._gate.set(True)

    def _over(self):
        return self._options.minutes and time.monotonic() - self._begin > 60.0 * self._options.minutes

    # --- One fault ---

    def _fault(self, fault):
        self._wait(fault.delay)
        if fault.quiet:
            self._gate.set(False)
        self._journal.write("fault", fault.text())
        if fault.kind.name == "push":
            self._monitor.paused.set()
        fault.kind.cause(self._robot, random.Random(fault.seed))
        self._wait(fault.duration)
        self._robot.clear()
        self._journal.write("fault", "cleared")
        self._gate.restart_idle_time()
        if fault.quiet:
            self._check_standstill()
            self._check_next_goal()
        else:
            self._recoveries[fault.kind.name].append(self._recovery())
        self._monitor.paused.clear()
        self._gate.set(True)

    def _recovery(self):
        """Returns the time until a motion is accepted; None if one continued."""
        cleared = time.monotonic()
        with self._gate.bypass():
            ready = self._wait_until_ready()
        return ready - cleared if ready else None

    def _check_standstill(self):
        """Checks that the arm comes to rest after the last goal and remains there, and samples the load of the driver."""
        if not self._gate.wait_until_idle(RESULT_LIMIT):
            raise Violation(f"a goal has no result {RESULT_LIMIT:g} s after the last fault")
        self._journal.check()
        wait_for(lambda: self._robot.joint_speed() < AT_REST, REST_LIMIT, "standstill after the last goal")
        cycle = self._robot.simulator.state()["cycle"]
        self._wait(REST_PERIOD)
        speed = self._robot.highest_target_speed(cycle)
        if speed > AT_REST:
            raise Violation(f"the arm moves again after the last goal, at {speed:.3f} rad/s")
        self._resources.sample()

    def _check_next_goal(self):
        """No goal is left that could be BUSY."""
        with self._gate.bypass():
            self._wait_until_ready(may_be_busy=False)
            self._probe.send(MoveJ, "move_j", joint_positions=HOME, speed=3.0, acceleration=15.0).succeeded()

    def _wait_until_ready(self, limit=READY_LIMIT, may_be_busy=True):
        """Waits until a motion is accepted, or rejected because another one runs, if one may run.

        Returns the time of the answer; None if the first attempt was rejected because of another motion.
        """
        reasons = []

        def answered():
            self._journal.check()
            goal = self._probe.send(MoveJ, "move_j", joint_positions=HOME, speed=3.0, acceleration=15.0)
            if goal.accepted:
                return goal, time.monotonic()
            rejection = self._probe.rejection(goal)
            reasons.append(rejection.message)
            is_busy = rejection.error_code == ErrorCode.BUSY
            if is_busy and not may_be_busy:
                raise Violation(f"BUSY, although every goal has its result: {rejection.message}")
            self._robot.power_up()  # an earlier stand_down may have powered the arm off
            return (None, time.monotonic()) if is_busy else None

        try:
            goal, when = wait_for(answered, limit, "a motion to be accepted again")
        except AssertionError as error:
            raise Violation(f"{error}; last messages: {reasons[-1:]}") from None
        if goal is not None:
            goal.wait_for_result(RESULT_LIMIT)
        return when if goal is not None or len(reasons) > 1 else None

    def _check_final_state(self):
        self._gate.set(False)
        self._robot.clear()
        self._check_standstill()
        self._check_next_goal()
        grown = self._resources.find_growth()
        if grown:
            raise Violation("the driver's " + "; ".join(grown))

    # --- Output ---

    def _wait(self, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self._journal.check()
            time.sleep(min(0.05, max(0.0, end - time.monotonic())))
        self._journal.check()

    def _show(self, what):
        number = sum(sum(client.outcomes.values()) for client in self._clients)
        self._status.show(f"{time.monotonic() - self._begin:.0f} s: {what}; {number} goals have ended")

    def tables(self):
        return [*report.faults(self._recoveries), *report.goals(client.outcomes for client in self._clients),
                f"    driver: {self._resources.text()}", f"    {time.monotonic() - self._begin:.0f} s"]


def _run(options, journal):
    """Returns the first violation; None if there is none."""
    robot = Robot(options.address)
    chaos = None
    try:
        journal.write("chaos", f"seed {options.seed}; the driver is process {robot.driver.pid}")
        chaos = Chaos(options, journal, robot)
        chaos.run()
        return journal.violation
    except (Violation, AssertionError, OSError) as error:
        journal.write("chaos", f"{type(error).__name__}: {error}")
        return journal.violation or str(error) or type(error).__name__
    finally:
        if chaos:
            print("\n".join(chaos.tables()), flush=True)
        robot.close()
        (options.log / "driver.log").write_text(robot.driver.output())
        (options.log / "simulator.log").write_text(robot.simulator.process.output())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--address", required=True)
    parser.add_argument("--faults", type=int, required=True)
    parser.add_argument("--minutes", type=float, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--clients", type=int, required=True)
    parser.add_argument("--log", type=pathlib.Path, required=True)
    parser.add_argument("--sanitizer", action="store_true", help="the driver was built with a sanitizer")
    options = parser.parse_args()
    options.log.mkdir(parents=True, exist_ok=True)
    journal = Journal(options.log / "journal.log")
    violated = _run(options, journal)
    journal.close()
    if violated:
        print(f"\nVIOLATED: {violated}\nseed {options.seed}; logs: {options.log}/journal.log, driver.log, simulator.log",
              flush=True)
        return 1
    print("    every goal had one result, the arm came to rest after the last one")
    return 0


if __name__ == "__main__":
    sys.exit(main())
