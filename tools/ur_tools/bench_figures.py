"""Draws the figures of a report: reads {name: samples} on stdin, writes [[title, SVG], ...] as JSON to stdout."""

import io
import itertools
import json
import re
import sys

import matplotlib

matplotlib.use("Agg")  # before pyplot is imported
import matplotlib.pyplot as plt

from .percentile import percentile

BINS = 80
MOST_POINTS = 4000  # of one curve; more make the page large
COLOURS = ("#1f77b4", "#d95f02", "#2ca02c", "#7570b3", "#8c564b", "#e7298a", "#17becf", "#666666")
_figure_numbers = itertools.count(1)


def _axes(count, height=2.6):
    figure, axes = plt.subplots(count, 1, figsize=(9.0, height * count), squeeze=False)
    return figure, [row[0] for row in axes]


def _svg(figure):
    """Returns the figure as an SVG element that can be part of an HTML page: its ids are unique among all figures."""
    figure.tight_layout()
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None})
    plt.close(figure)
    svg = text.getvalue()
    svg = svg[svg.index("<svg"):]
    prefix = f"f{next(_figure_numbers)}-"
    return re.sub(r'(\bid="|href="#|url\(#)', lambda match: match[1] + prefix, svg)


def _thinned(points):
    """Returns at most MOST_POINTS points, of each stretch the one with the largest value: outliers stay visible."""
    stride = -(-len(points) // MOST_POINTS)
    return [max(points[begin:begin + stride], key=lambda point: point[1]) for begin in range(0, len(points), stride)]


def draw_histograms(latencies, colours):
    """Draws the distribution of each latency, with its median (line) and its 99th percentile (dashed)."""
    figure, all_axes = _axes(len(latencies), 1.7)
    for axes, (name, points) in zip(all_axes, latencies.items()):
        values = [value for _, value in points]
        median, p99, most = (percentile(values, fraction) for fraction in (0.5, 0.99, 0.999))
        axes.hist(values, bins=BINS, range=(0.0, most or 1.0), color=colours[name], log=len(values) > 200)
        axes.axvline(median, color="black", linewidth=0.9)
        axes.axvline(p99, color="black", linewidth=0.9, linestyle="--")
        outside = sum(value > most for value in values)
        axes.set_title(f"{name}: p50 {median:.3f} ms, p99 {p99:.3f} ms, longest {max(values):.2f} ms; {len(values)} values"
                       + f", {outside} to the right" * bool(outside), fontsize=9, loc="left")
        axes.set_ylabel("count")
    all_axes[-1].set_xlabel("ms")
    return _svg(figure)


def draw_intervals(series, colours):
    """Draws the intervals between messages, or between setpoints, over time."""
    figure, all_axes = _axes(len(series), 1.9)
    for axes, (name, points) in zip(all_axes, series.items()):
        moments = [when for when, _ in points]
        intervals = _thinned([(end, 1e3 * (end - begin)) for begin, end in zip(moments, moments[1:])])
        axes.plot([when for when, _ in intervals], [value for _, value in intervals], ".", markersize=1.5, color=colours[name])
        axes.set_title(f"{name}: interval between arrivals", fontsize=9, loc="left")
        axes.set_ylabel("ms")
        axes.set_ylim(bottom=0.0)
        axes.margins(x=0.0)
    all_axes[-1].set_xlabel("s")
    return _svg(figure)


def draw_processes(processes, column, unit):
    """Draws one quantity of each process over time."""
    figure, (axes,) = _axes(1)
    for (name, points), colour in zip(processes.items(), COLOURS):
        axes.plot([point[0] for point in points], [point[column] for point in points], label=name, color=colour)
    axes.set_ylabel(unit)
    axes.set_xlabel("s: idle with subscribers, idle without, goals")
    axes.set_ylim(bottom=0.0)
    axes.margins(x=0.0)
    axes.legend(fontsize=8, frameon=False, ncol=4, loc="lower left", bbox_to_anchor=(0.0, 1.0))
    return _svg(figure)


def draw_many_goals(points):
    figure, (axes,) = _axes(1)
    axes.plot([number for number, _ in points], [megabytes for _, megabytes in points], color=COLOURS[0])
    axes.set_xlabel("goals")
    axes.set_ylabel("MB, resident")
    axes.set_ylim(0.0, 1.2 * max(megabytes for _, megabytes in points))
    axes.margins(x=0.0)
    return _svg(figure)


def draw(samples):
    """Returns [(title, SVG), ...]."""
    processes, goals = samples.pop("processes", {}), samples.pop("many goals", [])
    series = {name: points for name, points in samples.items() if len(points) > 1}
    colours = dict(zip(series, COLOURS * len(series)))
    timed = {name: points for name, points in series.items() if "goal" not in name and "cancel" not in name}
    found = []
    if series:
        found.append(("Latencies", draw_histograms(series, colours)))
    if timed:
        found.append(("Intervals", draw_intervals(timed, colours)))
    if any(processes.values()):
        found += [("Processor time", draw_processes(processes, 1, "% of a core")),
                  ("Memory", draw_processes(processes, 2, "MB, resident"))]
    if goals:
        found.append(("Memory over many goals", draw_many_goals(goals)))
    return found


if __name__ == "__main__":
    plt.rcParams.update({"svg.fonttype": "none", "axes.spines.top": False, "axes.spines.right": False, "font.size": 9})
    json.dump(draw(json.load(sys.stdin)), sys.stdout)
