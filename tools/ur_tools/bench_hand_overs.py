"""Evaluates the traces of ur_ros_rtde/bench/hand_over_trace.cpp: where the time between a package and a subscriber goes, and between
a goal and its command, and where packages are lost."""

import bisect
import pathlib
from typing import Dict, List, NamedTuple, Optional, Sequence, Tuple

# The stamp is derived from a monotonic clock; the two clocks are read one after the other.
CLOCK_TOLERANCE = 20_000  # ns

# The hand-overs of a package and of a goal, in order: the part that has it from then on, and what it did last.
PACKAGE_STEPS = ("readable", "received", "publish", "published", "notified", "taken")
PACKAGE_TEXTS = ("package sent -> receiving thread runs", "package read from the socket", "decoded, sample stored, message filled",
                 "message serialized and handed to Fast DDS", "Fast DDS thread of the subscriber runs",
                 "subscriber's executor runs, takes it")
GOAL_STEPS = ("request_notified", "request_taken", "respond", "responded", "send")
GOAL_TEXTS = ("goal sent -> Fast DDS thread of the driver runs", "driver's executor runs, takes it", "goal checked and accepted",
              "response handed to Fast DDS", "goal's thread runs, sends the command", "command read by the controller")


class Event(NamedTuple):
    time: int  # ns since the epoch
    thread: int
    kind: str
    stamp: int  # of the message, ns; 0 for other events


def load(file: pathlib.Path) -> List[Event]:
    events = []
    for line in file.read_text().splitlines():
        kind, thread, when, stamp = line.split()
        events.append(Event(int(when), int(thread), kind, int(stamp)))
    return sorted(events)


class _Times:
    """The times of the events of one kind, of one thread or of all."""

    def __init__(self, events: Sequence[Event], kind: str, thread: Optional[int] = None):
        self._times = [event.time for event in events if event.kind == kind and thread in (None, event.thread)]

    def last(self, until: int) -> Optional[int]:
        index = bisect.bisect_right(self._times, until)
        return self._times[index - 1] if index else None

    def first(self, begin: int) -> Optional[int]:
        index = bisect.bisect_left(self._times, begin)
        return self._times[index] if index < len(self._times) else None


def package_of(sent: Sequence[int], stamp: int) -> int:
    """Returns the index of the package that was received at the time `stamp`, or -1."""
    return bisect.bisect_right(sent, stamp + CLOCK_TOLERANCE) - 1


def package_times(sent: Sequence[int], driver: Sequence[Event], subscriber: Sequence[Event]) -> List[List[int]]:
    """Returns, for each message that reached the subscriber, the time of its package and of all steps."""
    threads = {event.thread for event in driver if event.kind == "publish"}
    readable = {thread: _Times(driver, "readable", thread) for thread in threads}
    received = {thread: _Times(driver, "received", thread) for thread in threads}
    published = {event.stamp: event.time for event in driver if event.kind == "published"}
    taken = {event.stamp: event.time for event in subscriber if event.kind == "taken"}
    notified = _Times(subscriber, "notified")
    result = []
    for event in driver:
        package = package_of(sent, event.stamp)
        if event.kind != "publish" or package < 0 or event.stamp not in taken or event.stamp not in published:
            continue
        read = received[event.thread].last(event.time)
        times = [sent[package], None if read is None else readable[event.thread].last(read), read, event.time,
                 published[event.stamp], notified.last(taken[event.stamp]), taken[event.stamp]]
        known = [time for time in times if time is not None]
        if len(known) == len(times):
            result.append(known)
    return result


def goal_times(goals: Sequence[Tuple[int, int]], driver: Sequence[Event]) -> List[List[int]]:
    """Returns, for each goal, sent at one time and with its command at the controller at another, the times of all steps."""
    found = {step: _Times(driver, step) for step in GOAL_STEPS}
    result = []
    for sent, arrived in goals:
        times = [sent]
        for step in GOAL_STEPS:
            moment = found[step].first(times[-1])
            if moment is None:
                break
            times.append(moment)
        if len(times) == 1 + len(GOAL_STEPS) and times[-1] <= arrived:
            result.append([*times, arrived])
    return result


def steps(times: Sequence[Sequence[int]]) -> List[List[float]]:
    """Returns the durations of each step in ms, and at the end those of all steps together."""
    durations = [[(row[index + 1] - row[index]) * 1e-6 for row in times] for index in range(len(times[0]) - 1)] if times else []
    return [*durations, [(row[-1] - row[0]) * 1e-6 for row in times]]


def losses(sent: Sequence[int], driver: Sequence[Event], subscriber: Sequence[Event]) -> Dict[str, int]:
    """Returns how many packages were lost, and where, between the first and the last message that the subscriber received.

    socket: the driver's thread waited for data, and the package came with the next one or not at all.
    thread: the next package was already there when the driver's thread read: the newest was published.
    DDS: published, but the Fast DDS thread of the subscriber did not notify of it.
    subscriber: notified, but replaced by newer messages before the subscriber took it.
    """
    taken = {package_of(sent, event.stamp): event for event in subscriber if event.kind == "taken"}
    taken.pop(-1, None)
    if not taken:
        return {}
    first, last = min(taken), max(taken)
    published = {package_of(sent, event.stamp): event.thread for event in driver if event.kind == "publish"}
    readable = {thread: _Times(driver, "readable", thread) for thread in set(published.values())}
    result = {"packages": last - first + 1, "socket": 0, "thread": 0, "DDS": 0, "subscriber": 0}
    unread = [package for package in range(first, last + 1) if package not in published]
    for package in unread:
        woken = [found for times in readable.values() if (found := times.first(sent[package])) is not None]
        result["thread" if not woken or min(woken) >= sent[package + 1] else "socket"] += 1
    missing = sum(package not in taken for package in range(first, last + 1)) - len(unread)
    begin, end = taken[first].time, taken[last].time
    notified = sum(event.kind == "notified" and begin < event.time <= end for event in subscriber)
    replaced = min(missing, max(0, notified - (len(taken) - 1)))
    result.update(DDS=missing - replaced, subscriber=replaced)
    return result
