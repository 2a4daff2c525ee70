"""Compares two recordings: prints how far each output differs, and draws both (the second dashed).

    ur compare before.csv after.csv                          writes before_after.png
    ur compare before.csv after.csv actual_q --shift 0 --output joints.pdf

The recordings begin at different times before the motion. The second one is therefore shifted so that the outputs fit best, or by
the given time.
"""

import argparse
import pathlib

from .errors import CliError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("first", type=pathlib.Path, help="CSV file, or recording of rosbag2")
    parser.add_argument("second", type=pathlib.Path, help="CSV file, or recording of rosbag2")
    parser.add_argument("fields", nargs="*", help="outputs to compare (default: all that both have)")
    parser.add_argument("--shift", type=float, metavar="S",
                        help="time by which the second recording is moved to later, in s (default: best fit)")
    parser.add_argument("--output", type=pathlib.Path, metavar="FILE", help="figure to write: png, pdf or svg (default: FIRST_SECOND.png)")


def run(options: argparse.Namespace) -> int:
    from .recording import beside, read  # imported here because --help does not need numpy
    from .recording_comparison import compare, report
    from .recording_figure import draw
    first, second = read(options.first), read(options.second)
    for path, recording in ((options.first, first), (options.second, second)):
        back = recording.first_step_back()
        if back is not None:
            raise CliError(f"{path}: the time of row {back + 1} is earlier than that of the row before: is it a recording of one robot?")
    comparison = compare(first, second, options.fields, options.shift)
    print(report(comparison))
    name = beside(options.first, f"_{beside(options.second).stem}")
    print(draw(comparison.first, options.output or name, comparison.second))
    return 0
