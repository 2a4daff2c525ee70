"""./ur bench: what its measuring programs calculate, and short runs of them on a simulated robot."""

import os
import re
import subprocess
import sys

import pytest
from ur_tools import bench, bench_recovery, bench_rows, bench_stress, bench_trace
from ur_tools.layout import ROOT, SANITIZERS, Layout

sys.path.insert(0, str(ROOT / "bench"))

from goal_latency import first_commands
from latency import latencies, missing_percent, percentile
from many_goals import growth
from process_load import LoadTrace, cpu_percent, proportional_megabytes, resident_megabytes
from subscribe_everything import is_hidden, message_class

LOAD = 2.0  # it runs alone: its drivers have the default limits, for which a late host is a lost connection

ADDRESS = os.environ.get("UR_TEST_ADDRESS", "127.0.1.203")
MS = 1_000_000
TRACE = {"cycles": [[number, 2 * MS * number, 0.0, 0.0] for number in range(1000)]}


def messages(numbers, delay=0.3):
    """Returns a message for each of these packages: stamped 0.1 ms after it was sent, received `delay` ms after it."""
    return [(2 * MS * number + MS // 10, int(2 * MS * number + delay * MS)) for number in numbers]


def test_latency_is_measured_from_the_package_that_the_stamp_belongs_to():
    assert latencies(messages(range(10), delay=0.3), TRACE) == pytest.approx([0.3] * 10)
    assert latencies(messages(range(10), delay=5.0), TRACE) == pytest.approx([5.0] * 10)  # longer than a cycle


def test_messages_older_than_the_trace_have_no_latency():
    assert latencies([(-MS, 0), *messages(range(3))], TRACE) == pytest.approx([0.3] * 3)


def test_missing_packages_are_counted_between_the_first_and_the_last_message():
    assert missing_percent(messages(range(100, 900)), TRACE) == 0.0
    received = messages(number for number in range(101, 900) if number % 10)
    assert missing_percent(received, TRACE) == pytest.approx(100.0 * 79 / 799)
    assert missing_percent([], TRACE) == 0.0


def test_percentiles_are_values():
    assert percentile([3.0, 1.0, 2.0], 0.5) == 2.0 and percentile(range(1000), 0.999) == 999 and percentile([1.0], 0.99) == 1.0


def test_growth_ignores_the_first_half():
    assert growth([float(number) for number in range(50)] + [50.0] * 50) == 0.0
    assert growth([50.0] * 50 + [50.0 + 0.1 * number for number in range(50)]) == pytest.approx(4.0)


def test_load_of_a_busy_process_is_recorded():
    with subprocess.Popen([sys.executable, "-c", "while True: pass"]) as busy:
        try:
            pids = {"busy": busy.pid}
            with LoadTrace(pids) as trace:
                assert cpu_percent(pids, 1.2)["busy"] > 1.0
            assert 1.0 < resident_megabytes(busy.pid) < 1000.0 and 0.5 < proportional_megabytes(busy.pid) < 1000.0
        finally:
            busy.kill()
    assert len(trace.points["busy"]) >= 2
    assert all(when > 0.0 and load >= 0.0 and megabytes > 1.0 for when, load, megabytes in trace.points["busy"])


def test_types_and_hidden_topics_are_recognized():
    assert message_class("sensor_msgs/msg/JointState").__name__ == "JointState"
    assert message_class("no_such_package/msg/Thing") is None
    assert is_hidden("/move_j/_action/status") and not is_hidden("/robot_state")


def test_a_robot_and_some_goals_are_measured():
    env = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT / "tools"), os.environ.get("PYTHONPATH", "")])}
    result = subprocess.run([sys.executable, "-m", "ur_tools.bench", "--scale", "--robots", "1", "--goals", "20", "--address", ADDRESS],
                            env=env, capture_output=True, text=True, timeout=300)
    assert result.returncode == 0, result.stdout + result.stderr
    for row in bench_rows.ROWS:
        if row.name in ("1 robot, driver", "1 robot, three processes", "many goals"):
            assert any(line.startswith(row.name) and f" {row.part} " in line for line in result.stdout.splitlines()), row.title


def test_the_first_command_after_each_goal_is_found():
    assert first_commands([100, 200, 300, 400], [90, 110, 115, 320, 410]) == [(100, 110), (300, 320), (400, 410)]
    assert first_commands([], [90]) == first_commands([100], [90]) == []


@pytest.mark.skipif(Layout.of_environment().variant in SANITIZERS, reason="a sanitizer does not permit the library that records hand-overs")
def test_hand_overs_of_packages_and_goals_are_measured(capsys):
    options, layout = bench.parse(["--trace", "--repeat", "5", "--address", ADDRESS]), Layout.of_environment()
    assert bench_trace.run(options, layout, seconds=1) == 0
    output = capsys.readouterr().out
    for what in ("Packages", "Goals of a client in C++", "Goals of a client in rclpy"):  # a busy host loses some
        assert re.search(rf"^{re.escape(what)} \([1-9]", output, re.M), output
    assert "nothing measured" not in output and "Lost packages: packages " in output


def test_recoveries_are_measured():
    options, layout = bench.parse(["--recovery", "--repeat", "2", "--address", ADDRESS]), Layout.of_environment()
    figures, _ = bench_recovery.measure(layout, options)
    assert set(figures) == set(bench_rows.RECOVERY)
    assert all(0.0 < found["p50"] <= found["max"] and found["count"] == 2 for found in figures.values()), figures


def test_latency_beside_a_python_subscriber_is_measured():
    options, layout = bench.parse(["--stress", "--address", ADDRESS]), Layout.of_environment()
    figures, samples = bench_stress.measure_condition(layout, options, "Python subscriber")
    for qos in bench_rows.QOS:
        assert set(figures[qos]) == {part for part, _, _ in bench_rows.STRESS}
        assert 0.0 < figures[qos]["p50"] <= figures[qos]["p99.9"] and 0.0 <= figures[qos]["missing"] < 100.0
        assert len(samples[qos]) > 100
