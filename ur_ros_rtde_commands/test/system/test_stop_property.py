"""The stop property test: random cases of a goal, an event that ends it, and held threads of the driver. See stops/__init__.py.

`./ur chaos --stops 20000` runs more of them, `./ur chaos --case SEED` repeats one.
"""

import os

from robot_fixtures import addresses
from stops import campaign

LOAD = 2.0  # it uses two cores
LANES = 2
CASES = 200
FIRST_SEED = 26
SECONDS = 90.0  # no case begins later; on two idle cores, all have ended by then

__all__ = ["addresses"]


def test_every_goal_is_stopped_by_every_event(addresses, tmp_path):
    first = int(os.environ.get("UR_STOP_SEED", FIRST_SEED))
    run = campaign.Campaign(range(first, first + CASES), addresses[:LANES], tmp_path, lambda _report: None, SECONDS)
    run.run()
    print(f"seeds from {first}; UR_STOP_SEED selects others")
    print("\n".join([*campaign.table(run.reports), *campaign.notes(run.descriptions)]))
    for report in run.failed():
        log = next(tmp_path.glob(f"lane_*/case_{report['seed']}.txt"), None)
        print(log.read_text() if log else report)
    assert not run.failures
    assert not [(report["seed"], report["case"], report["violations"]) for report in run.failed()]
