"""Writes the results of ./ur bench as one HTML page with its figures inside."""

import html
import json
import pathlib
import statistics
import subprocess
import time
from typing import List, Optional, Sequence, Tuple

from . import bench_compare, bench_results, bench_rows, console
from .bench_results import Results
from .environment import run_environment
from .layout import ROOT, Layout

FILE = "bench.html"  # in the folder of --report

_STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; color: #222; background: #fff }
table { border-collapse: collapse; margin: 1rem 0; font-variant-numeric: tabular-nums }
th, td { padding: 0.15rem 0.7rem; text-align: left; border-bottom: 1px solid #ddd; vertical-align: top }
td.number, th.number { text-align: right; white-space: nowrap }
.worse { color: #b00020; font-weight: 600 } .better { color: #00702e; font-weight: 600 }
svg { max-width: 100%; height: auto }
"""


def file_of(path: pathlib.Path) -> pathlib.Path:
    """Returns the page to write: the path itself if it names an HTML file, otherwise a file in this folder."""
    return path if path.suffix in (".html", ".htm") else path / FILE


def check(path: pathlib.Path) -> None:
    """Raises Failure if the page cannot be written. A folder is created in the existing one above it."""
    if path.suffix in (".html", ".htm") or path.is_dir():
        bench_results.check_writable(file_of(path), "--report")
    else:
        bench_results.check_writable(path, "--report")
        if path.exists():
            raise console.Failure(f"--report {path}: give a folder or a file that ends in .html")


def _table(head: Sequence[str], rows: Sequence[Sequence[Tuple[str, str]]]) -> str:
    """Returns a table. A cell is its text and its CSS class."""
    def cell(tag: str, text: str, style: str) -> str:
        return f'<{tag}{f" class={chr(34)}{style}{chr(34)}" if style else ""}>{html.escape(text)}</{tag}>'

    lines = ["<tr>" + "".join(cell("th", text, "") for text in head) + "</tr>"]
    lines += ["<tr>" + "".join(cell("td", text, style) for text, style in row) + "</tr>" for row in rows]
    return "<table>" + "\n".join(lines) + "</table>"


def _figures(results: Results) -> str:
    rows = []
    for row in bench_rows.ROWS:
        found = bench_rows.values(results.runs, row)
        if found:
            middle = statistics.median(found)
            spread = f"{min(found):.3f} to {max(found):.3f}" if len(found) > 1 else ""
            target = "" if row.target is None else f"{row.target:g}"
            rows.append([(row.name, ""), (row.part or "", ""), (f"{middle:.3f}", "number"), (spread, "number"),
                         (target, "number"), (row.unit, "")])
    return _table(("", "", "median", "range", "target", "unit"), rows)


def _comparison(old: Results, new: Results) -> str:
    styles = {bench_compare.BETTER: "better", bench_compare.WORSE: "worse"}
    rows = []
    for line in bench_compare.compare(old, new):
        values = [f"{statistics.median(one):.3f}" if one else "" for one in (line.old, line.new)]
        rows.append([(line.row.title, ""), *((text, "number") for text in (*values, line.ratio)),
                     (line.verdict, styles.get(line.verdict, ""))])
    notes = "".join(f"<li>{html.escape(note)}.</li>" for note in bench_compare.notes(old, new))
    return (f"<h2>Compared with {html.escape(old.commit)}</h2>" + _table(("", "before", "now", "ratio", ""), rows)
            + f"<ul>{notes}</ul>")


def _machine(results: Results) -> str:
    rows = [[(key, ""), (str(text), "")] for key, text in {"commit": results.commit, **results.machine, **results.settings}.items()]
    for number, run in enumerate(results.runs, 1):
        load = ", ".join(f"{name} {value:.2f}" for name, value in run.get("load", {}).items())
        begin = time.strftime("%Y-%m-%d %H:%M", time.localtime(run.get("begin", 0.0)))
        rows.append([(f"run {number}", ""), (f"{begin}; {load}", "")])
    return _table(("", ""), rows)


def _draw(layout: Layout, samples: dict) -> List["tuple[str, str]"]:
    """Draws with the Python of the build, which has matplotlib."""
    command = [str(layout.python), "-m", "ur_tools.bench_figures"]
    result = subprocess.run(command, cwd=ROOT / "tools", env={**run_environment(layout), "PYTHONDONTWRITEBYTECODE": "1"},
                            input=json.dumps(samples), stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
    if result.returncode != 0:
        raise console.Failure(f"the figures could not be drawn:\n{console.tail(result.stderr, 10)}")
    return json.loads(result.stdout)


def page(results: Results, old: Optional[Results], figures: List["tuple[str, str]"]) -> str:
    drawn = "".join(f"<h2>{html.escape(title)}</h2>\n{svg}\n" for title, svg in figures)
    number = len(results.runs)
    title = f"ur_ros_rtde {html.escape(results.commit)}: {number} run{'s' * (number > 1)} of ./ur bench"
    return (f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{title}</title><style>{_STYLE}</style></head>\n'
            f"<body><h1>{title}</h1>\n<h2>Figures</h2>{_figures(results)}\n{_comparison(old, results) if old else ''}\n"
            f"{drawn}<p>The figures show the last run.</p>\n<h2>Machine and load</h2>{_machine(results)}</body></html>\n")


def write(path: pathlib.Path, layout: Layout, results: Results, old: Optional[Results]) -> None:
    file = file_of(path)
    file.parent.mkdir(exist_ok=True)
    file.write_text(page(results, old, _draw(layout, results.runs[-1].get("samples", {}))))
    console.line(f"report: {file}")
