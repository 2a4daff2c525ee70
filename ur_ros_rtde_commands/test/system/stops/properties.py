"""What has to hold in each case.

Always: the arm comes to rest, within the time of the deceleration after the limit of the event, or after the end of a hold; it does
not move again; the goal has one result, within 1 s of the standstill (4 s if the robot has stopped before it began a script); the lease is
free, and the next goal works.

Without a hold and a goal that waits: the deceleration begins within the limit of the event, and is the one that was asked for. These two
limits are excused if the host did not let the programs run for as long as they are exceeded; excuses are counted and reported. A stream of
setpoints that is late slows down: its decelerations are excused beside STALL_OF_A_STOP.
"""

import math
from typing import List, Optional

from support import TIMEOUT_FACTOR

from . import motion
from .cases import SILENCE_LIMIT
from .goal_kinds import DEFAULT_DECELERATION, JOINT, LINEAR, MODE, PATH
from .motion import CYCLE

RESULT_LIMIT = 1.0 * TIMEOUT_FACTOR  # s of the host, after the standstill
HELD_REST_LIMIT = 1.2  # s of the robot, after the end of a hold: the driver may have lost the connection, or the watchdog has to act
LOCAL_LIMIT = 4.0  # s, more in local control, where the driver tries to stop the program before it uses the watchdog
LOCAL_RESULT_LIMIT = 5.5  # s, more in local control: a script's result waits for the control program, which cannot be started there
SCRIPT_BEGIN_LIMIT = 3.0  # s, more for a script that has been sent: it may begin until then, even if the robot has stopped
MODE_REST_LIMIT = 0.8  # s, more for what the driver does not decelerate along a path: the end of a mode, a braking arm
TOLERANCE = 0.12  # of a deceleration
LONG_STALL = 0.01  # s
WINDOW_CYCLES = 30  # after the event, in which the deceleration has to begin
STALL_OF_A_STOP = 0.008  # s; the driver stops the program if a step of its stop is late
# rad/s^2, m/s^2: of the driver for a stream that it finds to be late, of the controller if a program ends, and of the watchdog. The
# controller ends a speed motion with the acceleration of its goal.
OF_OTHER_MEANS = (2.0, 4.0, 10.0)
MAX_DRIFT = 0.002  # rad, of a joint, at rest
SLOW = 0.02  # rad/s and m/s: too slow for a measurement


