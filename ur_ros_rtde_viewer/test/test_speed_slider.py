"""The speed slider of the State tab, without ROS: what it shows, and what it sends while it is dragged."""

from types import SimpleNamespace

import pytest
from ur_ros_rtde_viewer.control.goals import Phase, SentGoal
from ur_ros_rtde_viewer.control.speed_control import ANSWER_TIMEOUT, HOLD_TIME, SEND_PERIOD, SpeedControl
from ur_ros_rtde_viewer.panels.speed_slider import SETTLING_TIME, SpeedSlider
from ur_ros_rtde_viewer.state.robot_state import RobotState

BACKGROUND = True
PERIOD = 1.0 / 30.0  # s, of the viewer's loop


class Page:
    """A slider with a robot that reports a speed scaling, and a driver that answers when the test lets it."""

    def __init__(self, gui, is_controlled):
        self.now, self.goals = 100.0, []
        self.state = RobotState(program_running=True, speed_scaling=1.0)
        self.slider = SpeedSlider(gui, lambda function: function(), lambda: self.now)
        self.element = self.slider._element
        self.control = SpeedControl(self.slider, self, lambda: self.now) if is_controlled else None
        self.run(2.0 * SETTLING_TIME)

    def send(self, name, action, goal, on_change):
        """As Goals.send()."""
        assert name == "set_speed_slider"
        self.goals.append((self.now, round(100 * goal.fraction), SentGoal(f"/{name}", on_change)))
        return self.goals[-1][2]

    def answer(self, phase=Phase.SUCCEEDED, message=""):
        for _, _, goal in self.goals:
            if not goal.has_ended:
                goal.change(phase, message)

    def run(self, duration, answers=True):
        for _ in range(round(duration / PERIOD)):
            self.now += PERIOD
            self.slider.update(self.state)
            if self.control is not None:
                self.control.update(self.state)
            if answers:
                self.answer()

    def input(self, value):
        """As the page does when the slider is dragged, or a number is typed."""
        self.element.value = value
        for callback in self.element._impl.update_cb:
            callback(SimpleNamespace(client_id=0))

    def report(self, percent):
        self.state.speed_scaling = percent / 100


@pytest.fixture
def page(server):
    return Page(server.gui, True)


@pytest.fixture
def view_only(server):
    return Page(server.gui, False)


def test_the_value_follows_the_robot_once_it_has_settled(view_only):
    assert view_only.element.value == 100 and view_only.element.visible
    view_only.report(40)
    view_only.run(0.8 * SETTLING_TIME)
    assert view_only.element.value == 100
    view_only.run(SETTLING_TIME)
    assert view_only.element.value == 40


def test_nothing_is_shown_before_the_robot_has_reported_a_value(server):
    state = RobotState()
    slider = SpeedSlider(server.gui, lambda function: function())
    slider.update(state)
    assert not slider._element.visible


def test_the_value_stays_while_no_program_runs(view_only):
    view_only.report(40)
    view_only.run(2.0 * SETTLING_TIME)
    view_only.state.program_running = False
    view_only.report(0)
    view_only.run(2.0 * SETTLING_TIME)
    assert view_only.element.value == 40


def test_a_view_only_page_changes_nothing(view_only):
    assert view_only.element.disabled
    view_only.input(10)  # with the number beside the slider, which viser does not disable
    assert view_only.element.value == 100 and view_only.goals == []


def test_a_page_with_control_sets_the_value(page):
    assert not page.element.disabled
    page.input(35)
    page.run(PERIOD, answers=False)
    assert [percent for _, percent, _ in page.goals] == [35]


def test_a_number_outside_the_range_is_limited(page):
    page.input(250)
    page.run(SEND_PERIOD)
    page.input(-3)
    page.run(2.0 * SEND_PERIOD)
    assert [percent for _, percent, _ in page.goals] == [100, 1] and page.element.value == 1


def test_a_drag_sends_a_few_values_per_second_and_the_last_one(page):
    for percent in range(99, 39, -1):
        page.input(percent)
        page.run(PERIOD)
    page.run(2.0 * SEND_PERIOD)
    times, percents, _ = zip(*page.goals)
    assert min(after - before for before, after in zip(times, times[1:])) > 0.99 * SEND_PERIOD
    assert 6 <= len(percents) <= 10 and percents[-1] == 40


def test_the_next_value_waits_for_the_answer_to_the_previous_one(page):
    page.input(50)
    page.run(PERIOD, answers=False)
    page.input(60)
    page.run(4.0 * SEND_PERIOD, answers=False)
    assert len(page.goals) == 1
    page.run(2.0 * PERIOD)
    assert [percent for _, percent, _ in page.goals] == [50, 60]


def test_the_reported_value_does_not_move_the_slider_while_it_is_dragged(page):
    for percent in range(90, 30, -1):
        page.input(percent)
        page.report(70)
        page.run(PERIOD)
        assert page.element.value == percent
    page.report(31)
    page.run(2.0 * HOLD_TIME)
    assert page.element.value == 31
    page.report(80)
    page.run(2.0 * SETTLING_TIME)
    assert page.element.value == 80


def test_a_value_that_is_not_reported_in_the_speed_scaling_stays(page):
    """Some controllers report the speed scaling without the slider."""
    page.input(50)
    page.run(5.0)
    assert page.element.value == 50


def test_a_failure_is_explained_and_the_reported_value_returns(page):
    page.input(50)
    page.run(PERIOD, answers=False)
    page.answer(Phase.REJECTED, "no server of <set_speed_slider>")
    page.run(HOLD_TIME)
    assert page.element.value == 100
    assert page.slider.message.content == r"Not set: no server of \<set\_speed\_slider\>"
    page.input(50)
    page.run(2.0 * SEND_PERIOD)
    assert page.slider.message.content == ""


def test_a_value_that_was_reported_while_the_slider_was_held_is_shown_afterwards(page):
    page.input(50)
    page.run(0.1)
    page.report(80)  # on the pendant
    page.run(HOLD_TIME + SETTLING_TIME)
    assert page.element.value == 80


def test_a_driver_that_has_ended_is_reported_and_the_next_value_is_sent(page):
    page.input(50)
    page.run(ANSWER_TIMEOUT + 1.0, answers=False)
    assert page.slider.message.content == "Not set: the driver did not answer within 5 s" and page.element.value == 100
    page.input(60)
    page.run(2.0 * SEND_PERIOD)
    assert [percent for _, percent, _ in page.goals] == [50, 60] and page.slider.message.content == ""
