"""A test that fails while the host stalls is repeated, any other failure is not."""

import re
import sys
import xml.etree.ElementTree as xml

from ur_tools import runner
from ur_tools.layout import Layout

# A program of two cases, as a pytest file; a stalled host is one whose watching processes do not run.
TESTS = """
import os
import pathlib
import signal
import time

COUNT = pathlib.Path(__file__).with_suffix(".count")


def waits_of(process):
    return int(pathlib.Path(f"/proc/{process}/status").read_text().split("voluntary_ctxt_switches:")[1].split()[0])


def stall_host():
    # The process that pytest has started to measure stalls.
    watch, = pathlib.Path(f"/proc/self/task/{os.getpid()}/children").read_text().split()
    os.kill(int(watch), signal.SIGSTOP)
    time.sleep(0.3)
    begin = waits_of(watch)
    os.kill(int(watch), signal.SIGCONT)
    while waits_of(watch) < begin + 2:
        time.sleep(0.001)


def attempt():
    count = int(COUNT.read_text()) + 1 if COUNT.exists() else 1
    COUNT.write_text(str(count))
    return count


def test_passes():
    pass


"""


def run(tmp_path, monkeypatch, code):
    """Returns the result of a file with `code` after TESTS, and how often its test was attempted."""
    monkeypatch.setattr(runner, "ROOT", tmp_path)  # log files are named relative to it
    file = tmp_path / "test_stalls.py"
    file.write_text(TESTS + code)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "ur_tools.host_stalls", "-ra", str(file)]
    with runner.Runner(Layout.of_environment(), tmp_path) as started:
        found = started.run(runner.Test("a: test_stalls", command, tmp_path, 60.0))
    return found, int(file.with_suffix(".count").read_text())


def test_a_test_that_failed_while_the_host_stalled_is_repeated(tmp_path, monkeypatch):
    found, attempts = run(tmp_path, monkeypatch, "def test_late():\n    if attempt() == 1:\n        stall_host()\n        assert False\n")
    assert (found.cases, attempts) == (runner.Cases(2, []), 2), found.output
    line, = found.repeats
    assert line.startswith("failed while the host stalled for ") and line.endswith("::test_late")
    milliseconds = float(line.split()[6])
    assert milliseconds >= 250.0


def test_a_fixture_that_failed_while_the_host_stalled_is_repeated(tmp_path, monkeypatch):
    found, attempts = run(tmp_path, monkeypatch, """import pytest


@pytest.fixture(scope="module")
def started():
    if attempt() == 1:
        stall_host()
        raise OSError("late")
    return "started"


def test_late(started):
    assert started == "started"


def test_later(started):
    assert started == "started"
""")
    assert (found.cases, attempts) == (runner.Cases(3, []), 2), found.output


def test_a_stall_during_work_that_began_before_the_test_counts(tmp_path, monkeypatch):
    found, attempts = run(tmp_path, monkeypatch, """import pytest

begin = time.monotonic()


def test_before():
    stall_host()


@pytest.fixture
def outcome(request):
    request.node.began = begin
    return attempt()


def test_late(outcome):
    assert outcome > 1
""")
    assert (found.cases, attempts) == (runner.Cases(3, []), 2), found.output


def test_a_test_that_always_stalls_fails(tmp_path, monkeypatch):
    found, attempts = run(tmp_path, monkeypatch, "def test_late():\n    attempt()\n    stall_host()\n    assert False\n")
    assert (found.cases, attempts) == (runner.Cases(1, ["test_stalls.test_late"]), 4), found.output
    assert len(found.repeats) == 4


def test_a_failure_without_a_stall_is_not_repeated(tmp_path, monkeypatch):
    # The stall of the test before does not excuse it.
    found, attempts = run(tmp_path, monkeypatch, "def test_before():\n    stall_host()\n\n\n"
                                                 "def test_wrong():\n    attempt()\n    assert False\n")
    assert found.cases == runner.Cases(2, ["test_stalls.test_wrong"]), found.output
    assert attempts == 1 + len(found.repeats), found.output  # this host may stall too
    assert all(int(re.search(r"stalled for (\d+) ms", line)[1]) < 250 for line in found.repeats), found.output


def test_a_program_that_failed_while_the_host_stalled_is_repeated(tmp_path, monkeypatch):
    monkeypatch.setattr(runner, "ROOT", tmp_path)
    count = tmp_path / "count"
    program = "import pathlib; file = pathlib.Path('count'); file.open('a').write('.'); raise SystemExit(1)"
    with runner.Runner(Layout.of_environment(), tmp_path) as started:
        for stalls, attempts in (([0.3, 0.0], 2), ([0.0], 1), ([0.2] * 9, 4)):
            count.write_text("")
            measured = iter(stalls)
            monkeypatch.setattr(started._watch, "longest_since", lambda begin, measured=measured: next(measured))
            found = started.run(runner.Test("a: program", [sys.executable, "-c", program], tmp_path, 20.0))
            assert len(count.read_text()) == attempts, stalls
            assert found.cases.failures == [""] and len(found.repeats) == attempts - 1


def test_a_repeated_case_counts_once(tmp_path):
    report = tmp_path / "report.xml"
    root = xml.Element("testsuites")
    for failed in (True, False):
        case = xml.SubElement(root, "testcase", classname="test_a", name="test_late")
        if failed:
            xml.SubElement(case, "failure")
    xml.ElementTree(root).write(report)
    assert runner.read_cases(report, True) == runner.Cases(1, [])
