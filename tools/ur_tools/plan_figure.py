"""Draws a plan of plan_trajectory: positions, velocities, accelerations and jerks of the joints against their limits."""

import json
import sys

import matplotlib

matplotlib.use("Agg")  # before pyplot is imported
import matplotlib.pyplot as plt

JOINTS = ("shoulder pan", "shoulder lift", "elbow", "wrist 1", "wrist 2", "wrist 3")
COLORS = ("#1f77b4", "#ff7f0e", "#2ca02c", "#8c564b", "#9467bd", "#17becf")
QUANTITIES = (("position", "rad"), ("velocity", "rad/s"), ("acceleration", "rad/s²"), ("jerk", "rad/s³"))
MOST_MARKS = 60  # more waypoints are not marked


def _limits(limits, quantity, joint):
    if quantity == "position":
        return limits["position_min"][joint], limits["position_max"][joint]
    limit = limits[quantity][joint]
    return (None, None) if limit is None else (-limit, limit)


def _draw(axes, plan, quantity, unit):
    """Draws one quantity. Limits are drawn, dashed, only near the curves: distant ones would flatten the plot."""
    time, values = plan["samples"]["time"], plan["samples"][quantity]
    for joint, (name, color) in enumerate(zip(JOINTS, COLORS)):
        axes.plot(time, [row[joint] for row in values], color=color, linewidth=1.1, label=name)
    largest = max(max(map(abs, row)) for row in values) or 1.0
    for limit in {limit for joint in range(6) for limit in _limits(plan["limits"], quantity, joint)}:
        if limit is not None and abs(limit) < 1.5 * largest:
            axes.axhline(limit, color="tab:red", linewidth=0.8, linestyle="--")
    if len(plan["waypoint_times"]) <= MOST_MARKS:
        for mark in plan["waypoint_times"]:
            axes.axvline(mark, color="#cccccc", linewidth=0.6, zorder=0)
    axes.set_ylabel(f"{quantity} [{unit}]")
    axes.margins(x=0.0)


def draw(plan, path):
    figure, all_axes = plt.subplots(4, 1, figsize=(9.0, 10.0), sharex=True)
    for axes, (quantity, unit) in zip(all_axes, QUANTITIES):
        _draw(axes, plan, quantity, unit)
    all_axes[0].legend(ncol=6, fontsize=8, loc="upper center", bbox_to_anchor=(0.5, 1.25), frameon=False)
    all_axes[-1].set_xlabel("time [s]; grey: waypoints, red: limits")
    figure.tight_layout()
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    try:
        draw(json.load(sys.stdin), sys.argv[1])
    except OSError as error:
        sys.exit(f"{sys.argv[1]} cannot be written: {error.strerror}")
