"""Draws the force experiment from its CSV file: forces (top), joint velocities (bottom), ignored pushes in blue, the stop in red."""

import argparse
import csv
from dataclasses import dataclass

import matplotlib

matplotlib.use("Agg")  # before pyplot is imported
import matplotlib.pyplot as plt

FORCES = {"force_0": ("X", "#7f7f7f"), "force_1": ("Y", "#2ca02c"), "force_2": ("Z (flange axis)", "#ff7f0e")}
JOINTS = {
    "shoulder_pan": "#1f77b4",
    "shoulder_lift": "#ff7f0e",
    "elbow": "#2ca02c",
    "wrist_1": "#8c564b",
    "wrist_2": "#9467bd",
    "wrist_3": "#17becf",
}


# Columns of the file; those of the joints are named as in a recording.
POSITIONS, VELOCITIES = ([f"{output}_{index}" for index in range(len(JOINTS))] for output in ("actual_q", "actual_qd"))


def force_column(axis):
    return f"force_{'xyz'.index(axis)}"


@dataclass
class Event:
    time: float
    kind: str  # "ignored" or "stop"
    axis: str
    force: float


def read(path):
    """Returns the columns by name as lists of floats, and the events."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    if not rows:
        raise SystemExit(f"{path} contains no samples: run the experiment again")
    columns = {name: [float(row[name]) for row in rows] for name in rows[0] if name != "event"}
    events = []
    for row in rows:
        if row["event"]:
            kind, axis = row["event"].split()
            events.append(Event(float(row["timestamp"]), kind, axis, float(row[force_column(axis)])))
    return columns, events


def _mark(axes, events, height_of):
    for event in events:
        colour = "tab:blue" if event.kind == "ignored" else "tab:red"
        axes.axvline(event.time, color=colour, linewidth=0.8, alpha=0.5)
        axes.plot(event.time, height_of(event), "o", color=colour, markersize=7, zorder=5)


def _velocity_at(columns, time):
    index = min(range(len(columns["timestamp"])), key=lambda i: abs(columns["timestamp"][i] - time))
    return max((columns[velocity][index] for velocity in VELOCITIES), key=abs)


def _draw_forces(axes, columns, events, threshold):
    for name, (label, colour) in FORCES.items():
        axes.plot(columns["timestamp"], columns[name], color=colour, linewidth=1.1, label=label)
    for level in (threshold, -threshold):
        axes.axhline(level, color="0.35", linewidth=0.8, linestyle="--")
    axes.annotate(f"threshold ±{threshold:g} N", (columns["timestamp"][0], threshold), xytext=(2, 3), fontsize=8,
                  textcoords="offset points", color="0.35")
    _mark(axes, events, lambda event: event.force)
    axes.set_ylabel("force at the flange [N]")
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False, title="force along")


def _draw_velocities(axes, columns, events):
    for velocity, (name, colour) in zip(VELOCITIES, JOINTS.items()):
        axes.plot(columns["timestamp"], columns[velocity], color=colour, linewidth=1.1, label=name)
    _mark(axes, events, lambda event: _velocity_at(columns, event.time))
    axes.set_ylabel("joint velocity [rad/s]")
    axes.set_xlabel("time since the goal was accepted [s]")
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False, title="joint")


def _label(axes, events):
    """Writes the labels of the events above the plot."""
    for event in events:
        ignored = event.kind == "ignored"
        text = f"{abs(event.force):.0f} N along {event.axis.upper()}: " + ("ignored" if ignored else "stop")
        axes.annotate(text, (event.time, 1.0), xycoords=("data", "axes fraction"), xytext=(0, 3), fontsize=9,
                      textcoords="offset points", ha="center", va="bottom", color="tab:blue" if ignored else "tab:red")


def draw(csv_path, png_path, threshold, title):
    columns, events = read(csv_path)
    figure, (upper, lower) = plt.subplots(2, 1, sharex=True, figsize=(10, 6.2), layout="constrained")
    figure.suptitle(title)
    _draw_forces(upper, columns, events, threshold)
    _draw_velocities(lower, columns, events)
    _label(upper, events)
    for axes in (upper, lower):
        axes.grid(alpha=0.3)
        axes.margins(x=0.01)
    figure.savefig(png_path, dpi=130)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("csv", help="CSV file of the experiment")
    parser.add_argument("png", help="figure to write")
    parser.add_argument("--threshold", type=float, default=20.0, help="force threshold of the goal, N")
    parser.add_argument("--title", default="MoveDownUntilForce")
    arguments = parser.parse_args()
    draw(arguments.csv, arguments.png, arguments.threshold, arguments.title)


if __name__ == "__main__":
    main()
