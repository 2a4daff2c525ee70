"""Jog on the page in a headless Chromium: held buttons, a stop during a hold, touch, several tabs."""

import contextlib

import pytest
from programs import start_node
from running_viewer import Tab, is_moving, until
from ur_ros_rtde_viewer.control.jog import STOPPED, TWO_BUTTONS

from ur_ros_rtde_msgs.action import Stop

BROWSER = True
MEASURES_TIME = True
REJECTIONS = 10  # messages of a held button
STREAM_TIMEOUT = 1.0  # s; allows for the slow rendering of a browser without a GPU
SPEED, SLOW = "Speed [m/s]", "0.01"  # while a busy browser answers after seconds, the arm must not come to its limits
PAUSE_OF_THE_BROWSER = "end => { for (end += performance.now(); performance.now() < end;); }"


@pytest.fixture(scope="module")
def driver(simulator):
    driver = start_node("driver", simulator.address, "ur_type:=ur10e", f"stream_timeout:={STREAM_TIMEOUT}")
    yield driver
    driver.stop()
    print(driver.output())


def jog_of(viewer):
    return viewer[-1].viewer.control._robots[0].jog


@pytest.fixture
def rejections(viewer, monkeypatch):
    """The reasons why messages of a jog button do not move the arm, in their order."""
    jog = jog_of(viewer)
    hold, reasons = jog.hold, []

    def hold_and_note(*arguments):
        reason = hold(*arguments)
        reasons.extend([reason] if reason else [])
        return reason

    monkeypatch.setattr(jog, "hold", hold_and_note)
    return reasons


def middle_of(button):
    box = button.bounding_box()
    return {"x": box["x"] + 0.5 * box["width"], "y": box["y"] + 0.5 * box["height"]}


def test_the_page_knows_the_stream_timeout_of_the_driver(viewer):
    until(lambda: jog_of(viewer)._hold.stream_timeout == STREAM_TIMEOUT, "the parameter of the driver")


def test_jog_moves_while_a_button_is_held(tab, simulator):
    tab.open("Jog")
    with tab.held("Z +"):
        until(lambda: is_moving(simulator), "the arm to move")
    until(lambda: not is_moving(simulator), "the arm to stop")


@pytest.mark.parametrize("of_the_page", [True, False])
def test_a_held_button_does_not_undo_a_stop_after_a_pause_of_the_browser(tab, robot, simulator, rejections, of_the_page):
    tab.open("Jog")
    with tab.held("Z +"):
        until(lambda: is_moving(simulator), "the arm to move")
        tab.page.keyboard.press("Escape") if of_the_page else robot.send(Stop, "stop").succeeded()
        until(lambda: not is_moving(simulator), "the arm to stop")
        position, place = simulator.state()["actual"]["position"], middle_of(tab.button("Z +"))
        tab.page.evaluate(PAUSE_OF_THE_BROWSER, 2e3 * STREAM_TIMEOUT)
        tab.wait_for_text(STOPPED)
        assert middle_of(tab.button("Z +")) == place  # and no other button is under the pointer
        number = len(rejections) + REJECTIONS
        until(lambda: len(rejections) >= number, "further messages of the button")
        assert set(rejections) == {STOPPED} and simulator.state()["actual"]["position"] == pytest.approx(position, abs=1e-4)
    with tab.held("Z +"):
        until(lambda: is_moving(simulator), "the arm to move after the release of the button")
    until(lambda: not is_moving(simulator), "the arm to stop")


def test_a_banner_does_not_move_the_buttons(tab, simulator):
    tab.open("Jog")
    place = middle_of(tab.button("Z +"))
    simulator.control("protective_stop", reason="test")
    tab.wait_for_text("PROTECTIVE STOP: ")
    assert middle_of(tab.button("Z +")) == place


def test_a_touch_that_the_browser_cancels_releases_the_button(tab, simulator):
    tab.open("Jog")
    touch = middle_of(tab.button("Z +"))
    session = tab.page.context.new_cdp_session(tab.page)
    for _ in range(2):
        session.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [touch]})
        until(lambda: is_moving(simulator), "the arm to move")
        session.send("Input.dispatchTouchEvent", {"type": "touchCancel", "touchPoints": []})
        until(lambda: not is_moving(simulator), "the arm to stop")
    session.detach()


def test_a_second_finger_on_another_button_stops_the_arm(browser, viewer, robot, simulator):
    """In a tab of its own: browsers make no click of two fingers, so the page does not learn that these are released."""
    with contextlib.closing(Tab(browser, viewer[-1].url)) as tab:
        tab.open("Jog")
        fingers = [{**middle_of(tab.button(name)), "id": number} for number, name in enumerate(("Z +", "X +"))]
        session = tab.page.context.new_cdp_session(tab.page)
        session.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": fingers[:1]})
        until(lambda: is_moving(simulator), "the arm to move")
        session.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": fingers})
        tab.wait_for_text(TWO_BUTTONS)
        until(lambda: not is_moving(simulator), "the arm to stop")


@pytest.mark.parametrize("name", ["STOP", "Z +"])
def test_a_finger_that_moves_on_a_button_does_not_scroll_the_page(tab, name):
    tab.open("Jog")
    assert tab.button(name).evaluate("button => getComputedStyle(button).touchAction") == "none"


def test_jog_stops_when_the_tab_is_closed(browser, viewer, robot, simulator):
    second = Tab(browser, viewer[-1].url)
    second.open("Jog")
    second.field(SPEED).fill(SLOW)
    with second.held("Z +"):
        until(lambda: is_moving(simulator), "the arm to move")
        second.close()
        until(lambda: not is_moving(simulator), "the arm to stop")
    assert simulator.state()["safety_mode"] == "NORMAL"


def test_two_tabs_have_forms_of_their_own_and_only_one_jogs(browser, tab, viewer, simulator):
    with contextlib.closing(Tab(browser, viewer[-1].url)) as second:
        tab.select_action("move_j")
        second.select_action("move_j")
        tab.field("speed [rad/s]").fill("0.123")
        assert second.field("speed [rad/s]").input_value() == "0.5"
        tab.open("Jog")
        second.open("Jog")
        tab.field(SPEED).fill(SLOW)
        with tab.held("Z +"):
            until(lambda: is_moving(simulator), "the arm to move")
            with second.held("Z −"):
                second.wait_for_text("the arm is being moved from another tab")
    until(lambda: not is_moving(simulator), "the arm to stop")