class Checks:
    def __init__(self, lane, case, report):
        self._lane, self._case, self._report = lane, case, report
        self.hold = None
        self.result_at: Optional[int] = None
        self.drift = 0.0
        self.stall_until_result = 0.0

    def evaluate(self, trace: motion.Trace) -> None:
        """Evaluates the complete trace of a case."""
        end = trace.length()
        event = trace.index(self._lane.when)
        self._stall = self._report.stall + trace.delay(event, min(end - 1, event + WINDOW_CYCLES))
        if self._lane.preempting_goal is None:
            stopping = motion.find_stopping(trace, event, self._may_begin_until(trace, event), end, self._column())
        else:  # its motion follows at once
            stopping = motion.find_stopping(trace, event, event, end, self._column(), rest_cycles=1)
        self._stall_until_rest = self.stall_until_result + trace.delay(event, min(end - 1, stopping.rest or end))
        self._report.stall = round(self._stall_until_rest, 4)
        self._report.latency, self._report.standstill = stopping.latency, stopping.duration
        self._rest(trace, stopping)
        self._result(trace, stopping)
        if self._case.hold is None and self._case.waiting is None:
            self._begin(trace, stopping)
            self._deceleration(trace, stopping)

    # --- Always ---

    def _may_begin_until(self, trace: motion.Trace, event: int) -> int:
        limit = self._case.event.begin_limit if self._case.event.begin_limit is not None else self._case.event.rest_limit
        latest = event + int((limit + self._stall) / CYCLE) + 1
        return latest if self.hold is None else max(latest, trace.index(self.hold["end"]) + int(HELD_REST_LIMIT / CYCLE))

    def _rest(self, trace: motion.Trace, stopping: motion.Stopping) -> None:
        if stopping.rest is None:
            self._violation("the arm does not come to rest")
            return
        if stopping.moved_again is not None and self._lane.preempting_goal is None:
            speed = trace.speeds[stopping.moved_again]
            self._violation(f"the arm moves again {CYCLE * (stopping.moved_again - stopping.event):.3f} s after the event, {speed}")
        if self.drift > MAX_DRIFT:
            self._violation(f"the arm drifts by {self.drift:.4f} rad after the stop")
        limit = self._case.event.rest_limit + self._decelerating_time(trace, stopping.event) + self._stall_until_rest
        limit += LOCAL_LIMIT if self._only_the_watchdog_ends_it() else 0.0
        if self.hold is not None:
            limit = max(limit, CYCLE * (trace.index(self.hold["end"]) - stopping.event) + HELD_REST_LIMIT
                        + self._decelerating_time(trace, stopping.event))
        if stopping.duration > limit:
            self._violation(f"at rest {stopping.duration:.3f} s after the event, later than {limit:.3f} s")

    def _result(self, trace: motion.Trace, stopping: motion.Stopping) -> None:
        if self.result_at is None or stopping.rest is None:
            return
        begin = max(self._lane.when, trace.published[min(stopping.rest, trace.length() - 1)], self.hold["end"] if self.hold else 0)
        self._report.result = round(1e-9 * (self.result_at - begin), 4)
        limit = RESULT_LIMIT + self._time_to_notice() + (LOCAL_RESULT_LIMIT if self._case.local else 0.0)
        limit += SCRIPT_BEGIN_LIMIT * TIMEOUT_FACTOR if self._may_not_have_begun(stopping) else 0.0
        if self._report.result > limit:
            self._limit_exceeded(f"the result comes {self._report.result:.3f} s after the standstill", self._report.result - limit,
                                 self._stall_until_rest)

    def _may_not_have_begun(self, stopping: motion.Stopping) -> bool:
        """A script that was sent just before the robot stopped."""
        return self._case.kind.runs_script and self._case.event.stops_robot and not self._case.waits_for_motion and stopping.first is None

    def _time_to_notice(self) -> float:
        """s, in which the event may not have been noticed, of an arm that is at rest before."""
        event = self._case.event
        return SILENCE_LIMIT[self._case.profile] if event.is_silent else event.rest_limit if event.needs_client else 0.0

    # --- Without a hold ---

    def _begin(self, trace: motion.Trace, stopping: motion.Stopping) -> None:
        limit = self._case.event.begin_limit
        if limit is None or stopping.latency is None or self._brakes_along_path() or self._case.kind.space == MODE:
            return
        accelerates = self._case.kind.has_corner or self._change_of_speed(trace, stopping.event) > 0.0
        if self._only_the_watchdog_ends_it() or self._case.event.slows_time and accelerates:
            return
        latency = stopping.latency
        if self._case.kind.space == PATH and self._lane.second_request is not None:  # it may brake along its path until then
            latency -= CYCLE * (trace.index(self._lane.second_request) - stopping.event)
        if latency > limit + 0.5 * CYCLE:
            stall = self._stall if stopping.latency < WINDOW_CYCLES * CYCLE else self._stall_until_rest
            self._limit_exceeded(f"the deceleration begins {1e3 * latency:.0f} ms after the event", latency - limit, stall)

    def _deceleration(self, trace: motion.Trace, stopping: motion.Stopping) -> None:
        if self._case.event.needs_client:
            return  # when the driver notices it, the goal may have begun to decelerate by itself
        asked = self._asked()
        if asked is None or stopping.first is None or stopping.rest is None or self._was_decelerating(trace, stopping.event):
            return
        measured = motion.deceleration(trace, stopping, self._column())
        if measured is None or trace.speeds[stopping.first][self._column()] < SLOW:
            return
        self._report.deceleration = round(measured / asked, 3)
        fits = measured < asked * (1.0 + TOLERANCE) if self._brakes_along_path() else abs(measured - asked) <= TOLERANCE * asked
        if not fits:
            unit = "rad/s^2" if self._column() == 0 else "m/s^2"
            may_be_excused = self._case.kind.is_streamed or any(
                abs(measured - other) <= TOLERANCE * other for other in (*OF_OTHER_MEANS, self._lane.fields.get("acceleration", 0.0)))
            self._limit_exceeded(f"the deceleration is {measured:.2f} {unit} instead of {asked:.2f}",
                                 STALL_OF_A_STOP if may_be_excused else math.inf, self._stall_until_rest)

    # --- What was asked for ---

    def _only_the_watchdog_ends_it(self) -> bool:
        return self._case.local and self._case.kind.runs_script

    def _brakes_along_path(self) -> bool:
        return self._case.kind.space == PATH and self._case.event.asks == "goal"

    def _space(self) -> str:
        if self._case.kind.space == PATH:
            return PATH if self._brakes_along_path() else JOINT
        return self._case.kind.space

    def _column(self) -> int:
        return 1 if self._space() == LINEAR and not self._case.kind.turns else 0

    def _asked(self) -> Optional[float]:
        """The deceleration that was asked for; None if the event or the goal does not ask for one."""
        kind, asks = self._case.kind, self._case.event.asks
        if kind.space == MODE or not asks:
            return None
        if self._brakes_along_path():
            return kind.limits(self._lane.fields)[0]
        if asks == "stop":
            if kind.deceleration(self._lane.fields) is None:
                return None
            return self._case.stop["joint_deceleration" if self._space() == JOINT else "linear_deceleration"]
        return kind.deceleration(self._lane.fields)

    def _decelerating_time(self, trace: motion.Trace, event: int) -> float:
        """s, an upper bound."""
        joint, tcp = (max(speeds) for speeds in zip(*trace.speeds[max(0, event - 1):event + 12]))
        may_brake_along_path = self._case.event.name == "cancel, then stop" or self._case.waiting is not None
        if self._brakes_along_path() or may_brake_along_path and self._case.kind.space == PATH:
            acceleration, jerk = self._case.kind.limits(self._lane.fields)
            peak = joint + 0.5 * acceleration**2 / jerk
            return 1.3 * (peak / acceleration + 3.0 * acceleration / jerk) + 0.1
        if self._case.kind.space == MODE:
            return MODE_REST_LIMIT
        asked = self._asked()
        slowest = min(asked or DEFAULT_DECELERATION, DEFAULT_DECELERATION, *self._case.stop.values())
        return 1.1 * max(joint, tcp) / slowest

    def _was_decelerating(self, trace: motion.Trace, event: int) -> bool:
        """The goal has come to its end by itself."""
        return event == 0 or self._change_of_speed(trace, event) < -motion.DECREASE

    def _change_of_speed(self, trace: motion.Trace, event: int) -> float:
        """In the two cycles before the event."""
        return trace.speeds[event][self._column()] - trace.speeds[max(0, event - 2)][self._column()]

    # --- Reports ---

    def _violation(self, text: str) -> None:
        self._report.violations.append(text)

    def _limit_exceeded(self, text: str, by: float, stall: float) -> None:
        """A stall of the host that is as long as a limit is exceeded by excuses that."""
        if self._case.hold is None and stall < by:
            self._violation(f"{text}, although the host was late by at most {1e3 * stall:.1f} ms")
        elif self._case.hold is not None:
            self._violation(text)
        else:
            self._report.excused.append(text)


def describe(lane) -> List[str]:
    """For the log of a failed case: the speeds around the event."""
    trace = getattr(lane, "trace", None)
    when = getattr(lane, "when", None)
    if trace is None or when is None:
        return []
    event = trace.index(when)
    lines = [f"cycles around the event, which was sent after cycle {event} (joint rad/s, TCP m/s, ns since the event):"]
    for index in range(max(0, event - 20), min(trace.length(), event + 1500)):
        lines.append(f"{index - event:6} {trace.speeds[index][0]:9.5f} {trace.speeds[index][1]:9.5f} {trace.published[index] - when:12}")
    return lines
