"""The stop property test: random cases of a goal, an event that ends it, and held threads of the driver. See stops/__init__.py.

`./ur chaos --stops 20000` runs more of them, `./ur chaos --case SEED` repeats one.
"""

import os

import pytest
from robot_fixtures import addresses
from stops import campaign
from stops.cases import LATE_THREADS

LOAD = 2.0  # it uses two cores
JUDGES_STALLS = True  # see stops/stalls.py
LANES = 2
CASES = 200
FIRST_SEED = 26
LEAST_CASES = 20  # in SECONDS, on any host
SECONDS = 90.0  # no case begins later; on two idle cores, all have ended by then

__all__ = ["addresses"]


def execute(seeds, addresses, log, seconds=SECONDS, is_about_holds=False):
    run = campaign.Campaign(seeds, addresses[:LANES], log, lambda _report: None, seconds)
    run.run()
    for report in run.failed():
        case = next(log.glob(f"lane_*/case_{report['seed']}.txt"), None)
        print(case.read_text() if case else report)
    print("\n".join([*campaign.table(run.reports), *campaign.notes(run.descriptions)]))
    for report in run.failed():
        print(report["seed"], report["case"], *report["violations"], sep="\n    ")
    assert not run.failures
    if is_about_holds and any(description["holds"] != "possible" for description in run.descriptions):
        pytest.skip("threads cannot be held")
    assert not [report["seed"] for report in run.failed()]
    return run.reports


def test_random_goals_are_stopped_by_random_events(addresses, tmp_path):
    first = int(os.environ.get("UR_STOP_SEED", FIRST_SEED))
    print(f"seeds from {first}; UR_STOP_SEED selects others")
    assert len(execute(range(first, first + CASES), addresses, tmp_path)) >= LEAST_CASES


def test_a_late_goal_does_not_go_on_in_the_next_program(addresses, tmp_path):
    count = len(LATE_THREADS)
    assert len(execute(range(-count, 0), addresses, tmp_path, seconds=0.0, is_about_holds=True)) == count
