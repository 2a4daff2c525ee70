"""Draws a recording: one diagram for each RTDE output, over time.

    ur plot run.csv                                  writes run.png
    ur plot run.csv actual_q actual_TCP_force --output forces.pdf

Reads the CSV files of `ur record`, of the viewer and of the demo, whose column `event` is drawn as labeled lines, and recordings of
rosbag2.
"""

import argparse
import pathlib


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", type=pathlib.Path, help="CSV file, or recording of rosbag2")
    parser.add_argument("fields", nargs="*", help="outputs to draw (default: all)")
    parser.add_argument("--output", type=pathlib.Path, metavar="FILE", help="figure to write: png, pdf or svg (default: that of FILE, png)")


def run(options: argparse.Namespace) -> int:
    from .recording import beside, read  # imported here because --help does not need numpy
    from .recording_figure import draw
    recording = read(options.file).select(options.fields)
    print(draw(recording, options.output or beside(options.file)))
    return 0
