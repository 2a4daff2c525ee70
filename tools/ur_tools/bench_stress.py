"""./ur bench --stress: latency and lost packages while other programs use the processor or subscribe to the topics."""

import argparse
import os
import sys
from typing import Dict, List

from . import bench_session, console
from .bench_rows import CONDITIONS, QOS, STRESSED_STREAMS, stress_name
from .layout import ROOT, Layout

BUSY_LOOP = (sys.executable, "-c", "while True: pass")
SUBSCRIBERS = {"Python subscriber": 1, "20 subscribers": 20}  # of joint_states, by condition
FOREVER = "600"  # s, the longest time of the subscriber


def add_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("busy host")
    group.add_argument("--stress", action="store_true",
                       help="only measure the latency, and the servo stream, while other programs use the processor or subscribe to "
                            "the topics (about 3 min)")


def _beside(layout: Layout) -> Dict[str, List["tuple[str, ...]"]]:
    """Returns the commands to run beside the driver in each condition."""
    everything = (str(layout.python), str(ROOT / "bench" / "subscribe_everything.py"))
    return {"alone": [], "cpu load": busy_loops(), "Python subscriber": [everything],
            "20 subscribers": [(bench_session.subscriber(layout), FOREVER)] * SUBSCRIBERS["20 subscribers"]}


def busy_loops() -> List["tuple[str, ...]"]:
    return [BUSY_LOOP] * len(os.sched_getaffinity(0))


def measure_condition(layout: Layout, options: argparse.Namespace, condition: str) -> "tuple[dict, dict]":
    """Returns figures and samples by quality of service."""
    with bench_session.running(layout, options) as (programs, _pids, _ready):
        for number, command in enumerate(_beside(layout)[condition]):
            programs.start(f"beside_{number}", command, bench_session.environment(layout))
        arguments = ["--address", options.address, "--subscriber", bench_session.subscriber(layout), "--subscribers",
                     str(SUBSCRIBERS.get(condition, 0))]
        found = bench_session.run_script(programs, layout, options, "measure_stress.py", arguments, 120.0)
    return found["figures"], found["samples"]


def measure(layout: Layout, options: argparse.Namespace) -> "tuple[dict, dict]":
    """Returns figures and samples."""
    figures, samples = {}, {}
    for condition, what in CONDITIONS.items():
        console.step(f"Measuring the latency beside {what}")
        found, points = measure_condition(layout, options, condition)
        for qos in QOS:
            figures[stress_name(condition, qos)], samples[stress_name(condition, qos)] = found[qos], points[qos]
    streams, answers = bench_session.measure_streams(layout, options, STRESSED_STREAMS, tuple(busy_loops()))
    return {**figures, **streams}, {**samples, **answers}
