"""Scripts of the page with --control in a headless Chromium, without a robot: uploads, connections, edits, held buttons."""

import contextlib
import threading
import time

import pytest
from freezing_proxy import FreezingProxy
from running_viewer import COARSE, LIMIT, RunningViewer, Tab, until
from ur_ros_rtde_viewer.control.jog import HOLD_RATE
from ur_ros_rtde_viewer.page import uploads
from ur_ros_rtde_viewer.page.edits import PAUSE
from ur_ros_rtde_viewer.page.heartbeat import ANSWER_TIMEOUT, LOSS_TIMEOUT, NO_ANSWER, NO_CONNECTION
from ur_ros_rtde_viewer.panels.replay_panel import NO_FILE, ReplayPanel

BROWSER = True
MEASURES_TIME = True


@pytest.fixture(scope="module")
def viewer():
    started = RunningViewer("--control")
    yield started
    started.close()


@pytest.fixture(scope="module")
def tab(browser, viewer):
    return Tab(browser, viewer.url)


def choose_file(tab, name, size):
    """Chooses a file for the replay."""
    tab.page.set_input_files("input[type=file]", {"name": name, "mimeType": "text/csv", "buffer": size * b"\n"})


def test_a_large_file_is_not_uploaded_where_there_is_stop(tab, viewer):
    replay, = (panel for panel in viewer.viewer.robots[0].panels if isinstance(panel, ReplayPanel))
    tab.open("Record")
    choose_file(tab, "large.csv", uploads.MAX_BYTES + 100_000)
    tab.wait_for_text("large.csv has 1.1 MB. Where there is STOP, at most 1 MB are uploaded")
    choose_file(tab, "small.csv", uploads.MAX_BYTES)
    until(lambda: "csv" in replay.message.content, "the file")
    until(lambda: "Reading" not in replay.message.content, "the end of reading")
    assert replay.message.content.startswith("small.csv has no columns")
    assert replay._upload.value is NO_FILE, "its content is kept"
    tab.page.get_by_text("Where there is STOP").wait_for(state="hidden")


@pytest.fixture(scope="module")
def proxy(viewer):
    with contextlib.closing(FreezingProxy(viewer.port)) as proxy:
        yield proxy


@pytest.fixture(scope="module")
def remote_tab(browser, proxy):
    """A page whose connection can freeze."""
    return Tab(browser, f"http://127.0.0.1:{proxy.port}/{COARSE}")


def wait_until_hidden(tab, text):
    tab.page.get_by_text(text).wait_for(state="hidden")


NOTE_NOTICES = """() => {
  const show = window.showNotice
  window.notices = []
  window.showNotice = (name, text) => {
    if (text) window.notices.push(text)
    show(name, text)
  }
}"""


def test_no_notice_is_shown_while_the_viewer_answers(tab):
    tab.page.evaluate(NOTE_NOTICES)
    tab.button("STOP").click()
    tab.page.keyboard.press("Escape")
    tab.page.wait_for_timeout(1e3 * (LOSS_TIMEOUT + ANSWER_TIMEOUT))
    assert tab.page.evaluate("window.notices") == []


def test_no_notice_is_shown_while_the_panel_beside_the_scene_is_collapsed(tab, viewer):
    main_panel = viewer.viewer.server.gui.main_panel
    main_panel.minimize()
    tab.page.get_by_role("tab", name="State").wait_for(state="hidden")
    tab.page.evaluate(NOTE_NOTICES)
    tab.button("STOP").click()
    tab.page.wait_for_timeout(1e3 * (LOSS_TIMEOUT + ANSWER_TIMEOUT))
    main_panel.expand()
    tab.page.get_by_role("tab", name="State").wait_for()
    assert tab.page.evaluate("window.notices") == []


def test_a_connection_that_is_lost_without_a_message_is_reported(remote_tab, proxy):
    proxy.freeze()
    remote_tab.wait_for_text(NO_CONNECTION)
    assert remote_tab.button("STOP").is_enabled()  # the browser does not know
    proxy.thaw()
    wait_until_hidden(remote_tab, NO_CONNECTION)


def test_a_tab_in_the_background_reports_a_lost_connection_when_it_is_shown(remote_tab, proxy):
    remote_tab.page.evaluate("Object.defineProperty(document, 'hidden', {value: true, configurable: true})")
    proxy.freeze()
    remote_tab.page.wait_for_timeout(2e3 * LOSS_TIMEOUT)
    assert not remote_tab.page.get_by_text(NO_CONNECTION).is_visible()
    remote_tab.page.evaluate("delete document.hidden")
    remote_tab.wait_for_text(NO_CONNECTION)
    proxy.thaw()
    wait_until_hidden(remote_tab, NO_CONNECTION)


@pytest.mark.parametrize("press", [lambda tab: tab.button("STOP").click(), lambda tab: tab.page.keyboard.press("Escape")],
                         ids=["button", "key"])
def test_a_stop_that_is_not_answered_is_reported(remote_tab, proxy, press):
    proxy.to_server.clear()
    press(remote_tab)
    remote_tab.wait_for_text(NO_ANSWER)
    proxy.to_server.set()
    wait_until_hidden(remote_tab, NO_ANSWER)


