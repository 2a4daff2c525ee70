"""What the arm did around an event, from the trace of the simulator: the target speeds of each control cycle."""

from dataclasses import dataclass
from typing import List, Optional, Tuple

from support import REAL_TIME_FACTOR

CYCLE = 0.002  # s of the robot
AT_REST = 1e-4  # rad/s and m/s, of targets
REST_CYCLES = 10  # a shorter time without motion is a reversal
DECREASE = 1e-6  # a smaller change of a speed is rounding
MEASURED_CYCLES = 6  # a shorter deceleration is not measured
PEAK = 0.98  # of the highest speed
CREEPING = 2e-3  # rad/s and m/s: a controller may approach the last position in several attempts


class Trace:
    """The cycles from its construction on. Call update() at least every 30 s."""

    def __init__(self, simulator):
        self._simulator = simulator
        self._last = simulator.state()["cycle"]
        self.published: List[int] = []  # ns since the epoch, of the state after each cycle
        self.speeds: List[Tuple[float, float]] = []  # of the fastest joint, rad/s, and of the TCP, m/s

    def update(self) -> "Trace":
        for cycle, published, joint_speed, tcp_speed in self._simulator.control("trace", after=self._last)["cycles"]:
            assert cycle == self._last + 1, "the trace has gaps"
            self.published.append(published)
            self.speeds.append((joint_speed, tcp_speed))
            self._last = cycle
        return self

    def index(self, when: int) -> int:
        """Returns the index of the last cycle that was published at a time, ns since the epoch."""
        low, high = 0, len(self.published)
        while low < high:
            middle = (low + high) // 2
            low, high = (middle + 1, high) if self.published[middle] <= when else (low, middle)
        return max(0, low - 1)

    def length(self) -> int:
        return len(self.speeds)

    def moves(self, index: int) -> bool:
        return max(self.speeds[index]) > AT_REST

    def moves_between(self, begin: int, end: int) -> bool:
        return any(self.moves(index) for index in range(begin, end))

    def delay(self, begin: int, end: int) -> float:
        """Returns by how much the cycles of a range were late, s of the robot: its time then advances in leaps."""
        gaps = [1e-9 * REAL_TIME_FACTOR * (b - a) - CYCLE for a, b in zip(self.published[begin:end], self.published[begin + 1:end + 1])]
        return sum(gap for gap in gaps if gap > 0.5 * CYCLE)


@dataclass
class Stopping:
    event: int  # index of the last cycle before the event
    first: Optional[int]  # decelerating cycle; None: the arm did not move
    rest: Optional[int]  # None: the arm does not come to rest
    moved_again: Optional[int]

    @property
    def latency(self) -> Optional[float]:
        """s of the robot, from the event to the first decelerating cycle."""
        return None if self.first is None else CYCLE * (self.first - self.event)

    @property
    def duration(self) -> Optional[float]:
        """s of the robot, from the event to the standstill."""
        return None if self.rest is None else CYCLE * (self.rest - self.event)


def rest_after(trace: Trace, begin: int, end: int, cycles: int = REST_CYCLES) -> Optional[int]:
    """Returns the first cycle of the first standstill of so many cycles, or of one that lasts until `end`."""
    resting = 0
    for index in range(begin, end):
        resting = 0 if trace.moves(index) else resting + 1
        if resting == cycles or resting and index == end - 1:
            return index - resting + 1
    return None


def find_stopping(trace: Trace, event: int, may_begin_until: int, end: int, column: int, rest_cycles: int = REST_CYCLES,
                  has_pauses: bool = False) -> Stopping:
    """Up to the cycle `may_begin_until`, an arm that rests since the event may still begin the motion that it was told before, and one
    whose motion `has_pauses` may go on. The deceleration is that of the leading joint (column 0) or of the TCP (1)."""
    rest = rest_after(trace, event + 1, end, rest_cycles)
    may_go_on = True
    while rest is not None and may_go_on and trace.moves_between(rest, min(may_begin_until, end)):
        may_go_on = has_pauses or not trace.moves_between(event, rest)
        rest = rest_after(trace, rest + rest_cycles, end, rest_cycles) if may_go_on else rest
    again = None if rest is None else next((index for index in range(rest, end) if max(trace.speeds[index]) > CREEPING), None)
    if rest is None or not trace.moves_between(event, rest):
        return Stopping(event, None, rest, again)
    first = _begin_of_creeping(trace, event, rest, column)
    while first > event + 1 and _slower(trace, first - 1, first, column):
        first -= 1
    return Stopping(event, first, rest, again)


def last_peak(trace: Trace, stopping: Stopping) -> int:
    """Returns the last cycle after the event in which the leading joint is nearly at its highest speed: a late setpoint makes the
    deceleration along a path uneven."""
    assert stopping.rest is not None
    speeds = [trace.speeds[index][0] for index in range(stopping.event, stopping.rest + 1)]
    return stopping.event + max(index for index, speed in enumerate(speeds) if speed >= PEAK * max(speeds))


def _begin_of_creeping(trace: Trace, event: int, rest: int, column: int) -> int:
    """Returns the cycle from which on the arm is slow; `rest` if it was not faster after the event."""
    fast = [index for index in range(event + 1, rest) if trace.speeds[index][column] > CREEPING]
    return fast[-1] + 1 if fast else rest


def _slower(trace: Trace, before: int, after: int, column: int) -> bool:
    return trace.speeds[after][column] < trace.speeds[before][column] - DECREASE


def deceleration(trace: Trace, stopping: Stopping, column: int) -> Optional[float]:
    """Returns the median deceleration of the leading joint or the TCP; None if the arm did not decelerate for long enough.

    Only of the cycles that decelerate by at least half as much as the steepest one: the motion itself may have slowed down before."""
    if stopping.first is None or stopping.rest is None:
        return None
    speeds = [trace.speeds[index][column] for index in range(stopping.first, stopping.rest - 1)]
    slopes = sorted((a - b) / CYCLE for a, b in zip(speeds, speeds[1:]))
    braking = [slope for slope in slopes if slope >= 0.5 * slopes[-1]]
    return braking[len(braking) // 2] if len(braking) >= MEASURED_CYCLES - 1 else None

