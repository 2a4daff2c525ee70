"""Plots of the last 30 s: joint positions, joint velocities and the force at the TCP."""

import time
from typing import Any, Dict, List, Tuple

import numpy as np
from viser import uplot

from ..state.history import History
from ..state.robot_state import RobotState

DURATION = 30.0  # s
SAMPLE_PERIOD = 1.0 / 15.0  # s
DRAW_PERIOD = 0.25  # s; each drawing sends all samples
JOINTS = ("pan", "lift", "elbow", "wrist 1", "wrist 2", "wrist 3")
COLORS = ("#1f77b4", "#ff7f0e", "#2ca02c", "#8c564b", "#9467bd", "#17becf")
# Title, curves, first column after the time, and half of the range that is shown at least: noise must not look like a motion.
PLOTS = (("Joint positions, rad", JOINTS, 0, 0.1), ("Joint velocities, rad/s", JOINTS, 6, 0.1),
         ("Force at the TCP, N", ("x", "y", "z"), 12, 5.0))
HEIGHT, PADDING = 170, (10, 16, 0, 0)  # pixels; three plots fit into a window of 800; top, right, bottom, left
AXES = (uplot.Axis(), uplot.Axis(space=15))  # pixels between labels; uPlot's 30 leave one label in this height
# uPlot computes the labels of the axes when a scale or the size of the plot changes. viser tells it the width of a plot after its
# creation; if data arrive at the same moment, uPlot forgets the change of the size. So each drawing changes the scale of a hidden curve.
HIDDEN = uplot.Series(label="\u200b", scale="drawing", stroke="transparent", points={"show": False})
COLUMNS = 1 + 6 + 6 + 3


def _scales(smallest: float) -> Dict[str, uplot.Scale]:
    """The time axis is fixed: viser keeps the part of an automatic axis that is in view, and loses the curves while they grow."""
    limit = {"pad": 0.1, "mode": 1}
    y_range = {"min": {**limit, "soft": -smallest}, "max": {**limit, "soft": smallest}}
    return {"x": uplot.Scale(time=False, range=(-DURATION, 0.0)), "y": uplot.Scale(auto=True, range=y_range)}


def sample(state: RobotState) -> np.ndarray:
    """Returns time, positions, velocities and force; values that were not received are NaN."""
    row = np.full(COLUMNS, np.nan)
    if state.joints is not None:
        row[0], row[1:7], row[7:13] = state.joints.stamp, state.joints.positions, state.joints.velocities
    if state.wrench is not None:
        row[13:] = state.wrench[:3]
    return row


class PlotsPanel:
    def __init__(self, tab: Any, server: Any):
        self._server = server
        self._history = History(COLUMNS, round(DURATION / SAMPLE_PERIOD) + 1)
        self._last_stamp, self._drawn, self._drawings = -np.inf, -np.inf, 0
        with tab:
            self._pause = server.gui.add_checkbox("Pause", False)
            self._plots = [self._add(title, names, smallest) for title, names, _, smallest in PLOTS]

    def _add(self, title: str, names: Tuple[str, ...], smallest: float) -> Any:
        series = (uplot.Series(label="s"), *(uplot.Series(label=name, stroke=color, width=1.5, points={"show": False})
                                             for name, color in zip(names, COLORS)), HIDDEN)
        return self._server.gui.add_uplot(tuple(np.zeros(1) for _ in series), series, title=title, height=HEIGHT, padding=PADDING,
                                          scales=_scales(smallest), axes=AXES, legend=uplot.Legend(show=True, live=False))

    @property
    def paused(self) -> bool:
        return bool(self._pause.value)

    @property
    def data(self) -> List[np.ndarray]:
        """The newest samples: relative times in s, then the values of all plots."""
        rows = self._history.rows(DURATION)
        rows[:, 0] -= rows[-1, 0] if len(rows) else 0.0
        return list(rows.T)

    def update(self, state: RobotState) -> None:
        if state.joints is not None:
            self._collect(state)
        now = time.monotonic()
        if not self.paused and len(self._history) and now - self._drawn >= DRAW_PERIOD and self._server.get_clients():
            self._drawn = now
            self._draw()

    def _collect(self, state: RobotState) -> None:
        stamp = state.joints.stamp if state.joints is not None else 0.0
        if stamp < self._last_stamp:  # another clock: the driver or a simulator restarted
            self._history.clear()
            self._last_stamp = -np.inf
        if stamp - self._last_stamp >= SAMPLE_PERIOD:
            self._history.add(sample(state))
            self._last_stamp = stamp

    def _draw(self) -> None:
        data = self.data
        self._drawings += 1
        hidden = np.full(len(data[0]), 1.0 + self._drawings % 2)
        for plot, (_, names, first, _) in zip(self._plots, PLOTS):
            plot.data = (data[0], *data[1 + first:1 + first + len(names)], hidden)

    def close(self) -> None:
        pass
