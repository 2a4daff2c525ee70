"""Buttons that move the TCP while they are held, and STOP during a hold, without a browser."""

import itertools
from unittest.mock import MagicMock

import pytest
from ur_ros_rtde_viewer.control.jog import (
    FIRST_GAP,
    HOLD_RATE,
    RELEASE_TIME,
    STOPPED,
    STREAM_TIMEOUT,
    TWO_BUTTONS,
    Frame,
    Hold,
    Jog,
    JogSpeed,
    Meaning,
)

BACKGROUND = True
GAP = 1.2 * FIRST_GAP  # s
PAUSE = 1.5 * STREAM_TIMEOUT  # s; shorter than FIRST_GAP
X, Z = 0, 2  # axes
START, MOVE, END = Meaning.START, Meaning.MOVE, Meaning.END


def meanings(times):
    """Returns what the messages of a held button mean, at these times in s."""
    now = iter(times)
    hold = Hold(lambda: next(now))
    return [hold.begin(), *(hold.take() for _ in times[1:])]


def test_a_held_button_moves_the_arm_from_its_second_message_on():
    assert meanings([number / HOLD_RATE for number in range(4)]) == [START, MOVE, MOVE, MOVE]
    assert meanings([0.0, 0.2, 0.29, 0.38]) == [START, MOVE, MOVE, MOVE]  # a slow browser
    assert meanings([0.0, 0.2, 0.35]) == [START, MOVE, END]
    assert meanings([0.0, 0.3]) == [START, END]


def test_a_message_that_is_missing_ends_a_hold_with_the_default_timeout():
    assert meanings([0.0, 0.05, 0.1, 0.201]) == [START, MOVE, MOVE, END]


def test_delayed_messages_that_arrive_together_move_nothing():
    assert MOVE not in meanings([0.0, *(1.0 + 0.0005 * number for number in range(60))])


class JogWithTwists(Jog):
    """A Jog on a clock of its own. Notes the speeds that it would publish."""

    def __init__(self):
        self.now, self.twists = 0.0, []
        super().__init__(MagicMock(), MagicMock(), lambda: self.now)
        self._publisher.get_subscription_count.return_value = 1

    def hold_for(self, duration, *tabs, axes=(Z,)):
        """Each of `tabs` holds a button of each of `axes` for `duration` s. Returns the speeds that are published, and the last reasons."""
        first, reasons = len(self.twists), {}
        for _ in range(round(duration * HOLD_RATE)):
            self.now += 1 / HOLD_RATE
            for button in itertools.product(tabs, axes):
                reasons[button] = self.hold(*button, 1.0, Frame.BASE, JogSpeed())
        return self.twists[first:], list(reasons.values())

    def let_go(self, tab, axis=Z):
        self.release(tab, axis, 1.0)

    def _publish(self, frame, axis, value):
        self.twists.append(value)


@pytest.fixture
def jog():
    jog = JogWithTwists()
    assert any(jog.hold_for(0.2, "tab")[0])
    return jog


@pytest.mark.parametrize("gap", [0.0, PAUSE, GAP])
def test_each_hold_begins_with_a_zero_twist(jog, gap):
    jog.now += gap
    jog.let_go("tab")
    first, *others = jog.hold_for(0.2, "tab")[0]
    assert first == 0.0 and others and all(others)


@pytest.mark.parametrize("gap", [PAUSE, GAP])
def test_a_pause_of_the_messages_ends_the_hold_until_the_button_is_released(jog, gap):
    """A stop from elsewhere may have ended the motion in the pause. A zero twist would let the driver begin it again."""
    jog.now += gap
    for _ in range(3):
        assert jog.hold_for(0.5, "tab") == ([], [STOPPED])
    jog.let_go("tab")
    speeds, reasons = jog.hold_for(0.5, "tab")
    assert any(speeds) and reasons == [None]


@pytest.mark.parametrize("timeout", [STREAM_TIMEOUT, 1.0])
def test_a_pause_that_is_shorter_than_the_timeout_of_the_driver_does_not_end_the_hold(jog, timeout):
    jog.set_stream_timeout(timeout)
    jog.now += 0.99 * timeout - 1 / HOLD_RATE
    speeds, reasons = jog.hold_for(0.5, "tab")
    assert all(speeds) and reasons == [None]


