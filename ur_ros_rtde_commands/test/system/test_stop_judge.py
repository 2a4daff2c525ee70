"""What the judge of the stop property test finds in motions that are made up: see stops/properties.py."""

from dataclasses import replace
from types import SimpleNamespace

import pytest
from action_msgs.msg import GoalStatus
from stops import goal_kinds, motion, properties
from stops.cases import Case, HoldPlan
from stops.events import EVENTS
from stops.report import Report

from ur_ros_rtde_msgs.msg import ErrorCode

BACKGROUND = True
SPEED, DECELERATION = 0.5, 2.0  # rad/s, rad/s^2
EVENT = 50  # cycle
NS = 1_000_000_000
CANCELED, ABORTED, SUCCEEDED = GoalStatus.STATUS_CANCELED, GoalStatus.STATUS_ABORTED, GoalStatus.STATUS_SUCCEEDED


class MadeUp(motion.Trace):
    """Cruises, decelerates from some cycles after the event on, and rests."""

    def __init__(self, latency=2, deceleration=DECELERATION, then=()):
        speeds = [SPEED] * (EVENT + latency)
        while speeds[-1] > 0.0:
            speeds.append(max(0.0, speeds[-1] - deceleration * motion.CYCLE))
        self.rest = len(speeds) - 1
        speeds += [0.0] * 100 + list(then) + [0.0] * 100
        self.speeds = [(speed, 0.1 * speed) for speed in speeds]
        self.published = [NS + round(index * 1e9 * motion.CYCLE) for index in range(len(speeds))]


def judge(trace, kind="move_j", event="cancel", stall=0.0, result=0.02, outcome=(CANCELED, ErrorCode.CANCELED), moved=True, **changes):
    """Returns the report of a case. `result`: s, from the standstill."""
    kind = next(known for known in goal_kinds.KINDS if known.name == kind)
    event = next(known for known in EVENTS if known.name == event)
    case = Case(0, "patient", kind, event, True, 0.1, 0.1, {"joint_deceleration": 4.0, "linear_deceleration": 3.0}, None, None, False)
    when = trace.published[EVENT]
    fields = {"speed": SPEED, "acceleration": 1.4}
    lane = SimpleNamespace(when=when, took_effect=when, preempting_goal=None, second_request=None, fields=fields,
                           stalls=SimpleNamespace(between=lambda begin, end: stall if begin < end else 0.0), now=lambda: 2 * NS)
    case = replace(case, hold=HoldPlan(0.01, 0.3, True, 0, 0) if "hold" in changes else None)
    report = Report(0, case.text(), kind.name, event.name, False, moved=moved, outcome=outcome)
    checks = properties.Checks(lane, case, report)
    checks.result_at = trace.published[trace.rest] + round(1e9 * result)
    for name in ("drift", "program_has_ended", "problems_of_requests", "hold"):
        setattr(checks, name, changes.get(name, getattr(checks, name)))
    checks.evaluate(trace)
    return report


def test_a_stop_as_it_should_be_has_no_violation():
    report = judge(MadeUp())
    assert (report.violations, report.excused) == ([], [])
    assert report.latency == pytest.approx(0.004, abs=0.003) and report.deceleration == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("trace, changes, text", [
    (MadeUp(latency=15), {}, "the deceleration begins 28 ms"),
    (MadeUp(deceleration=4.0), {}, "the deceleration is 4.00 rad/s^2 instead of 2.00"),
    (MadeUp(), {"event": "stop", "outcome": (ABORTED, ErrorCode.PREEMPTED)}, "the deceleration is 2.00 rad/s^2 instead of 4.00"),
    (MadeUp(), {"result": 1.5}, "the result comes 1.500 s after the standstill"),
    (MadeUp(), {"program_has_ended": True}, "the stop has ended the control program"),
    (MadeUp(), {"moved": False}, "the goal has not moved the arm"),
    (MadeUp(), {"problems_of_requests": ["STOP of the page: no answer"]}, "STOP of the page: no answer"),
])
def test_what_a_late_host_explains_is_excused_then_alone(trace, changes, text):
    report = judge(trace, **changes)
    assert len(report.violations) == 1 and report.violations[0].startswith(text), report
    report = judge(trace, stall=2.0, **changes)
    assert not report.violations and len(report.excused) == 1 and report.excused[0].startswith(text), report


@pytest.mark.parametrize("trace, changes, text", [
    (MadeUp(then=[0.1] * 20), {}, "the arm moves again 0."),
    (MadeUp(deceleration=3.0), {}, "the deceleration is 3.00 rad/s^2 instead of 2.00"),  # of no other means
    (MadeUp(), {"result": -0.1}, "the result comes 0.100 s before the standstill"),
    (MadeUp(), {"drift": 0.01}, "the arm drifts by 0.0100 rad"),
    (MadeUp(), {"outcome": (ABORTED, ErrorCode.BUSY)}, f"the goal has the status {ABORTED} and the error code {ErrorCode.BUSY}"),
    (MadeUp(), {"outcome": (SUCCEEDED, 0)}, f"the goal has the status {SUCCEEDED} and the error code 0"),
])
def test_nothing_excuses_these(trace, changes, text):
    for stall in (0.0, 2.0):
        report = judge(trace, stall=stall, **changes)
        assert any(violation.startswith(text) for violation in report.violations), report


def test_an_arm_that_does_not_come_to_rest_is_a_violation():
    trace = MadeUp()
    trace.speeds = [(SPEED, 0.1)] * len(trace.speeds)
    assert judge(trace).violations == ["the arm does not come to rest"]


def test_an_arm_that_rests_may_begin_what_it_was_told_before():
    """The goal was accepted, and the event comes before its motion: it ends within the limit of a request."""
    trace = MadeUp(latency=6)
    trace.speeds = [(0.0, 0.0)] * (EVENT + 3) + trace.speeds[EVENT + 3:]
    assert judge(trace).violations == []


def test_a_motion_after_a_pause_is_no_begin():
    """Of 20 cycles at rest, within the limit of an event that a connection has to notice."""
    trace = MadeUp(then=[0.1] * 20)
    report = judge(trace, event="RTDE links dropped", outcome=(ABORTED, ErrorCode.LINK_LOST))
    assert any("moves again" in violation for violation in report.violations), report


def test_without_a_heartbeat_the_watchdog_has_its_time_and_no_more():
    for latency, is_late in ((240, False), (300, True)):  # cycles; 0.48 and 0.6 s with a watchdog of 0.5 s
        report = judge(MadeUp(latency=latency), event="driver suspended", outcome=(ABORTED, ErrorCode.PROGRAM_STOPPED))
        assert bool(report.violations) == is_late, report


@pytest.mark.parametrize("speed, is_wrong", [(0.7 * SPEED, False), (1.3 * SPEED, True)])
def test_an_arm_that_was_held_while_it_braked_along_its_path_may_brake_on_but_no_faster(speed, is_wrong):
    trace = MadeUp(then=[speed] * 20)
    hold = {"begin": trace.published[EVENT + 20], "end": trace.published[trace.rest + 90]}
    report = judge(trace, "follow_joint_trajectory", hold=hold, result=0.3, outcome=(CANCELED, 0))
    assert report.violations == (["after the hold, the arm is faster than before it"] if is_wrong else []), report
    assert any("moves again" in violation for violation in judge(trace, hold=hold).violations), "not along a path"
