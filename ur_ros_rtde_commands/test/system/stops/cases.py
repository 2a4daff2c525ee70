"""A case of the stop property test: everything that is drawn by chance, from one number."""

import math
from dataclasses import dataclass, replace
from random import Random
from typing import Dict, List, Optional, Sequence, Tuple

from .events import EVENTS, Event
from .goal_kinds import HAND_GUIDED, GoalKind

BLOCK = 30  # consecutive seeds with the same profile: a lane restarts its driver between two profiles
# Parameters of the driver. "fast" are the defaults: a hold of more than 0.1 s is a lost connection.
PROFILES: Dict[str, Tuple[str, ...]] = {
    "patient": ("silence_limit:=2.0", "watchdog_frequency:=2.0"),
    "fast": ("silence_limit:=0.1", "watchdog_frequency:=10.0"),
    "preempt": ("silence_limit:=2.0", "watchdog_frequency:=2.0", "on_busy:=preempt"),
    "urcap": ("silence_limit:=2.0", "watchdog_frequency:=2.0", "control_mode:=control_urcap"),
}


def _parameter(profile: str, name: str) -> float:
    return next(float(text.partition(":=")[2]) for text in PROFILES[profile] if text.startswith(f"{name}:="))


WATCHDOG = {profile: 1.0 / _parameter(profile, "watchdog_frequency") for profile in PROFILES}  # s; it ends a program without heartbeats
SILENCE_LIMIT = {profile: _parameter(profile, "silence_limit") for profile in PROFILES}  # s; a silent connection is then found to be dead
ENUMERATED = 4  # each fourth case is the next one of all pairs of a goal and an event; the others are drawn by their weights
HELD = 0.4  # of all cases
WAITING = 0.4  # of the cases in which a goal may wait for the arm
ARRIVAL = 0.02  # s, until the driver has received a goal
LOCAL = 0.12  # of the cases that are possible in local control
LONGEST_HOLD = 0.4  # s
PRESSED = ("program stopped", "program paused")  # on the pendant
# The thread of a goal is late while its program ends and the next one starts. The seeds of these cases are -1, -2, and so on.
LATE_THREADS = [(kind, event) for kind in ("execute_trajectory", "move_j", "servo_j", "speed_j")
                for event in ("program stopped", "program replaced")]


