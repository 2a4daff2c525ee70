"""What has to hold in each case.

Always: the arm comes to rest, within the time of the deceleration after the limit of the event, or after the end of a hold; it does
not move again; the goal has one result, within 1 s of the standstill (4 s if the robot has stopped before it began a script); the lease is
free, and the next goal works.

Without a hold and a goal that waits: the deceleration begins within the limit of the event, and is the one that was asked for; a stop that
does not need to end the control program keeps it.

A limit is excused if the host did not let the programs run for as long as it is exceeded, between the event and what is late. A stop that
had to use other means, and a stream of setpoints that slowed down, are excused beside STALL_OF_A_STOP. A case with an excuse is executed
again, and fails if it has one each time.
"""

import math
from typing import List, Optional

from action_msgs.msg import GoalStatus
from support import REAL_TIME_FACTOR, TIMEOUT_FACTOR

from ur_ros_rtde_msgs.msg import ErrorCode

from . import goal_kinds, motion
from .cases import SILENCE_LIMIT, WATCHDOG
from .events import BEGIN_LIMIT
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
EARLY_RESULT = 0.03  # s, before the standstill: the last cycles of a stop are slower than what the driver measures
MODE_BEGIN_LIMIT = 0.15  # s, until an arm that is in a mode brakes
WINDOW_CYCLES = 30  # after the event, in which the deceleration has to begin
CYCLES_OF_ACCELERATION = 12  # after the event, before the arm decelerates
STALL_OF_A_STOP = 0.008  # s; the driver stops the program if a step of its stop is late
# rad/s^2, m/s^2: of the driver for a stream that it finds to be late, of the controller if a program ends, and of the watchdog. The
# controller ends a speed motion with the acceleration of its goal.
OF_OTHER_MEANS = (2.0, 4.0, 10.0)
OF_LATE_HOST = (ErrorCode.LINK_LOST, ErrorCode.PROGRAM_STOPPED)  # whose heartbeats are missing
MAX_DRIFT = 0.002  # rad, of a joint, at rest
SLOW = 0.02  # rad/s and m/s: too slow for a measurement


