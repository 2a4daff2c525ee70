"""The results of fuzz targets: what libFuzzer reports, several targets at a time, the table."""

import os
import sys

from ur_tools import fuzz_campaign as campaign

LOG = b"""INFO: Seed: 1
#2\tINITED cov: 10 ft: 11 corp: 1/1b exec/s: 0 rss: 30Mb
#1024\tNEW    cov: 12 ft: 20 corp: 3/40b lim: 4 exec/s: 512 rss: 40Mb L: 3/4 MS: 1 ChangeBit-
#4096\tpulse  cov: 12 ft: 20 corp: 3/40b lim: 4 exec/s: 512 rss: 40Mb
"""


def test_progress_is_the_last_reported_state():
    assert campaign.read_progress(b"INFO: Seed: 1\n") == campaign.Progress(0, 0)
    assert campaign.read_progress(LOG) == campaign.Progress(4096, 12)
    end = b"#5000\tDONE   cov: 13 ft: 21 corp: 3/40b lim: 4 exec/s: 512 rss: 40Mb\nstat::number_of_executed_units: 5000\n"
    assert campaign.read_progress(LOG + end) == campaign.Progress(5000, 13)


def target(folder, name, status):
    """A target that reports 4096 executions and ends with this status."""
    log = folder / f"{name}.report"
    log.write_bytes(LOG)
    program = f"import sys; print(open({str(log)!r}).read(), flush=True); sys.exit({status})"
    return campaign.Target(name, [sys.executable, "-c", program], folder / f"{name}.log")


def test_all_targets_run_and_a_failed_one_is_named(tmp_path):
    targets = [target(tmp_path, name, status) for name, status in (("b", 0), ("c", 77), ("a", 0))]
    results = campaign.run(targets, dict(os.environ), executions=-1, jobs=2)
    assert [(result.name, result.failed) for result in results] == [("a", False), ("b", False), ("c", True)]
    assert {result.progress for result in results} == {campaign.Progress(4096, 12)}
    lines = campaign.table(results).splitlines()
    assert len(lines) == 4 and "4,096" in lines[1] and "no finding" in lines[1] and "FAILED" in lines[3]
