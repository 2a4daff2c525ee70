"""Compares two results of ./ur bench, row by row, by medians and spreads."""

import statistics
from dataclasses import dataclass
from typing import List

from . import bench_machine, bench_rows, console
from .bench_results import Results
from .bench_rows import Row

FEWEST_RUNS = 5  # of each result, for a judgement: with 3, one of 22 equal rows would be marked by chance, with 5, one of 500
LEAST_CHANGE = 0.02  # smaller relative changes are never marked
BUSY = 0.25  # cores; a higher load of other processes is mentioned
MOST_STEAL = 1.0  # %, of the processor time; more is mentioned

BETTER, WORSE, SAME = "better", "WORSE", ""
ONLY_OLD, ONLY_NEW, NOT_JUDGED = "not measured now", "not measured before", "?"


@dataclass
class Line:
    row: Row
    old: List[float]
    new: List[float]
    verdict: str

    @property
    def ratio(self) -> str:
        if not self.old or not self.new or statistics.median(self.old) == 0.0:
            return ""
        return f"{statistics.median(self.new) / statistics.median(self.old):.2f}"


def spread(values: List[float]) -> float:
    return max(values) - min(values)


def judge(old: List[float], new: List[float]) -> str:
    """A change is beyond the noise if no value of one result lies among those of the other, and if the medians differ by
    more than either result varies.
    """
    if not old or not new:
        return ONLY_NEW if new else ONLY_OLD
    if min(len(old), len(new)) < FEWEST_RUNS:
        return NOT_JUDGED
    before, now = statistics.median(old), statistics.median(new)
    apart = max(old) < min(new) or max(new) < min(old)
    noise = max(spread(old), spread(new), LEAST_CHANGE * abs(before))
    if not apart or abs(now - before) <= noise:
        return SAME
    return BETTER if now < before else WORSE


def compare(old: Results, new: Results) -> List[Line]:
    """Returns a line for each row that was measured in one of the results. Nothing is judged across machines or settings."""
    lines = []
    for row in bench_rows.ROWS:
        before, now = bench_rows.values(old.runs, row), bench_rows.values(new.runs, row)
        if before or now:
            verdict = judge(before, now)
            incomparable = different_machine(old, new) or different_settings(old, new)
            lines.append(Line(row, before, now, NOT_JUDGED if incomparable and verdict in (BETTER, WORSE, SAME) else verdict))
    return lines


def different_machine(old: Results, new: Results) -> List[str]:
    return [f"{key}: {old.machine.get(key)}, now {new.machine.get(key)}" for key in bench_machine.SAME_MACHINE
            if old.machine.get(key) != new.machine.get(key)]


def different_settings(old: Results, new: Results) -> List[str]:
    return [f"{key} {old.settings.get(key)}, now {new.settings.get(key)}" for key in sorted({*old.settings, *new.settings})
            if old.settings.get(key) != new.settings.get(key)]


def alternate(old: Results, new: Results) -> bool:
    """Returns whether runs of both results took turns, so that a drift of the machine affects both."""
    begins = sorted([(run.get("begin", 0.0), 0) for run in old.runs] + [(run.get("begin", 0.0), 1) for run in new.runs])
    changes = sum(one[1] != next_one[1] for one, next_one in zip(begins, begins[1:]))
    return changes >= min(len(old.runs), len(new.runs))


def _highest(results: Results, load: str) -> float:
    return max(run.get("load", {}).get(load, 0.0) for run in results.runs)


def notes(old: Results, new: Results) -> List[str]:
    """Returns what limits the comparison."""
    found = [f"Another machine or build, so nothing is judged: {text}" for text in different_machine(old, new)]
    found += [f"Other settings, so nothing is judged: {text}" for text in different_settings(old, new)]
    if min(len(old.runs), len(new.runs)) < FEWEST_RUNS:
        found.append(f"Runs: {len(old.runs)} before, {len(new.runs)} now. Changes are judged with {FEWEST_RUNS} runs of each (--runs)")
    elif not alternate(old, new):
        found.append("The runs do not alternate, so a change of the machine's speed appears as a change of the driver")
    for results, when in ((old, "before"), (new, "now")):
        busy, steal = _highest(results, "other processes"), _highest(results, "steal")
        found += [f"Other processes used up to {busy:.1f} cores during the runs {when}"] if busy > BUSY else []
        found += [f"Another machine took up to {steal:.1f} % of the processor time during the runs {when}"] if steal > MOST_STEAL else []
    return found


def _cell(values: List[float]) -> str:
    if not values:
        return ""
    middle = f"{statistics.median(values):.3f}"
    return middle if len(values) == 1 else f"{middle} ({min(values):.3f} to {max(values):.3f})"


def show(old: Results, new: Results) -> None:
    console.line(f"\nBefore: {old.commit}, runs: {len(old.runs)}. Now: {new.commit}, runs: {len(new.runs)}. "
                 "Medians, and ranges of the runs:")
    console.line(f"{'':50} {'before':>28} {'now':>28}  ratio")
    for line in compare(old, new):
        console.line(f"{line.row.title[:50]:50} {_cell(line.old):>28} {_cell(line.new):>28}  {line.ratio:5}  {line.verdict}".rstrip())
    for note in notes(old, new):
        console.line(f"  {note}.")
