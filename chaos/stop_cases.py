"""Runs cases of the stop property test in several lanes. Started by `./ur chaos --stops N`."""

import argparse
import json
import pathlib
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
for folder in ("ur_ros_rtde_commands/test/system", "tools"):
    sys.path.insert(0, str(ROOT / folder))

from stops import campaign  # noqa: E402
from ur_tools import console  # noqa: E402


class Progress:
    """Prints failed cases at once, and the number of cases with the remaining time on a line that is replaced."""

    def __init__(self, count: int, log: pathlib.Path):
        self._count, self._begin = count, time.monotonic()
        self._status = console.Status(10.0)
        self._file = (log / "cases.jsonl").open("w")
        self._done = self._failed = 0

    def add(self, report: campaign.Report) -> None:
        self._file.write(json.dumps(report) + "\n")
        self._file.flush()
        self._done += 1
        if report["violations"]:
            self._failed += 1
            self._status.clear()
            print(f"    case {report['seed']} FAILED: {report['case']}\n        " + "\n        ".join(report["violations"]), flush=True)
        left = (time.monotonic() - self._begin) / self._done * (self._count - self._done)
        self._status.show(f"{self._done} of {self._count} cases, {self._failed} failed, about {left / 60.0:.0f} min left")

    def close(self) -> None:
        self._status.clear()
        self._file.close()


def _print_summary(run: campaign.Campaign, seconds: float) -> None:
    print("\n".join(campaign.table(run.reports)))
    for note in sorted(campaign.notes(run.descriptions)):
        print(f"    {note}")
    print(f"    {len(run.reports)} cases in {seconds:.0f} s: {len(run.reports) / seconds:.2f} per second")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--addresses", nargs="+", required=True)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=0)
    parser.add_argument("--seeds", type=int, nargs="+", default=[])
    parser.add_argument("--minutes", type=float, default=0.0)
    parser.add_argument("--log", type=pathlib.Path, required=True)
    options = parser.parse_args()
    seeds = options.seeds or range(options.first, options.first + options.count)
    options.log.mkdir(parents=True, exist_ok=True)
    progress, begin = Progress(len(seeds), options.log), time.monotonic()
    run = campaign.Campaign(seeds, options.addresses, options.log, progress.add, 60.0 * options.minutes)
    try:
        run.run()
    finally:
        progress.close()
        if run.reports:
            _print_summary(run, time.monotonic() - begin)
    failed = run.failed()
    for failure in run.failures:
        print(f"    {failure}")
    if failed:
        print(f"\nFAILED: {len(failed)} cases. Logs: {options.log}/lane_*/case_SEED.txt\n"
              f"To repeat them: ./ur chaos --case {' '.join(str(report['seed']) for report in failed[:20])}")
    return 1 if failed or run.failures or not run.reports else 0


if __name__ == "__main__":
    sys.exit(main())
