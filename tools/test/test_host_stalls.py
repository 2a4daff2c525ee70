"""A test that fails while the host stalls is repeated, any other failure is not."""

import os
import signal
import sys
import time
import xml.etree.ElementTree as xml

import pytest
from ur_tools import runner
from ur_tools.layout import Layout
from ur_tools.stall_watch import CRASHED, StallWatch

# A program of two cases, as a pytest file. It determines when the host stalls.
TESTS = """
import os
import pathlib
import subprocess
import sys
import time

from ur_tools.stall_watch import StallWatch

COUNT = pathlib.Path(__file__).with_suffix(".count")
STALLS = []
StallWatch.longest_since = lambda self, begin: max((end - start for start, end in STALLS if end > begin), default=0.0)


def stall_host():
    STALLS.append((time.monotonic() - 0.3, time.monotonic()))


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
    assert line.startswith("failed while the host stalled for 300 ms: ") and line.endswith("::test_late")


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
    assert (found.cases, attempts) == (runner.Cases(2, ["test_stalls.test_wrong"]), 1), found.output
    assert found.repeats == []


def test_a_failure_after_a_crash_is_not_repeated(tmp_path, monkeypatch):
    found, attempts = run(tmp_path, monkeypatch, """def test_driver():
    driver = subprocess.Popen([sys.executable, "-c", "import os; os.abort()"])
    attempt()
    stall_host()
    driver.wait()
    assert False
""")
    assert (found.cases, attempts) == (runner.Cases(1, ["test_stalls.test_driver"]), 1), found.output


# A program of GoogleTest, with and without the report of a failed case.
WITHOUT_REPORT = "import os, pathlib, signal, time; pathlib.Path('count').open('a').write('.')\n"
FAILED_CASE = WITHOUT_REPORT + ("report = pathlib.Path(os.environ['GTEST_OUTPUT'].partition(':')[2])\n"
                                "report.write_text('<testsuite><testcase name=\"late\"><failure/></testcase></testsuite>')\n")


@pytest.fixture
def attempts_of(tmp_path, monkeypatch):
    """Returns a function that runs a program while the host stalls for these times, s, and returns the result and the attempts."""
    monkeypatch.setattr(runner, "ROOT", tmp_path)

    def run(program, stalls, limit=20.0):
        (tmp_path / "count").write_text("")
        measured = iter(stalls)
        with runner.Runner(Layout(Layout.of_environment().ros), tmp_path) as started:
            monkeypatch.setattr(started._watch, "longest_since", lambda begin: next(measured))
            found = started.run(runner.Test("a: program", [sys.executable, "-c", program], tmp_path, limit))
        return found, len((tmp_path / "count").read_text())

    return run


@pytest.mark.parametrize("stalls, expected", [([0.3, 0.0], 2), ([0.0], 1), ([0.2] * 9, 4)])
def test_a_program_that_failed_while_the_host_stalled_is_repeated(attempts_of, stalls, expected):
    found, attempts = attempts_of(FAILED_CASE + "raise SystemExit(1)", stalls)
    assert attempts == expected and len(found.repeats) == attempts - 1
    assert found.cases.failures == [".late"]


@pytest.mark.parametrize("program, limit", [(WITHOUT_REPORT + "raise SystemExit(1)", 20.0), (FAILED_CASE + "raise SystemExit(66)", 20.0),
                                            (FAILED_CASE + "os.kill(os.getpid(), signal.SIGSEGV)", 20.0),
                                            (FAILED_CASE + "time.sleep(60.0)", 0.5)])
def test_a_crash_a_report_of_a_sanitizer_and_a_time_limit_are_not_repeated(attempts_of, program, limit):
    found, attempts = attempts_of(program, [0.3] * 9, limit)
    assert attempts == 1 and found.cases.failures


def test_a_sanitizer_has_another_status_than_failed_cases():
    options = runner._sanitizer_environment()
    assert len(options) == 3 and all("exitcode=66" in value for value in options.values()) and {66, -signal.SIGSEGV} <= set(CRASHED)


def test_a_stall_is_measured():
    begin = time.monotonic()
    watch = StallWatch()
    os.kill(watch._process.pid, signal.SIGSTOP)
    os.waitid(os.P_PID, watch._process.pid, os.WSTOPPED)
    time.sleep(0.3)
    os.kill(watch._process.pid, signal.SIGCONT)
    assert watch.longest_since(begin) >= 0.25
    assert watch.longest_since(time.monotonic() + 60.0) == 0.0
    watch.close()


def test_a_repeated_case_counts_once(tmp_path):
    report = tmp_path / "report.xml"
    root = xml.Element("testsuites")
    for failed in (True, False):
        case = xml.SubElement(root, "testcase", classname="test_a", name="test_late")
        if failed:
            xml.SubElement(case, "failure")
    xml.ElementTree(root).write(report)
    assert runner.read_cases(report, True, True) == runner.Cases(1, [])
