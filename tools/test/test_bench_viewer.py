"""./ur bench --viewer: load of viewer and browser, and the latency beside them."""

import os

from ur_tools import bench, bench_rows, bench_viewer, browser
from ur_tools.layout import Layout

BROWSER = True
ADDRESS = os.environ.get("UR_TEST_ADDRESS", "127.0.1.203")


def test_viewer_and_browser_are_measured_while_the_arm_moves():
    options, layout = bench.parse(["--viewer", "--address", ADDRESS]), Layout.of_environment()
    beside = ("viewer", "browser") if browser.VARIABLE in os.environ else ("viewer",)
    found = bench_viewer.measure_condition(layout, options, beside)
    for qos in bench_rows.QOS:
        assert set(found["figures"][qos]) == {part for part, _, _ in bench_rows.STRESS}
    assert set(found["load"]) == set(beside) and all(load > 0.5 for load in found["load"].values()), found["load"]


def test_both_conditions_have_rows():
    names = {row.name for row in bench_rows.ROWS}
    assert {bench_rows.stress_name(condition, qos) for condition in bench_rows.VIEWER_CONDITIONS for qos in bench_rows.QOS} <= names
    assert {"viewer", "browser"} <= names
