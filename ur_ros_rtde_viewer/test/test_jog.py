"""Buttons that move the TCP while they are held, and STOP during a hold, without a browser."""

from unittest.mock import MagicMock

import pytest
from ur_ros_rtde_viewer.control.jog import HOLD_RATE, LONGEST_GAP, Frame, Hold, Jog, JogSpeed, Meaning

BACKGROUND = True
STOPPED = "stopped: release the button, then hold it again"
GAP = 1.2 * LONGEST_GAP  # s


def moves(times):
    """Returns for each message of a held button, at these times in s, whether it moves the arm."""
    now = iter(times)
    hold = Hold(lambda: next(now))
    return [hold.take() is Meaning.MOVE for _ in times]


def test_a_held_button_moves_the_arm_from_its_second_message_on():
    assert moves([number / HOLD_RATE for number in range(4)]) == [False, True, True, True]
    assert moves([0.0, 0.05, 0.1]) == [False, True, True]  # a slow browser
    assert moves([0.0, 0.15, 0.3, 0.45, 0.6]) == [False, True, False, True, False]  # its pauses end the driver's motion


def test_delayed_messages_that_arrive_together_move_nothing():
    assert not any(moves([0.0, *(1.0 + 0.0005 * number for number in range(60))]))


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


def test_a_hold_begins_with_a_zero_twist_also_after_a_gap():
    jog = JogWithTwists()
    for gap in (0.0, GAP, 0.6 * LONGEST_GAP):
        jog.now += gap
        first, *others = jog.hold_for(0.2, "tab")[0]
        assert first == 0.0 and others and all(others)


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
