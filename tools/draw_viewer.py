#!/usr/bin/env python3
"""Draws the viewer during the demo: docs/images/viewer.png, and the animation docs/images/viewer_demo.png (APNG).

    ./ur build
    .ur/jazzy/venv/bin/python tools/draw_viewer.py

The simulated time passes slowly, because the scene is rendered without a GPU.
"""

import argparse
import io
import os
import pathlib
import sys
import time

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent), str(pathlib.Path(__file__).resolve().parents[1] / "demo")]
from control_port import ControlPort  # noqa: E402
from ur_tools import browser, console, simulation  # noqa: E402
from ur_tools.environment import program, run_environment  # noqa: E402
from ur_tools.layout import ROOT, Layout  # noqa: E402
from ur_tools.processes import Programs  # noqa: E402

ADDRESS, PORT = "127.0.0.1", 8180
LIMIT = 300.0  # s, of an operation in the browser
SLOW = ("silence_limit:=10.0", "rtde_frequency:=125.0"), ("silence_limit:=10.0", "watchdog_frequency:=1.0"), ()
DROP = 0.3  # m, height of the tool above the table
PUSHES = ((0.8, [30.0, 0.0, 0.0, 0.0, 0.0, 0.0]), (1.8, [0.0, 30.0, 0.0, 0.0, 0.0, 0.0]))  # s after the start, N and N m
MOVING, AT_REST = 0.002, 1.0  # rad/s, s
COLORS = 128  # of the animation
LARGEST = 3_000_000  # bytes


def start(programs, layout, options):
    env = run_environment(layout)
    simulation.start_simulator(programs, layout, env, ADDRESS, "ur10e", "--real-time-factor", str(options.real_time_factor))
    for node, parameters in zip(simulation.NODES, SLOW):
        simulation.start_node(programs, layout, env, node, ADDRESS, *parameters)
    viewer = programs.start("viewer", [program(layout, "ur_ros_rtde_viewer", "view"), "--control", "--model", "ur10e", "--simulator",
                                       ADDRESS, "--port", str(PORT), "--rate", "4"], env)
    programs.wait_until(lambda: "runs at" in viewer.output, LIMIT, "the viewer")
    return env


def open_page(playwright, width, height, scale):
    page = browser.launch(playwright, LIMIT).new_page(viewport={"width": width, "height": height}, device_scale_factor=scale)
    page.set_default_timeout(1e3 * LIMIT)
    page.goto(f"http://127.0.0.1:{PORT}/?fixedDpr={scale}")
    page.get_by_role("button", name="STOP", exact=True).wait_for()
    close = page.locator(".mantine-Notification-closeButton")  # the warning about software rendering
    if close.count():
        close.first.evaluate("button => button.click()")  # does not wait for the end of its animation
    return page


def picture(page):
    from PIL import Image

    return Image.open(io.BytesIO(page.screenshot(animations="disabled"))).convert("RGB")


def film(page, control, options):
    """Returns pictures at about equal intervals of the robot's time, until the arm has been at rest on the table for a second."""
    frames: list = []
    pushes = list(PUSHES)
    started = moved = drawn = None  # robot's time of the first and the last motion, and of the last picture
    while len(frames) < options.frames:
        state = control.request("state")["state"]
        now = state["timestamp"]
        if max(map(abs, state["actual"]["velocity"])) > MOVING:
            started, moved = started or now, now
        if started and now - moved > AT_REST:
            break
        if started and pushes and now - started > pushes[0][0]:
            control.request("push", wrench=pushes.pop(0)[1], duration=0.4, frame="tool")
        if started and (drawn is None or now - drawn >= options.interval):
            drawn = now
            frames.append(picture(page))
        else:
            time.sleep(0.02)
    return frames


def write(frames, options):
    from PIL import Image

    options.folder.mkdir(parents=True, exist_ok=True)
    frames[-1].save(options.folder / "viewer.png", optimize=True)
    small = [frame.resize((options.width, options.height * options.width // options.page_width), Image.LANCZOS).quantize(COLORS)
             for frame in frames]
    file = options.folder / "viewer_demo.png"
    small[0].save(file, save_all=True, append_images=small[1:], duration=int(1e3 * options.interval), loop=0, optimize=True)
    if file.stat().st_size > LARGEST:
        raise console.Failure(f"{file} has {file.stat().st_size / 1e6:.1f} MB, more than 3 MB: use a larger --interval or a smaller "
                              "--width")


def run(options):
    layout = Layout.of_environment()
    os.environ.update(browser.environment(layout))
    if browser.VARIABLE not in os.environ:
        return 1
    from playwright.sync_api import sync_playwright

    with Programs(layout.log / "draw_viewer") as programs, sync_playwright() as playwright:
        env = start(programs, layout, options)
        page = open_page(playwright, options.page_width, options.height, 1)
        with ControlPort(ADDRESS) as control:
            table = control.request("state")["state"]["actual_tcp_pose"][2] - DROP
            control.request("place_surface", point=[0.0, 0.0, table], normal=[0.0, 0.0, 1.0], stiffness=15000.0, damping=80.0)
            programs.start("goal", [str(program(layout, "ur_ros_rtde_cli", "ur")), "call", "move_down_until_force", "{force: 20.0}",
                                    "--wait", "60"], env)
            write(film(page, control, options), options)
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--folder", type=pathlib.Path, default=ROOT / "docs" / "images")
    parser.add_argument("--page-width", type=int, default=1280, help="width of the page, pixels")
    parser.add_argument("--height", type=int, default=880, help="height of the page, pixels")
    parser.add_argument("--width", type=int, default=800, help="width of the animation, pixels")
    parser.add_argument("--interval", type=float, default=0.25, help="between pictures, s of the robot's time")
    parser.add_argument("--frames", type=int, default=60, help="largest number of pictures")
    parser.add_argument("--real-time-factor", type=float, default=0.15, help="of the simulator")
    options = parser.parse_args()
    try:
        return run(options)
    except console.Failure as failure:
        console.line(str(failure))
        return 1


if __name__ == "__main__":
    sys.exit(main())