# As a browser that was busy: all events together. An event is a selector and the new text, or the type of an event.
DISPATCH = """events => {
  for (const [selector, text, type] of events) {
    const element = document.querySelector(selector)
    if (type === "input") {
      Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value").set.call(element, text)
      element.dispatchEvent(new Event(type, {bubbles: true}))
    } else if (type === "keydown") {
      element.dispatchEvent(new KeyboardEvent(type, {key: "Escape", code: "Escape", bubbles: true}))
    } else {
      element.dispatchEvent(new PointerEvent(type, {bubbles: true, cancelable: true, button: 0}))
    }
  }
}"""
MARK_INPUTS = """() => {
  for (const input of document.querySelectorAll("input")) if (input.value.startsWith("before")) input.className += " " + input.value
}"""
STOP = "div:has(> .stop-style) + div button"


def typed(selector, *texts):
    return [(selector, text, "input") for text in texts]


def clicked(selector):
    return [(selector, "", "click")]


class Form:
    """Two texts, a checkbox and a button. Notes the values when the button is clicked."""

    def __init__(self, gui):
        self.taken = []
        self._elements = [gui.add_text("First", "before-1"), gui.add_text("Second", "before-2"), gui.add_checkbox("Check", False),
                          gui.add_button("Take")]
        *inputs, button = self._elements
        button.on_click(lambda _event: self.taken.append([element.value for element in inputs]))
        self.first, self.second = "input.before-1", "input.before-2"
        self.checkbox, self.button = (f'[id="{element._impl.uuid}"]' for element in self._elements[2:])

    def close(self):
        for element in self._elements:
            element.remove()


@pytest.fixture
def form(tab, viewer):
    with contextlib.closing(Form(viewer.server.gui)) as form:
        tab.page.wait_for_selector(form.button)
        tab.page.evaluate(MARK_INPUTS)
        yield form


def test_an_edit_arrives_before_the_click_that_follows_it(tab, form):
    tab.page.evaluate(DISPATCH, typed(form.first, "1", "1.57") + 2 * clicked(form.button))
    until(lambda: form.taken, "the click")
    tab.button("Take").click()
    until(lambda: len(form.taken) > 1, "the second click")
    tab.page.wait_for_timeout(3e3 * PAUSE)
    assert form.taken == 2 * [["1.57", "before-2", False]]


def test_edits_that_follow_each_other_at_once_all_arrive(tab, form):
    tab.page.evaluate(DISPATCH, typed(form.first, "1", "1.57") + typed(form.second, "2", "2.5") + clicked(form.checkbox)
                      + typed(form.first, "1.5", "1.58") + clicked(form.button))
    until(lambda: form.taken, "the click")
    assert form.taken == [["1.58", "2.5", True]]


def test_clicks_and_edits_that_follow_each_other_at_once_all_arrive(tab, form):
    tab.page.evaluate(DISPATCH, typed(form.first, "1", "1.57") + clicked(form.checkbox) + clicked(form.button) + typed(form.second, "2.5"))
    until(lambda: form.taken, "the click")
    tab.page.wait_for_timeout(3e3 * PAUSE)
    tab.button("Take").click()
    until(lambda: len(form.taken) > 1, "the second click")
    assert form.taken[1] == ["1.57", "2.5", True] and form.taken[0][0] == "1.57" and form.taken[0][2]


def test_keys_that_follow_each_other_at_once_all_arrive(tab, form):
    tab.page.locator(form.first).select_text()
    for text in ("1.57", "2.5"):
        tab.page.keyboard.type(text)
        tab.page.keyboard.press("Tab")
    tab.page.keyboard.press("Space")
    tab.button("Take").click()
    until(lambda: form.taken, "the click")
    assert form.taken == [["1.57", "2.5", True]]


@pytest.mark.parametrize("event", [(STOP, "", "click"), (STOP, "", "pointerdown"), ("body", "", "keydown")],
                         ids=["click", "pointerdown", "key"])
def test_stop_does_not_wait_for_edits_and_drops_the_clicks_that_do(tab, form, viewer, monkeypatch, event):
    stopped = threading.Event()
    monkeypatch.setattr(viewer.viewer.control, "stop", stopped.set)
    tab.page.evaluate(DISPATCH, typed(form.first, "1", "2") + typed(form.second, "3") + clicked(form.button) + [event])
    assert stopped.wait(LIMIT)
    tab.page.wait_for_timeout(3e3 * PAUSE)
    tab.page.dispatch_event(STOP, "pointerup")
    assert not form.taken
    tab.button("Take").click()
    until(lambda: form.taken, "the click after STOP")
    assert form.taken == [["2", "3", False]]


def test_the_browser_sends_as_many_messages_of_a_held_button_as_it_is_asked_for(tab, viewer, monkeypatch):
    times = []
    monkeypatch.setattr(viewer.viewer.control._robots[0].jog, "hold", lambda *_arguments: times.append(time.monotonic()))
    tab.open("Jog")
    with tab.held("Z +"):
        until(lambda: len(times) > 2.0 * HOLD_RATE, "the messages")
    periods = sorted(after - before for before, after in zip(times, times[1:]))
    print(f"longest period: {1e3 * periods[-1]:.0f} ms")
    assert periods[len(periods) // 4] == pytest.approx(1.0 / HOLD_RATE, rel=0.2)  # a busy host delays some
