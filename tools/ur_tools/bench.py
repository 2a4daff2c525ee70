"""./ur bench: measures latency, load and start-up of the driver on the simulated controller, and compares them with targets.

A ratio below 1 is better than the target. Measure on an idle machine (docs/internals/performance.md).
"""

import argparse
import pathlib
import statistics
import sys
import time
from typing import List

from . import (
    bench_compare,
    bench_discovery,
    bench_machine,
    bench_recovery,
    bench_report,
    bench_results,
    bench_rows,
    bench_scale,
    bench_servers,
    bench_session,
    bench_simulator,
    bench_stress,
    bench_trace,
    bench_trajectory,
    bench_viewer,
    console,
    ports,
    simulation,
)
from .bench_results import Results
from .layout import PROGRAM, Layout

# Clients that are killed, and clients that then search for the actions.
KILLED_CLIENTS, NEW_CLIENTS = 20, 100
# Options that change what is measured, or how.
SETTINGS = ("model", "repeat", "stream", "real_time_factor", "seconds", "let_sleep", "realtime_priority", "scale", "goals", "robots",
            "stress", "simulator", "count", "hours", "recovery", "viewer", "servers")
# What is measured instead of the default rows.
SEPARATE = {"scale": bench_scale, "stress": bench_stress, "simulator": bench_simulator, "recovery": bench_recovery, "viewer": bench_viewer,
            "servers": bench_servers}
MODES = ("stream", "trajectory", "trace", *SEPARATE)


def _add_result_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("results")
    group.add_argument("--runs", type=int, default=1, metavar="N",
                       help="measure N times; medians are printed (default: 1; a comparison needs 3)")
    group.add_argument("--output", type=pathlib.Path, metavar="FILE", help="write all runs, with a description of the machine, as JSON")
    group.add_argument("--append", action="store_true",
                       help="with --output: add the runs to those in FILE, so that two versions can be measured in turns")
    group.add_argument("--input", type=pathlib.Path, metavar="FILE", help="use the runs in FILE, measure nothing")
    group.add_argument("--compare", type=pathlib.Path, metavar="FILE",
                       help="compare with the runs in FILE: medians, ranges, ratios, and which changes are beyond the noise")
    group.add_argument("--report", type=pathlib.Path, metavar="PATH",
                       help=f"draw the results as one HTML page: a file that ends in .html, or a folder for {bench_report.FILE}")


def _add_stream_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("servo stream")
    group.add_argument("--stream", action="store_true", help="measure only the servo stream")
    group.add_argument("--real-time-factor", type=float, default=1.0, metavar="F",
                       help="with --stream: let the robot's time pass F times as fast. The figures of the stream are in the robot's time; "
                            "F below 1 reduces the influence of the host's latency (default: 1)")
    group.add_argument("--seconds", type=float, default=10.0, metavar="S", help="duration of the servo stream (default: 10)")
    group.add_argument("--let-sleep", action="store_true",
                       help="let the cores sleep while the servo stream is measured with real-time priority; use this on a virtual "
                            "machine with steal time, where busy loops cost more than they gain")
    group.add_argument("--realtime-priority", type=int, default=40, metavar="P",
                       help="measure the servo stream a second time with the node's parameter realtime_priority set to P and the "
                            "simulator under SCHED_FIFO, if the host permits it (default: 40)")


