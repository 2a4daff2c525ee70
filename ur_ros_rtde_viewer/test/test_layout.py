"""The page in small windows: STOP, state and plots can be seen and used, also while notifications are shown."""

import contextlib
import threading

import pytest
from running_viewer import LIMIT, RunningViewer, Tab, until
from ur_ros_rtde_viewer.panels.plots_panel import PLOTS

BROWSER = True
SMALL, LAPTOP, PHONE = (1000, 640), (1280, 800), (390, 844)  # pixels
TABS = ("State", "Record", "Commands", "Jog", "Target", "Twin")
NOTIFICATIONS = 6
NOTIFICATION = ".mantine-Notification-root"

# Whether an element is within the window, up to a rounded pixel, and on top of all others: at its center and near its corners.
IS_ON_TOP = """element => {
    const {left, top, right, bottom} = element.getBoundingClientRect();
    if (left < -1 || top < -1 || right > innerWidth + 1 || bottom > innerHeight + 1) return false;
    return [[0.5, 0.5], [0.1, 0.1], [0.9, 0.1], [0.1, 0.9], [0.9, 0.9]].every(([x, y]) =>
        element.contains(document.elementFromPoint(left + x * (right - left), top + y * (bottom - top))));
}"""

SCENE_WIDTH = "() => window.__viserMutable.canvas.getBoundingClientRect().width"


@pytest.fixture(scope="module")
def viewer():
    started = RunningViewer("--control")
    yield started
    started.close()


@contextlib.contextmanager
def opened(browser, viewer, size):
    """The page in a window of this size, after its layout has settled, with notifications."""
    width, height = size
    others = set(viewer.server.get_clients())
    tab = Tab(browser, viewer.url, {"width": width, "height": height})
    try:
        until(lambda: set(viewer.server.get_clients()) > others, "the client")
        client, = (client for number, client in viewer.server.get_clients().items() if number not in others)
        for number in range(NOTIFICATIONS):
            client.add_notification(f"Notification {number}", "This text needs several lines. " * 4)
        until(lambda: tab.page.locator(NOTIFICATION).count() >= NOTIFICATIONS, "the notifications")
        yield tab
    finally:
        tab.close()
        until(lambda: set(viewer.server.get_clients()) <= others, "the end of the client")


def becomes_on_top(locator, what, scrolls=False):
    def is_on_top():
        if scrolls:
            locator.scroll_into_view_if_needed()
        return locator.evaluate(IS_ON_TOP)

    until(is_on_top, what, 20.0)


def has_wide_scene(tab):
    until(lambda: tab.page.evaluate(SCENE_WIDTH) >= 500, "a scene of 500 pixels", 20.0)


def plots(tab):
    return tab.page.locator(".uplot-container:visible")


def open_plots(tab, size):
    """Opens the plots where they are minimized at first."""
    if size == PHONE:
        tab.page.get_by_role("button", name="Expand panel Plots").click()
    elif size == SMALL:
        has_wide_scene(tab)  # the plots have been minimized
        tab.open("Plots")
    until(lambda: plots(tab).count() == len(PLOTS), "the plots")


@pytest.fixture(scope="module", params=[SMALL, LAPTOP, PHONE], ids=["small", "laptop", "phone"])
def page(request, browser, viewer):
    """The size of a window, and the page in it. The tests of a page run in their order: the last one opens the plots."""
    with opened(browser, viewer, request.param) as tab:
        yield request.param, tab


def test_the_state_is_in_the_window(page):
    _, tab = page
    becomes_on_top(tab.page.get_by_text("Robot mode", exact=True), "the state")


def test_stop_and_the_tabs_are_in_the_window_and_nothing_covers_them(page):
    _, tab = page
    for name in TABS:
        tab.open(name)
        becomes_on_top(tab.page.get_by_role("tab", name=name, exact=True), f"the tab {name}")
        becomes_on_top(tab.button("STOP"), f"STOP beside the tab {name}")


def test_the_scene_is_wide_enough(page):
    size, tab = page
    if size != PHONE:
        has_wide_scene(tab)


def test_a_tap_on_the_title_of_a_phone_does_not_disable_stop(page, viewer, monkeypatch):
    size, tab = page
    if size != PHONE:
        return
    pressed = threading.Event()
    monkeypatch.setattr(viewer.viewer.control, "stop", pressed.set)
    title = tab.page.get_by_text("ur_ros_rtde", exact=True).locator("visible=true").first.bounding_box()
    tab.page.mouse.click(title["x"] + 0.5 * title["width"], title["y"] + 0.5 * title["height"])
    tab.open("Jog")
    tab.button("STOP").click()
    assert pressed.wait(LIMIT)


def test_plots_can_be_seen(page):
    size, tab = page
    open_plots(tab, size)
    for plot in plots(tab).all():
        if size == LAPTOP:
            becomes_on_top(plot, "the plot")
        else:  # again if the layout changes after the first time
            becomes_on_top(plot, "the plot", scrolls=True)
    becomes_on_top(tab.button("STOP"), "STOP beside the plots")
