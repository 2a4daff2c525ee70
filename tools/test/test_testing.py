import pathlib

import pytest
from ur_tools import main, testing

REPORT = """<testsuites><testsuite>
<testcase name="good"/><testcase name="good_too" status="run"/>
<testcase classname="Suite" name="bad"><failure/></testcase><testcase classname="a.Suite" name="broken"><error/></testcase>
<testcase name="left_out"><skipped/></testcase>
</testsuite></testsuites>"""


def test_cases_of_a_report_are_counted_and_skipped_ones_are_not(tmp_path):
    report = tmp_path / "report.xml"
    report.write_text(REPORT)
    assert testing._cases(report, False) == (2, ["Suite.bad", "Suite.broken"])


@pytest.mark.parametrize("succeeded, expected", [(True, (1, [])), (False, (0, [""]))])
def test_a_program_without_a_report_is_one_case(tmp_path, succeeded, expected):
    assert testing._cases(tmp_path / "none.xml", succeeded) == expected


def test_a_crash_after_passed_cases_is_a_failure(tmp_path):
    report = tmp_path / "report.xml"
    report.write_text("<testsuite><testcase name='good'/></testsuite>")
    assert testing._cases(report, False) == (1, ["ended badly after its last case"])


def result(command, failures):
    return testing.Result(testing.Test("a test", command, pathlib.Path(), 1.0), 3, failures, 1.0, "")


def test_of_a_file_only_what_failed_is_run_again():
    part = testing._failed_part(result(["python", "-m", "pytest", "-q", "a/test_x.py"], ["test_x.test_y[a.b]", "test_x.test_z"]))
    assert part.command == ["python", "-m", "pytest", "-q", "a/test_x.py::test_y[a.b]", "a/test_x.py::test_z"]


@pytest.mark.parametrize("command, failures", [
    (["python", "-m", "pytest", "a/test_x.py"], ["ended badly after its last case"]),
    (["a/program"], ["Suite.bad"]),
])
def test_what_cannot_be_taken_apart_is_run_again_whole(command, failures):
    whole = result(command, failures)
    assert testing._failed_part(whole) is whole.test


@pytest.mark.parametrize("arguments, ros, debug, forwarded", [
    (["demo"], "kilted", False, []),
    (["demo", "--model", "ur5e", "--ros", "jazzy"], "jazzy", False, ["--model", "ur5e"]),
    (["demo", "--debug", "--speed", "0.1"], "kilted", True, ["--speed", "0.1"]),
    (["demo", "--help"], "kilted", False, ["--help"]),
    (["sim", "--", "--help"], "kilted", False, ["--help"]),
    (["sim", "--model", "ur3e"], "kilted", False, ["--model", "ur3e"]),
])
def test_options_a_command_does_not_know_go_to_its_program(arguments, ros, debug, forwarded):
    options = main._parse(arguments)
    assert (options.ros, options.debug, main._forwarded(options)) == (ros, debug, forwarded)