def profile_of(seed: int) -> str:
    return "patient" if seed < 0 else list(PROFILES)[seed // BLOCK % len(PROFILES)]


@dataclass(frozen=True)
class HoldPlan:
    begin: float  # s, relative to the event; negative: before it
    seconds: float
    mover: bool  # includes the threads of goals and of the topic that moves the arm
    count: int  # of further threads; -1: all
    seed: int  # which ones

    def choose(self, threads: Sequence[Tuple[int, str]], kind: GoalKind) -> List[Tuple[int, str]]:
        """Of the threads of the driver, by number and name."""
        if self.count < 0:
            return list(threads)
        chosen = Random(self.seed).sample(list(threads), min(self.count, len(threads)))
        movers = [thread for thread in threads if self.mover and thread[1].startswith((f"stream /{kind.action}"[:15], "goal "))]
        return [*chosen, *(thread for thread in movers if thread not in chosen)]


@dataclass(frozen=True)
class Case:
    seed: int
    profile: str
    kind: GoalKind
    event: Event
    waits_for_motion: bool
    delay: float  # s, from the acceptance of the goal, or the first motion, to the event
    second_delay: float  # s, between the two requests of "cancel, then stop"
    stop: Dict[str, float]  # fields of a stop
    hold: Optional[HoldPlan]
    waiting: Optional[float]  # s before the event, when a goal comes that has to preempt this one; None: there is no such goal
    local: bool  # the operator has selected local control before the event: the driver can neither stop nor start a program

    def text(self) -> str:
        hold = "" if self.hold is None else (f", hold of {1e3 * self.hold.seconds:.0f} ms from {1e3 * self.hold.begin:+.0f} ms, "
                                             f"{self.hold.count if self.hold.count >= 0 else 'all'} threads"
                                             f"{' and what moves the arm' if self.hold.mover else ''}")
        after = "motion" if self.waits_for_motion else "acceptance"
        waiting = "" if self.waiting is None else f", a goal that preempts it {1e3 * self.waiting:.0f} ms before the event"
        local = ", local control" if self.local else ""
        return f"{self.kind.name}, {self.event.name} {1e3 * self.delay:.0f} ms after {after}, {self.profile}{waiting}{local}{hold}"


def is_possible(kind: GoalKind, event: Event, profile: str) -> bool:
    if event.profile and event.profile != profile:
        return False
    if kind.is_topic:  # no goal that could be canceled, preempted or lose its client
        return not (event.needs_client or event.name == "preempted" or event.name.startswith("cancel, then"))
    waits_for_play = event.name in ("program paused", "dashboard pause") and kind.name == "send_script"
    return not waits_for_play and not (event.name == "preempted" and kind.name in HAND_GUIDED)


def draw(seed: int, kinds: Sequence[GoalKind], holds: bool = True) -> Case:
    """The same seed and kinds give the same case."""
    random = Random(f"stop/{seed}")
    profile = profile_of(seed)
    possible = [kind for kind in kinds if not (kind.runs_script and profile == "urcap")]
    kind = random.choices(possible, [kind.weight for kind in possible])[0]
    events = [event for event in EVENTS if is_possible(kind, event, profile)]
    event = random.choices(events, [event.weight for event in events])[0]
    if seed % BLOCK % ENUMERATED == 0:
        kind, event = _enumerated(seed, possible, profile)
    waits = random.random() < 0.8
    delay = random.uniform(0.0, 0.9) if waits else random.uniform(0.0, 0.08)
    second_delay = random.uniform(0.0, 0.3)
    stop = {"joint_deceleration": random.uniform(1.5, 8.0), "linear_deceleration": random.uniform(1.0, 6.0)}
    hold = _hold(random)
    may_wait = profile == "preempt" and event.ends_waiting and kind.name not in HAND_GUIDED
    waiting = random.uniform(0.0, 0.4) if random.random() < WAITING and may_wait else None
    if hold is not None and waiting is not None and hold.begin < ARRIVAL - waiting:
        waiting = None  # the driver could receive it after the event
    local = random.random() < LOCAL and event.in_local_control and waiting is None
    local = local and (waits or not kind.runs_script)  # the controller takes no script in local control
    if event.name in PRESSED and hold is not None and hold.begin < 0.0 and profile == "fast":
        local = False  # the watchdog may have ended the program before, and the driver could not start it again
    case = Case(seed, profile, kind, event, waits, delay, second_delay, stop, hold, waiting, local)
    if seed < 0:
        case = _with_late_thread(case, kinds, *LATE_THREADS[-seed - 1])
    return case if holds else replace(case, hold=None)


def _enumerated(seed: int, kinds: Sequence[GoalKind], profile: str) -> Tuple[GoalKind, Event]:
    """Returns each pair of a kind and an event in turn, in an order by chance, so that consecutive seeds differ."""
    number = seed // (BLOCK * len(PROFILES)) * math.ceil(BLOCK / ENUMERATED) + seed % BLOCK // ENUMERATED
    pairs = [(kind, event) for kind in kinds for event in EVENTS if is_possible(kind, event, profile)]
    Random(profile).shuffle(pairs)
    return pairs[number % len(pairs)]


def _with_late_thread(case: Case, kinds: Sequence[GoalKind], kind: str, event: str) -> Case:
    return replace(case, kind=next(known for known in kinds if known.name == kind),
                   event=next(known for known in EVENTS if known.name == event), waits_for_motion=True, waiting=None, local=False,
                   hold=HoldPlan(begin=-0.02, seconds=LONGEST_HOLD, mover=True, count=0, seed=0))


def _hold(random: Random) -> Optional[HoldPlan]:
    plan = HoldPlan(begin=random.uniform(-0.1, 0.1), seconds=random.uniform(0.001, LONGEST_HOLD) ** random.choice((1.0, 1.5)),
                    mover=random.random() < 0.4, count=random.choice((1, 1, 1, 2, 4, 8, -1)), seed=random.randrange(2**32))
    return plan if random.random() < HELD else None