def test_a_button_that_was_held_while_another_tab_moved_the_arm_moves_it_only_after_its_release(jog):
    assert jog.hold_for(0.2, "tab", "second")[1] == [None, "the arm is being moved from another tab"]
    jog.let_go("tab")
    assert jog.hold_for(0.5, "second") == ([], [STOPPED])
    jog.let_go("second")
    assert any(jog.hold_for(0.5, "second")[0])


@pytest.mark.parametrize("first_released", [X, Z])
def test_a_second_finger_on_another_button_stops_the_arm_until_both_are_released(jog, first_released):
    speeds, reasons = jog.hold_for(0.5, "tab", axes=(X, Z))
    assert speeds == [0.0] and reasons == [TWO_BUTTONS, TWO_BUTTONS]
    jog.let_go("tab", first_released)
    other = X + Z - first_released
    assert jog.hold_for(0.5, "tab", axes=(other,)) == ([], [STOPPED])
    jog.let_go("tab", other)
    speeds, reasons = jog.hold_for(0.5, "tab", axes=(X,))
    assert any(speeds) and reasons == [None]


def test_a_button_whose_release_was_lost_does_not_block_the_others(jog):
    jog.now += RELEASE_TIME
    speeds, reasons = jog.hold_for(0.5, "tab", axes=(X,))
    assert any(speeds) and reasons == [None]
    assert jog.hold_for(0.1, "tab") == ([0.0], [TWO_BUTTONS])


def test_two_fingers_in_one_tab_do_not_stop_the_motion_of_another_tab(jog):
    for _ in range(5):
        speeds, reasons = jog.hold_for(1 / HOLD_RATE, "tab")
        assert all(speeds) and reasons == [None]
        for axis in (X, Z):
            assert jog.hold("second", axis, 1.0, Frame.BASE, JogSpeed()) is not None


def test_closing_a_tab_with_two_held_buttons_releases_both(jog):
    jog.hold_for(0.1, "tab", axes=(X, Z))
    jog.close("tab")
    assert any(jog.hold_for(0.5, "tab", axes=(X,))[0])


def test_a_tab_moves_the_arm_after_a_pause_in_the_hold_of_another_one(jog):
    jog.now += PAUSE
    assert any(jog.hold_for(0.5, "second")[0])
    jog.let_go("second")
    assert jog.hold_for(0.5, "tab") == ([], [STOPPED])


def test_a_driver_that_is_found_during_a_hold_does_not_move_the_arm(jog):
    jog._publisher.get_subscription_count.return_value = 0
    speeds, (reason,) = jog.hold_for(0.1, "tab")
    assert not speeds and reason.startswith("no server of twist")
    jog._publisher.get_subscription_count.return_value = 1
    assert jog.hold_for(0.5, "tab") == ([], [STOPPED])


def test_stop_holds_through_gaps_until_the_button_is_released(jog):
    jog.stop()
    for _ in range(3):
        assert jog.hold_for(0.5, "tab") == ([], [STOPPED])
        jog.now += GAP
    jog.let_go("tab")
    speeds, reasons = jog.hold_for(0.5, "tab")
    assert any(speeds) and reasons == [None]


def test_stop_during_a_gap_ends_the_hold(jog):
    jog.now += GAP
    jog.stop()
    assert jog.hold_for(0.5, "tab") == ([], [STOPPED])


def test_stop_ends_the_holds_of_all_tabs(jog):
    jog.hold_for(0.1, "tab", "second")
    jog.stop()
    jog.now += GAP
    assert jog.hold_for(0.5, "tab", "second") == ([], [STOPPED, STOPPED])
    jog.let_go("tab")
    jog.now += GAP
    assert jog.hold_for(0.5, "second") == ([], [STOPPED])
    assert any(jog.hold_for(0.5, "tab")[0])


def test_a_tab_that_is_closed_leaves_nothing_stopped(jog):
    jog.stop()
    jog.close("tab")  # as its panel does
    assert any(jog.hold_for(0.5, "reloaded")[0])


def test_a_button_that_is_pressed_after_stop_jogs(jog):
    jog.let_go("tab")
    jog.stop()
    assert any(jog.hold_for(0.5, "tab")[0])
