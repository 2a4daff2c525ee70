"""A viewer in a thread of the test, and a browser that shows its page."""

import contextlib
import os
import threading

import numpy as np
import pytest
from arm_state import AT_REST
from support import wait_for

LIMIT = 90.0  # s, of an operation in the browser on a busy machine
ARGUMENTS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",
             "--disable-gpu-compositing"]
WINDOW = {"width": 1300, "height": 1000}
COARSE = "?fixedDpr=0.1"  # scene pixels per screen pixel: software rendering is slow


class RunningViewer:
    def __init__(self, *arguments, port=0):
        from ur_ros_rtde_viewer.page.server import start_server
        from ur_ros_rtde_viewer.program import parse
        from ur_ros_rtde_viewer.ros.nodes import Nodes
        from ur_ros_rtde_viewer.viewer import Viewer

        options = parse(["--model", "ur10e", "--rate", "5", "--port", str(port), *arguments])
        self.server = start_server("127.0.0.1", port)
        self.port = self.server.get_port()
        self.nodes = Nodes()
        self.viewer = Viewer(self.server, self.nodes, options)
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self.viewer.run, args=(self._ended.is_set,))
        self._thread.start()

    @property
    def url(self):
        return f"http://127.0.0.1:{self.port}/{COARSE}"

    def close(self):
        self._ended.set()
        self._thread.join(LIMIT)
        self.viewer.close()
        self.nodes.close()
        self.server.stop()


@contextlib.contextmanager
def chromium():
    """A headless Chromium. Skips the tests if `./ur test` found none."""
    if "UR_BROWSER" not in os.environ:
        pytest.skip(os.environ.get("UR_BROWSER_MISSING", "UR_BROWSER is not set: run the tests with ./ur test"))
    from playwright.sync_api import sync_playwright

    env = {name: value for name, value in os.environ.items() if name != "LD_LIBRARY_PATH"}
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=os.environ["UR_BROWSER"], args=ARGUMENTS, timeout=1e3 * LIMIT,
                                             env={**env, "LD_LIBRARY_PATH": os.environ.get("UR_BROWSER_LIBRARIES", "")})
        yield browser
        browser.close()


class Tab:
    """A tab of the browser with the page of a viewer."""

    def __init__(self, browser, url, window=WINDOW):
        self.page = browser.new_page(viewport=window)
        self.page.set_default_timeout(1e3 * LIMIT)
        self.page.goto(url)
        self.button("STOP").wait_for()

    def button(self, name):
        return self.page.get_by_role("button", name=name, exact=True).locator("visible=true")

    def open(self, name):
        """Selects a tab of the robot."""
        self.page.get_by_role("tab", name=name, exact=True).click()

    def field(self, label):
        """Returns the input in the row of this label."""
        row = self.page.locator(".mantine-Flex-root", has=self.page.get_by_text(label, exact=True))
        return row.locator("input:visible, textarea:visible")

    def select_action(self, name):
        self.open("Commands")
        action = self.field("Action")
        action.click()
        action.fill(name)
        self.page.get_by_role("option", name=name, exact=True).click()
        self.page.locator("label, legend, div, span").get_by_text(name, exact=True).locator("visible=true").first.wait_for()

    def wait_for_text(self, text):
        self.page.get_by_text(text).locator("visible=true").first.wait_for()

    @contextlib.contextmanager
    def held(self, name):
        """Holds a button."""
        button = self.button(name)
        button.scroll_into_view_if_needed()
        box = button.bounding_box()
        self.page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
        self.page.mouse.down()
        try:
            yield
        finally:
            if not self.page.is_closed():
                self.page.mouse.up()

    def pose(self, path, root):
        """Returns the pose of a scene node in another one as a 4x4 matrix, as it was drawn last. None if a node does not exist."""
        drawn = self.page.evaluate("names => names.map(name => window.__viserMutable.nodeRefFromName[name]?.matrixWorld?.elements)",
                                   [path, root])
        if None in drawn:
            return None
        node, origin = (np.reshape(elements, (4, 4), order="F") for elements in drawn)
        return np.linalg.inv(origin) @ node

    def on_screen(self, path, point):
        """Returns where a point of a scene node was drawn last, in pixels of the page."""
        return self.page.evaluate("""([name, point]) => {
            const {canvas, camera, nodeRefFromName} = window.__viserMutable, box = canvas.getBoundingClientRect();
            const drawn = camera.position.clone().set(...point).applyMatrix4(nodeRefFromName[name].matrixWorld).project(camera);
            return [box.left + 0.5 * (1 + drawn.x) * box.width, box.top + 0.5 * (1 - drawn.y) * box.height];
        }""", [path, [float(value) for value in point]])

    def drag(self, begin, end, steps=8):
        """Drags with the left mouse button."""
        self.page.mouse.move(*begin)
        self.page.mouse.down()
        self.page.mouse.move(*end, steps=steps)
        self.page.mouse.up()

    def plots(self):
        """Returns for each plot its title, its legend, its time range, the oldest time in s, and for the last visible curve the
        fraction of the width in which its color is drawn."""
        return self.page.evaluate("""() => Object.values(window.__viserTestpoints.uplots).map(({chart}) => {
            const {left, top, width, height} = chart.bbox, color = chart.series.at(-2).stroke();
            const wanted = [1, 3, 5].map(at => parseInt(color.slice(at, at + 2), 16));
            const {data} = chart.ctx.getImageData(left, top, width, height);
            const columns = new Set();
            for (let at = 0; at < data.length; at += 4)
                if (data[at + 3] > 128 && wanted.every((value, part) => Math.abs(value - data[at + part]) < 40))
                    columns.add(at / 4 % width);
            return {title: chart.root.querySelector(".u-title").textContent, oldest: chart.data[0][0],
                    legend: [...chart.root.querySelectorAll(".u-label")].map(label => label.textContent),
                    range: [chart.scales.x.min, chart.scales.x.max], drawn: columns.size / width};
        })""")

    def close(self):
        self.page.close()


def until(condition, what, limit=LIMIT):
    return wait_for(condition, limit, what)


def is_moving(simulator):
    return max(map(abs, simulator.state()["actual"]["velocity"])) > AT_REST