class Checks:
    def __init__(self, lane, case, report):
        self._lane, self._case, self._report = lane, case, report
        self.hold = None
        self.result_at: Optional[int] = None
        self.drift = 0.0
        self.problems_of_requests: List[str] = []  # of the event itself
        self.program_has_ended = False  # until the next goal: a stop has ended it, and the driver has started it again

    def evaluate(self, trace: motion.Trace) -> None:
        """Evaluates the complete trace of a case."""
        stopping = self._stopping(trace)
        self._stall = self.stall_until(trace, stopping.first or stopping.event + WINDOW_CYCLES)
        self._stall_until_rest = self.stall_until(trace, stopping.rest or trace.length())
        self._report.stall, self._report.stall_until_rest = round(self._stall, 4), round(self._stall_until_rest, 4)
        self._report.latency, self._report.standstill = stopping.latency, stopping.duration
        if not self._report.moved and self._case.kind.space != MODE:
            self.limit_exceeded("the goal has not moved the arm", LONG_STALL, self._lane.stalls.between(0, self._lane.when))
        self._rest(trace, stopping)
        self._result(trace, stopping)
        for problem in self.problems_of_requests:
            self.limit_exceeded(problem, LONG_STALL, self._stall_until_rest)
        if self._case.hold is None and self._case.waiting is None:
            self._begin(trace, stopping)
            self._deceleration(trace, stopping)
            self._program()
            self._outcome(trace, stopping)

    def _stopping(self, trace: motion.Trace) -> motion.Stopping:
        event, end = trace.index(self._lane.when), trace.length()
        if self._lane.preempting_goal is not None:  # its motion follows at once
            return motion.find_stopping(trace, event, event, end, self._column(), rest_cycles=1)
        return motion.find_stopping(trace, event, self._may_begin_until(trace, event), end, self._column(),
                                    has_pauses=self._case.kind.has_pauses or self._case.waiting is not None or self._may_brake_late())

    def stall_until(self, trace: motion.Trace, index: int) -> float:
        """For how long the host has not let the programs run between the event and this cycle, s of the robot."""
        index = min(index, trace.length() - 1)
        stall = self._lane.stalls.between(self._lane.when, trace.published[index])
        return REAL_TIME_FACTOR * stall + trace.delay(trace.index(self._lane.when), index)

    # --- Always ---

    def _may_begin_until(self, trace: motion.Trace, event: int) -> int:
        limit = self._case.event.begin_limit if self._case.event.begin_limit is not None else self._case.event.rest_limit
        latest = max(event, trace.index(self._lane.took_effect)) + int(limit / CYCLE) + 1
        latest += int(self.stall_until(trace, latest) / CYCLE)
        return latest if self.hold is None else max(latest, trace.index(self.hold["end"]) + int(HELD_REST_LIMIT / CYCLE))

    def _rest(self, trace: motion.Trace, stopping: motion.Stopping) -> None:
        if stopping.rest is None or stopping.duration is None:
            self._violation("the arm does not come to rest")
            return
        if stopping.moved_again is not None and self._lane.preempting_goal is None:
            speed = trace.speeds[stopping.moved_again]
            self._violation(f"the arm moves again {CYCLE * (stopping.moved_again - stopping.event):.3f} s after the event, {speed}")
        if self._may_brake_late() and self._is_faster_after_hold(trace, stopping.event):
            self._violation("after the hold, the arm is faster than before it")
        if self.drift > MAX_DRIFT:
            self._violation(f"the arm drifts by {self.drift:.4f} rad after the stop")
        limit = self._rest_limit() + CYCLE * (trace.index(self._lane.took_effect) - stopping.event)
        if self.hold is not None:
            limit = max(limit, CYCLE * (trace.index(self.hold["end"]) - stopping.event) + HELD_REST_LIMIT)
        limit += self._decelerating_time(trace, stopping.event)
        if stopping.duration > limit:
            self.limit_exceeded(f"at rest {stopping.duration:.3f} s after the event, later than {limit:.3f} s",
                                stopping.duration - limit, self._stall_until_rest)

    def _may_brake_late(self) -> bool:
        """Held setpoints of a braking arm let it rest on its path; the others follow."""
        return self.hold is not None and self._brakes_along_path() and self._lane.preempting_goal is None

    def _is_faster_after_hold(self, trace: motion.Trace, event: int) -> bool:
        """Of a hold that begins when the arm brakes, or ends to accelerate within the jerk of its goal."""
        begin, end = trace.index(self.hold["begin"]), trace.index(self.hold["end"])
        brakes = self._case.event.begin_limit is not None and begin > event + CYCLES_OF_ACCELERATION
        acceleration, jerk = self._case.kind.limits(self._lane.fields)
        speeds = [speed for speed, _tcp in trace.speeds]
        fastest = max(speeds[begin:begin + CYCLES_OF_ACCELERATION]) + 0.5 * acceleration**2 / jerk
        return brakes and max(speeds[end:], default=0.0) > fastest

    def _rest_limit(self) -> float:
        """s, until the arm decelerates."""
        event = self._case.event
        limit = WATCHDOG[self._case.profile] + BEGIN_LIMIT if event.is_left_to_the_watchdog else event.rest_limit
        if self._case.kind.space == MODE and event.begin_limit is not None and self.hold is None:
            limit = MODE_BEGIN_LIMIT
        return limit + (LOCAL_LIMIT if self._only_the_watchdog_ends_it() else 0.0)

    def _result(self, trace: motion.Trace, stopping: motion.Stopping) -> None:
        if self.result_at is None or stopping.rest is None:
            return
        rest = trace.published[stopping.rest]
        begin = max(self._lane.when, rest, self.hold["end"] if self.hold else 0)
        self._report.result = round(1e-9 * (self.result_at - begin), 4)
        early = 1e-9 * (rest - self.result_at)
        if early > EARLY_RESULT and not self._may_be_early():
            self._violation(f"the result comes {early:.3f} s before the standstill")
        limit = RESULT_LIMIT + self._case.event.attempts_to_stop + self._time_to_notice()
        limit += LOCAL_RESULT_LIMIT if self._case.local else 0.0
        limit += SCRIPT_BEGIN_LIMIT * TIMEOUT_FACTOR if self._may_not_have_begun(stopping) else 0.0
        if self._report.result > limit:
            self.limit_exceeded(f"the result comes {self._report.result:.3f} s after the standstill", self._report.result - limit,
                                self._lane.stalls.between(self._lane.when, self.result_at))

    def _may_be_early(self) -> bool:
        """A goal that had ended by itself, one that does not see the arm without its connection, and a stream, which has no result."""
        return self.result_at < self._lane.when or self._case.event.cuts_off or self._case.kind.is_topic

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
        if limit is None or stopping.latency is None or self._case.kind.space == MODE:
            return
        accelerates = self._case.kind.has_corner or self._change_of_speed(trace, stopping.event) > 0.0
        if self._only_the_watchdog_ends_it() or self._case.event.slows_time and accelerates:
            return
        latency = stopping.latency
        if self._brakes_along_path():
            latency, limit = CYCLE * (motion.last_peak(trace, stopping) - stopping.event), limit + self._time_to_brake(trace, stopping)
        elif self._case.kind.space == PATH and self._lane.second_request is not None:  # it may brake along its path until then
            latency -= CYCLE * (trace.index(self._lane.second_request) - stopping.event)
        if latency > limit + 0.5 * CYCLE:
            self.limit_exceeded(f"the deceleration begins {1e3 * latency:.0f} ms after the event", latency - limit, self._stall)

    def _time_to_brake(self, trace: motion.Trace, stopping: motion.Stopping) -> float:
        """s, in which an acceleration ends and a deceleration is seen, with the jerk of the goal."""
        acceleration, jerk = self._case.kind.limits(self._lane.fields)
        peak = max(trace.speeds[index][0] for index in range(stopping.event, (stopping.rest or stopping.event) + 1))
        return acceleration / jerk + math.sqrt(2.0 * (1.0 - motion.PEAK) * peak / jerk) + peak * (1.0 - motion.PEAK) / acceleration

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
        # Along a path, up to twice the limits of the goal are used if no other stop is found in time.
        fits = measured < 2.0 * asked * (1.0 + TOLERANCE) if self._brakes_along_path() else abs(measured - asked) <= TOLERANCE * asked
        if not fits:
            unit = "rad/s^2" if self._column() == 0 else "m/s^2"
            may_be_excused = self._case.kind.is_streamed or any(
                abs(measured - other) <= TOLERANCE * other for other in (*OF_OTHER_MEANS, self._lane.fields.get("acceleration", 0.0)))
            self.limit_exceeded(f"the deceleration is {measured:.2f} {unit} instead of {asked:.2f}",
                                 STALL_OF_A_STOP if may_be_excused else math.inf, self._stall_until_rest)

    def _program(self) -> None:
        if self.program_has_ended and self._case.kind.keeps_program:
            self.limit_exceeded("the stop has ended the control program", STALL_OF_A_STOP, self._lane.stalls.between(0, self._lane.now()))

    def _outcome(self, trace: motion.Trace, stopping: motion.Stopping) -> None:
        if self._report.outcome is None or self._case.local:
            return
        status, code = self._report.outcome
        if status == GoalStatus.STATUS_SUCCEEDED:
            is_own_end = stopping.first is None or self._was_decelerating(trace, stopping.event)
            wrong = not (is_own_end or self._case.kind.succeeds_if_ended or self._case.event.needs_client)
        else:
            has_code = self._case.kind.type.startswith(goal_kinds.PACKAGE)  # of this driver
            is_own_end = code == ErrorCode.NOT_REACHED and self._case.event.needs_client  # before the driver notices the event
            wrong = has_code and code not in self._case.event.codes and not is_own_end
        if wrong:
            text = f"the goal has the status {status} and the error code {code}"
            self.limit_exceeded(text, LONG_STALL if code in OF_LATE_HOST else math.inf, self._stall_until_rest)

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
        if asks != "goal" and kind.deceleration(self._lane.fields) is None:
            return None
        if asks == "default":
            return DEFAULT_DECELERATION
        if asks == "stop":
            return self._case.stop["joint_deceleration" if self._space() == JOINT else "linear_deceleration"]
        return kind.deceleration(self._lane.fields)

    def _decelerating_time(self, trace: motion.Trace, event: int) -> float:
        """s, an upper bound."""
        window = CYCLES_OF_ACCELERATION if self._case.event.begin_limit is not None else int(self._rest_limit() / CYCLE)
        joint, tcp = (max(speeds) for speeds in zip(*trace.speeds[max(0, event - 1):event + window]))
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

    def limit_exceeded(self, text: str, by: float, stall: float) -> None:
        """A stall of the host that is as long as a limit is exceeded by excuses that."""
        if stall < by:
            self._violation(f"{text}, although the host was late by at most {1e3 * stall:.1f} ms")
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
