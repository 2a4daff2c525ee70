"""./ur bench --viewer: load of the viewer and of a browser that shows its page, and latency of the driver without and with them.

The arm moves back and forth. All conditions are measured in each run: --runs N measures them in turns. Without a GPU, a browser on the same
machine competes with the driver for the processor; the condition without it shows what the viewer alone changes.
"""

import argparse
from typing import List, Sequence

from . import bench_session, browser, console, viewer
from .bench_rows import QOS, VIEWER_CONDITIONS, stress_name
from .layout import ROOT, Layout
from .processes import Programs

PAGE_TIMEOUT = 120.0  # s


def add_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("viewer")
    group.add_argument("--viewer", action="store_true",
                       help="only measure the load of the viewer and of a browser with its page, and the latency of the driver without "
                            "and with them, while the arm moves (about 1.5 min)")


def _start(programs: Programs, layout: Layout, beside: Sequence[str]) -> List[str]:
    """Starts the viewer and, where there is one, a browser. Returns the arguments that have their load measured."""
    env = bench_session.environment(layout)
    if "viewer" not in beside:
        return []
    page = viewer.start(programs, layout, env, "--control", "--port", "0")
    measured = ["--load", f"viewer={page.process.pid}"]
    found = browser.environment(layout) if "browser" in beside else {}
    if browser.VARIABLE in found:
        command = [str(layout.python), str(ROOT / "bench" / "open_page.py"), viewer.address(page)]
        shown = programs.start("browser", command, {**env, **found})
        programs.wait_until(lambda: "The page is open." in shown.output, PAGE_TIMEOUT, "the page")
        measured += ["--load", f"browser={shown.process.pid}"]
    return measured


def measure_condition(layout: Layout, options: argparse.Namespace, beside: Sequence[str]) -> dict:
    """Returns figures and samples by quality of service, and the load of viewer and browser."""
    with bench_session.running(layout, options) as (programs, _pids, _ready):
        programs.start("motion", [str(layout.python), str(ROOT / "bench" / "keep_moving.py")], bench_session.environment(layout))
        arguments = ["--address", options.address, "--subscriber", bench_session.subscriber(layout), "--subscribers", "0"]
        arguments += _start(programs, layout, beside)
        return bench_session.run_script(programs, layout, options, "measure_stress.py", arguments, 120.0)


def measure(layout: Layout, options: argparse.Namespace) -> "tuple[dict, dict]":
    """Returns figures and samples."""
    viewer.prepare(layout)
    figures, samples = {}, {}
    for condition, beside in VIEWER_CONDITIONS.items():
        console.step(f"Measuring the latency {condition}")
        found = measure_condition(layout, options, beside)
        for qos in QOS:
            name = stress_name(condition, qos)
            figures[name], samples[name] = found["figures"][qos], found["samples"][qos]
        figures.update({name: {"cpu": load} for name, load in found["load"].items()})
    return figures, samples
