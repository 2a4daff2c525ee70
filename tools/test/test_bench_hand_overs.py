"""./ur bench --trace: the evaluation of traces."""

import pytest
from ur_tools.bench_hand_overs import Event, goal_times, load, losses, package_times, steps

MS = 1_000_000
SENT = [index * 2 * MS for index in range(1, 11)]
DRIVER, OTHER, LISTENER, EXECUTOR = 1, 2, 3, 4


def driver_events(sent, delay=0.0):
    """Returns the events of the packages in a driver that publishes each of them."""
    events = []
    for when in sent:
        begin = int(when + delay * MS)
        events += [Event(begin + 10_000, DRIVER, "readable", 0), Event(begin + 15_000, DRIVER, "received", 0),
                   Event(begin + 12_000, OTHER, "received", 0), Event(begin + 40_000, DRIVER, "publish", begin + 15_000),
                   Event(begin + 60_000, DRIVER, "published", begin + 15_000)]
    return sorted(events)


def subscriber_events(driver, notified=(), taken=()):
    """Returns the events of the messages in a subscriber. The message numbers in `notified` and `taken` are missing."""
    events = []
    for number, event in enumerate(event for event in driver if event.kind == "publish"):
        if number not in notified:
            events.append(Event(event.time + 100_000, LISTENER, "notified", 0))
        if number not in (*notified, *taken):
            events.append(Event(event.time + 130_000, EXECUTOR, "taken", event.stamp))
    return sorted(events)


def test_the_time_of_each_step_is_found():
    driver = driver_events(SENT)
    found = steps(package_times(SENT, driver, subscriber_events(driver)))
    assert [values[0] for values in found] == pytest.approx([0.010, 0.005, 0.025, 0.020, 0.080, 0.030, 0.170])
    assert all(len(values) == len(SENT) for values in found)


def test_a_goal_is_followed_to_its_command():
    kinds = ["request_notified", "request_taken", "respond", "responded", "send"]
    driver = [Event(1000 + 10 * index, 1, kind, 0) for index, kind in enumerate(kinds)]
    assert goal_times([(990, 1100), (5000, 5100)], driver) == [[990, 1000, 1010, 1020, 1030, 1040, 1100]]


def test_lost_packages_are_attributed_to_the_step_that_lost_them():
    driver = driver_events(SENT)
    none = {"packages": 10, "socket": 0, "thread": 0, "DDS": 0, "subscriber": 0}
    assert losses(SENT, driver, subscriber_events(driver)) == none
    # Without a notification, and notified but not taken.
    assert losses(SENT, driver, subscriber_events(driver, notified=[4])) == {**none, "DDS": 1}
    assert losses(SENT, driver, subscriber_events(driver, taken=[4, 5])) == {**none, "subscriber": 2}
    # Read with the next package, and the thread waited for it.
    later = [event for event in driver if not SENT[4] <= event.time < SENT[5]]
    assert losses(SENT, later, subscriber_events(later)) == {**none, "thread": 1}
    late = [event for event in driver if not SENT[4] <= event.time < SENT[5] or event.kind == "readable"]
    assert losses(SENT, late, subscriber_events(late)) == {**none, "socket": 1}


def test_a_trace_is_read_in_the_order_of_time(tmp_path):
    (tmp_path / "trace").write_text("published 7 200 150\npublish 7 160 150\n")
    assert load(tmp_path / "trace") == [Event(160, 7, "publish", 150), Event(200, 7, "published", 150)]