def parse(arguments: List[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog=f"{PROGRAM} bench", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--address", default="127.0.0.1", help="loopback address of the simulator (default: 127.0.0.1)")
    parser.add_argument("--model", default="ur10e", help="arm to simulate (default: ur10e)")
    parser.add_argument("--repeat", type=int, default=40, metavar="N",
                        help="goals, cancel requests or interruptions to measure (default: 40)")
    _add_result_options(parser)
    for add_options in (_add_stream_options, bench_scale.add_options, bench_stress.add_options, bench_trace.add_options,
                        bench_trajectory.add_options, bench_simulator.add_options, bench_recovery.add_options,
                        bench_viewer.add_options, bench_servers.add_options):
        add_options(parser)
    options = parser.parse_args(arguments)
    _check_combination(parser, options)
    return options


def _check_combination(parser: argparse.ArgumentParser, options: argparse.Namespace) -> None:
    modes = [f"--{mode}" for mode in MODES if getattr(options, mode)]
    if len(modes) > 1:
        parser.error(f"{' and '.join(modes)} exclude each other")
    if options.real_time_factor != 1.0 and not options.stream:
        parser.error("--real-time-factor needs --stream: all other figures are in the host's time")
    if options.runs < 1:
        parser.error("--runs must be at least 1")
    if options.append and not options.output:
        parser.error("--append needs --output")
    if options.input and (options.output or options.runs > 1 or modes):
        parser.error("--input measures nothing: it excludes --output, --runs and what to measure")
    for mode in ("trajectory", "trace"):
        if getattr(options, mode) and (options.output or options.compare or options.report):
            parser.error(f"--{mode} has no rows to save or to compare")


def check(options: argparse.Namespace) -> None:
    """Raises Failure if a file cannot be used or an address is in use."""
    for option in ("input", "compare"):
        if getattr(options, option):
            bench_results.load(getattr(options, option), f"--{option}")
    if options.output:
        bench_results.check_writable(options.output, "--output")
        if options.output.exists() and options.append:
            bench_results.load(options.output, "--output")
    if options.report:
        bench_report.check(options.report)
    if options.scale:
        bench_scale.check(options)
    elif options.simulator:
        bench_simulator.check(options)
    elif not options.input:
        ports.check(options.address)


def _measure_default(layout: Layout, options: argparse.Namespace) -> "tuple[dict, dict]":
    console.step("Measuring state and goals, for about 45 s")
    figures, samples = bench_session.measure(layout, options)
    console.step("Measuring discovery, for about a minute")
    figures["new client finds all actions"] = bench_discovery.measure(layout, options.address, KILLED_CLIENTS, NEW_CLIENTS)
    streams, answers = bench_session.measure_streams(layout, options, bench_rows.STREAMS)
    return {**figures, **streams}, {**samples, **answers}


def _measure(layout: Layout, options: argparse.Namespace) -> "tuple[dict, dict]":
    if options.stream:
        return bench_session.measure_streams(layout, options, bench_rows.STREAMS)
    for name, module in SEPARATE.items():
        if getattr(options, name):
            return module.measure(layout, options)
    return _measure_default(layout, options)


def _run_once(layout: Layout, options: argparse.Namespace) -> dict:
    begin, load = time.time(), bench_machine.LoadMeter()
    figures, samples = _measure(layout, options)
    return {"begin": begin, "load": load.result(), "figures": figures, "samples": samples}


def _measured(layout: Layout, options: argparse.Namespace) -> Results:
    """Measures, and writes the results after each run. Returns them with the earlier runs in the file, if appended."""
    results = Results(bench_machine.describe(layout), bench_machine.commit(),
                      {name: getattr(options, name) for name in SETTINGS}, [])
    results.settings["robots"] = list(options.robots)  # as JSON has it
    if options.append and options.output.exists():
        earlier = bench_results.load(options.output, "--output")
        bench_results.check_same(earlier, results, options.output)
        results.runs = earlier.runs
    for number in range(options.runs):
        if options.runs > 1:
            console.step(f"Run {number + 1} of {options.runs}")
        results.runs.append(_run_once(layout, options))
        if options.output:
            bench_results.save(options.output, results)
    return results


def _print(results: Results) -> None:
    console.line(f"{'':34} {'':16} {'measured':>10} {'target':>8}  ratio")
    for row in bench_rows.ROWS:
        found = bench_rows.values(results.runs, row)
        head = f"{row.name:34} {row.part or '':16}"
        if found:
            value = statistics.median(found)
            target, ratio = ("", "") if row.target is None else (f"{row.target:g}", f"{value / row.target:.2f}")
            console.line(f"{head} {value:10.3f} {target:>8}  {ratio:>5}  {row.unit}")
        elif bench_rows.failed(results.runs, row):
            console.line(f"{head} nothing measured")
    loads = [run.get("load", {}) for run in results.runs]
    highest = {name: max(load.get(name, 0.0) for load in loads) for name in loads[-1]}
    console.line(f"Beside the measurement, at most: {', '.join(f'{name} {value:.2f}' for name, value in highest.items())}")


def run(options: argparse.Namespace, layout: Layout) -> int:
    if options.trajectory:
        return bench_trajectory.run(options, layout)
    if options.trace:
        return bench_trace.run(options, layout)
    results = bench_results.load(options.input, "--input") if options.input else _measured(layout, options)
    old = bench_results.load(options.compare, "--compare") if options.compare else None
    _print(results)
    if old:
        bench_compare.show(old, results)
    if options.report:
        bench_report.write(options.report, layout, results, old)
    return 0


if __name__ == "__main__":
    sys.exit(simulation.main(parse, run, check))
