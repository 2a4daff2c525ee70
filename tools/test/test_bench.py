"""./ur bench: the figures of a stream, and a short run."""

import os
import re
import subprocess
import sys

import pytest
from ur_tools.layout import ROOT

sys.path.insert(0, str(ROOT / "bench"))

from servo_stream import figures

MS = 1_000_000
CYCLES = {number: 2 * MS * number for number in range(1000)}


def targets(late=lambda number: 0.0):
    """Returns a target 0.3 ms after each package, delayed by `late` ms."""
    return [(number, int(when + (0.3 + late(number)) * MS)) for number, when in CYCLES.items()]


def test_a_stream_that_answers_each_package_has_no_deviations():
    result = figures(targets(), CYCLES, 1.0)
    assert result["answer p50"] == result["answer p99.9"] == pytest.approx(0.3)
    assert [result[name] for name in ("off package", "off 2 ms", "cycles off 2 ms", "not once a cycle")] == [0.0] * 4


def test_a_delayed_target_is_attributed_to_the_driver():
    result = figures(targets(lambda number: 0.5 if number % 100 == 50 else 0.0), CYCLES, 1.0)
    assert result["off package"] == result["off 2 ms"] == pytest.approx(2.0, abs=0.01)  # the intervals on both sides of 1 %
    assert result["cycles off 2 ms"] == 0.0 and result["answer p99.9"] == pytest.approx(0.8)


def test_a_delayed_package_is_attributed_to_the_controller():
    late = {number: when + (MS if number % 100 == 50 else 0) for number, when in CYCLES.items()}
    result = figures([(number, when + 300_000) for number, when in late.items()], late, 1.0)
    assert result["cycles off 2 ms"] == result["off 2 ms"] == pytest.approx(2.0, abs=0.01)
    assert result["off package"] == 0.0


def test_cycles_with_two_targets_or_none_are_counted():
    twice = [(number - (number % 100 == 50), when) for number, when in targets()]
    assert figures(twice, CYCLES, 1.0)["not once a cycle"] == pytest.approx(2.0)


def test_intervals_are_in_the_robots_time():
    slow = {number: 10 * when for number, when in CYCLES.items()}
    result = figures([(number, when + 300_000 + (number % 2) * MS) for number, when in slow.items()], slow, 0.1)
    assert result["off package"] == result["off 2 ms"] == result["cycles off 2 ms"] == 0.0


def bench(*arguments):
    env = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT / "tools"), os.environ.get("PYTHONPATH", "")])}
    return subprocess.run([sys.executable, "-m", "ur_tools.bench", *arguments], env=env, capture_output=True, text=True, timeout=300)


def test_a_short_stream_is_measured():
    # At a tenth of the speed, so that parallel tests do not cause the loss of a link.
    result = bench("--stream", "--seconds", "1", "--real-time-factor", "0.1", "--let-sleep", "--address",
                   os.environ.get("UR_TEST_ADDRESS", "127.0.1.203"))
    assert result.returncode == 0, result.stdout + result.stderr
    error = re.search(r"servo stream +tracking error +([0-9.]+)", result.stdout)
    assert error and 0.0 <= float(error[1]) < 0.02, result.stdout + result.stderr
    assert re.search(r"servo stream +answer p50 +[0-9.]+", result.stdout)
    assert "servo stream, real-time" in result.stdout or "this user may not have it" in result.stdout


def test_a_real_time_factor_requires_the_stream_option():
    result = bench("--real-time-factor", "0.5")
    assert result.returncode == 2 and "--real-time-factor needs --stream" in result.stderr
