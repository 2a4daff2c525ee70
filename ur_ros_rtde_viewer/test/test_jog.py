"""Buttons that move the TCP while they are held, and STOP during a hold, without a browser."""

from unittest.mock import MagicMock

import pytest
from ur_ros_rtde_viewer.control.jog import FIRST_GAP, HOLD_RATE, STOPPED, STREAM_TIMEOUT, Frame, Hold, Jog, JogSpeed, Meaning

BACKGROUND = True
GAP = 1.2 * FIRST_GAP  # s
PAUSE = 1.5 * STREAM_TIMEOUT  # s; shorter than FIRST_GAP
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


def test_delayed_messages_that_arrive_together_move_nothing():
    assert MOVE not in meanings([0.0, *(1.0 + 0.0005 * number for number in range(60))])


class JogWithTwists(Jog):
    """A Jog on a clock of its own. Notes the speeds that it would publish."""

    def __init__(self):
        self.now, self.twists = 0.0, []
        super().__init__(MagicMock(), MagicMock(), lambda: self.now)
        self._publisher.get_subscription_count.return_value = 1

    def hold_for(self, duration, *tabs):
        """Each of `tabs` holds a button for `duration` s. Returns the speeds that are published, and the last reason of each tab."""
        first, reasons = len(self.twists), {}
        for _ in range(round(duration * HOLD_RATE)):
            self.now += 1 / HOLD_RATE
            for tab in tabs:
                reasons[tab] = self.hold(tab, 2, 1.0, Frame.BASE, JogSpeed())
        return self.twists[first:], [reasons[tab] for tab in tabs]

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
    jog.release("tab")
    first, *others = jog.hold_for(0.2, "tab")[0]
    assert first == 0.0 and others and all(others)


@pytest.mark.parametrize("gap", [PAUSE, GAP])
def test_a_pause_of_the_messages_ends_the_hold_until_the_button_is_released(jog, gap):
    """A stop from elsewhere may have ended the motion in the pause. A zero twist would let the driver begin it again."""
    jog.now += gap
    for _ in range(3):
        assert jog.hold_for(0.5, "tab") == ([], [STOPPED])
    jog.release("tab")
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
    jog.release("tab")
    assert jog.hold_for(0.5, "second") == ([], [STOPPED])
    jog.release("second")
    assert any(jog.hold_for(0.5, "second")[0])


def test_a_tab_moves_the_arm_after_a_pause_in_the_hold_of_another_one(jog):
    jog.now += PAUSE
    assert any(jog.hold_for(0.5, "second")[0])
    jog.release("second")
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
    jog.release("tab")
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
    jog.release("tab")
    jog.now += GAP
    assert jog.hold_for(0.5, "second") == ([], [STOPPED])
    assert any(jog.hold_for(0.5, "tab")[0])


def test_a_tab_that_is_closed_leaves_nothing_stopped(jog):
    jog.stop()
    jog.release("tab")  # as its panel does
    assert any(jog.hold_for(0.5, "reloaded")[0])


def test_a_button_that_is_pressed_after_stop_jogs(jog):
    jog.release("tab")
    jog.stop()
    assert any(jog.hold_for(0.5, "tab")[0])
