"""Draws a recording with matplotlib."""

import pathlib
import re
from typing import Any, Optional, Sequence, Tuple

from .errors import CliError, OperationFailed
from .recording import Recording

JOINTS = ("shoulder pan", "shoulder lift", "elbow", "wrist 1", "wrist 2", "wrist 3")
AXES = ("x", "y", "z", "rx", "ry", "rz")
COLORS = ("#1f77b4", "#ff7f0e", "#2ca02c", "#8c564b", "#9467bd", "#17becf")
# Units by the end of the name of an output, and whether its elements are joints. The first that fits is used.
UNITS = (("_TCP_force", "N, N m", False), ("_at_TCP", "N, N m", False), ("wrench", "N, N m", False),
         ("effort", "N m", True), ("_TCP_pose", "m, rad", False), ("_TCP_speed", "m/s, rad/s", False), ("force", "N", False),
         ("_qdd", "rad/s²", True), ("_qd", "rad/s", True), ("_q", "rad", True), ("current", "A", True), ("moment", "N m", True),
         ("temperatures", "°C", True), ("voltage", "V", True), ("accelerometer", "m/s²", False), ("height", "m", False))
SUFFIXES = (".png", ".pdf", ".svg")
DIAGRAM_HEIGHT, WIDTH = 2.2, 10.0  # inches


def _pyplot() -> Any:
    try:
        import matplotlib
    except ImportError:
        raise CliError("figures need matplotlib: sudo apt install python3-matplotlib, or pip install matplotlib") from None
    matplotlib.use("Agg")  # before pyplot is imported
    from matplotlib import pyplot
    return pyplot


def labels(name: str, count: int) -> Tuple[str, Sequence[str]]:
    """Returns the unit of an output, empty if it is unknown or has none, and names of its elements."""
    unit, joints = next(((unit, joints) for ending, unit, joints in UNITS if re.search(f"{ending}$", name)), ("", False))
    if count == 1:
        return unit, [name]
    names = JOINTS if joints else AXES
    return unit, names[:count] if count <= len(names) else [str(index) for index in range(count)]


def draw(recording: Recording, path: pathlib.Path, other: Optional[Recording] = None) -> pathlib.Path:
    """Writes a figure and returns its path. `other` has the same outputs, and is drawn dashed."""
    if path.suffix not in SUFFIXES:
        raise CliError(f"{path}: the name of a figure ends with {', '.join(SUFFIXES)}")
    pyplot = _pyplot()
    count = len(recording.outputs)
    figure, all_axes = pyplot.subplots(count, 1, figsize=(WIDTH, 1.0 + DIAGRAM_HEIGHT * count), sharex=True, squeeze=False,
                                       layout="constrained")
    for axes, (name, values) in zip(all_axes[:, 0], recording.outputs.items()):
        unit, names = labels(name, values.shape[1])
        for index, label in enumerate(names):
            axes.plot(recording.times, values[:, index], color=COLORS[index % len(COLORS)], linewidth=1.1, label=label)
            if other is not None:
                axes.plot(other.times, other.outputs[name][:, index], color=COLORS[index % len(COLORS)], linewidth=1.1, linestyle="--")
        axes.set_ylabel(f"{name} [{unit}]" if unit else name, fontsize=8)
        axes.grid(alpha=0.3)
        axes.margins(x=0.01)
        for time, _ in recording.events:
            axes.axvline(time, color="tab:red", linewidth=0.8, alpha=0.6)
        if values.shape[1] > 1:
            axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False, fontsize=8)
    for time, text in recording.events:
        all_axes[0, 0].annotate(text, (time, 1.0), xycoords=("data", "axes fraction"), xytext=(0, 3), textcoords="offset points",
                                ha="center", va="bottom", fontsize=8, color="tab:red")
    all_axes[-1, 0].set_xlabel("time [s]")
    figure.suptitle(recording.name if other is None else f"{recording.name}, dashed: {other.name}", fontsize=10)
    try:
        figure.savefig(path, dpi=120)
    except OSError as error:
        raise OperationFailed(f"{path} cannot be written: {error.strerror}") from None
    finally:
        pyplot.close(figure)
    return path
