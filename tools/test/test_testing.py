"""./ur test: a failure fails the run even if the repetition succeeds. Options are passed to the correct program."""

import json
import os
import pathlib
import subprocess
import sys
import time
from dataclasses import replace

import pytest
from ur_tools import main, packages, runner, schedule, summary, testing
from ur_tools.layout import Layout

REPORT = """<testsuites><testsuite>
<testcase name="good"/><testcase name="good_too" status="run"/>
<testcase classname="Suite" name="bad"><failure/></testcase><testcase classname="a.Suite" name="broken"><error/></testcase>
<testcase classname="Suite" name="left_out"><skipped message="file.cpp:7&#10;no device"/></testcase>
</testsuite></testsuites>"""


def test_passed_cases_of_a_report_are_counted_without_skipped_ones(tmp_path):
    report = tmp_path / "report.xml"
    report.write_text(REPORT)
    assert runner.read_cases(report, False, True) == runner.Cases(2, ["Suite.bad", "Suite.broken"], {"Suite.left_out": "no device"})


def test_a_program_without_a_report_is_one_case(tmp_path):
    assert runner.read_cases(tmp_path / "none.xml", True, False) == runner.Cases(1, [])
    assert runner.read_cases(tmp_path / "none.xml", False, False) == runner.Cases(0, [""])


def test_a_program_that_exits_before_its_report_has_failed(tmp_path):
    assert runner.read_cases(tmp_path / "none.xml", True, True) == runner.Cases(0, [""])


def test_a_program_that_runs_no_case_fails(tmp_path):
    report = tmp_path / "report.xml"
    report.write_text("<testsuite><testcase name='filtered' status='notrun'/></testsuite>")
    assert runner.read_cases(report, True, True) == runner.Cases(0, ["ran no case"])


def test_a_crash_after_passed_cases_is_a_failure(tmp_path):
    report = tmp_path / "report.xml"
    report.write_text("<testsuite><testcase name='good'/></testsuite>")
    assert runner.read_cases(report, False, True) == runner.Cases(1, ["failed after its last case"])


def test_files_of_the_same_name_have_different_test_names(tmp_path):
    for folder in ("typed", "nodes"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "test_shutdown.py").write_text("")
    found = testing._pytest(Layout.of_environment(), "driver", tmp_path)
    assert [test.name for test in found] == ["driver: nodes/test_shutdown", "driver: typed/test_shutdown"]


def ctest_of_pytest_files(package):
    listing = subprocess.run(["ctest", "--show-only=json-v1"], cwd=Layout.of_environment().build / package, check=True,
                             stdout=subprocess.PIPE, universal_newlines=True).stdout
    commands = [test["command"] for test in json.loads(listing)["tests"] if "pytest" in test.get("command", [])]
    return {pathlib.Path(part) for command in commands for part in command if part.endswith(".py") and "/test_" in part}


def test_colcon_test_runs_the_python_tests_of_every_package():
    folders = {name: package.folder / "test" for name, package in packages.discover().items()}
    files = {name: set(folder.rglob("test_*.py")) for name, folder in folders.items()}
    assert {name: ctest_of_pytest_files(name) for name, found in files.items() if found} == {name: found for name, found in
                                                                                             files.items() if found}


def test_a_file_that_measures_time_reserves_a_core(tmp_path):
    (tmp_path / "test_a.py").write_text("MEASURES_TIME = True\n")
    (tmp_path / "test_b.py").write_text("")
    tests = testing._pytest(Layout.of_environment(), "driver", tmp_path)
    times = schedule.Times(tmp_path / "durations.json")
    times.record("driver: test_a", 10.0, 1.0)
    times.record("driver: test_b", 10.0, 1.0)
    assert [testing._job(test, times).cost.load for test in tests] == [1.0, 0.1]


def test_a_file_may_declare_its_load(tmp_path):
    (tmp_path / "test_a.py").write_text("LOAD = 0.5  # cores\n")
    test, = testing._pytest(Layout.of_environment(), "driver", tmp_path)
    times = schedule.Times(tmp_path / "durations.json")
    times.record("driver: test_a", 10.0, 15.0)
    assert testing._job(test, times).cost == schedule.Cost(10.0, 0.5)


def test_a_background_test_has_a_low_priority(tmp_path, monkeypatch):
    (tmp_path / "test_a.py").write_text("BACKGROUND = True\n")
    test, = testing._pytest(Layout.of_environment(), "driver", tmp_path)
    assert testing._job(test, schedule.Times(tmp_path / "durations.json")).background
    # The program is still starting when its priority is lowered.
    program = "import os, time\ntime.sleep(0.5)\nprint(f'niceness {os.nice(0)}')\nraise SystemExit(1)"
    monkeypatch.setattr(runner, "ROOT", tmp_path)
    test = runner.Test("a: test", [sys.executable, "-c", program], tmp_path, 20.0, background=True)
    with runner.Runner(Layout.of_environment(), tmp_path) as started:
        output = started.run(test).output
    assert f"niceness {min(19, os.nice(0) + runner.BACKGROUND_NICENESS)}" in output


@pytest.mark.parametrize("period, thorough", [(-1.0, False), (60.0, True)])
def test_the_tests_know_whether_the_run_is_still_thorough(tmp_path, monkeypatch, period, thorough):
    monkeypatch.delenv("UR_TEST_THOROUGH", raising=False)
    monkeypatch.setattr(runner, "ROOT", tmp_path)
    test = runner.Test("a: test", ["sh", "-c", "echo thorough: $UR_TEST_THOROUGH; exit 1"], tmp_path, 20.0)
    with runner.Runner(Layout.of_environment(), tmp_path, thorough_until=time.monotonic() + period) as started:
        assert ("thorough: 1" in started.run(test).output) is thorough


def test_the_durations_of_an_interrupted_run_are_kept(tmp_path, monkeypatch):
    class InterruptedRunner:
        def run(self, test):
            if test.name == "a: second":
                raise KeyboardInterrupt
            return runner.Result(test, runner.Cases(1, []), 7.0, 1.4, "")

        def cancel(self):
            pass

    monkeypatch.setattr(Layout, "durations", tmp_path / "durations.json")
    tests = [runner.Test(name, ["a/program"], tmp_path, 1.0) for name in ("a: first", "a: second")]
    with pytest.raises(KeyboardInterrupt):
        testing._run_all(testing.Options(Layout(), jobs=1), InterruptedRunner(), tests)
    assert schedule.Times(tmp_path / "durations.json").cost("a: first", False) == schedule.Cost(7.0, 0.2)


def result(command, failures, skipped=None):
    return runner.Result(runner.Test("a: test", command, pathlib.Path(), 1.0), runner.Cases(3, failures, skipped or {}), 1.0, 0.1, "")


def test_only_the_failed_cases_of_a_file_are_repeated():
    part = testing._only_failed_cases(result(["python", "-m", "pytest", "-q", "a/test_x.py"],
                                             ["test_x.test_y[a.b]", "test_x.test_z"]))
    assert part.command == ["python", "-m", "pytest", "-q", "a/test_x.py::test_y[a.b]", "a/test_x.py::test_z"]


def test_the_files_of_a_group_run_in_one_process(tmp_path):
    for name, text in (("x", 'GROUP = "stops"\n'), ("y", ""), ("z", 'GROUP = "stops"\n')):
        (tmp_path / "typed").mkdir(exist_ok=True)
        (tmp_path / "typed" / f"test_{name}.py").write_text(text)
    group, alone = testing._in_groups(testing._pytest(Layout.of_environment(), "driver", tmp_path))
    assert (group.name, alone.name) == ("driver: typed/stops", "driver: typed/test_y")
    assert [file.name for file in group.files] == ["test_x.py", "test_z.py"] and group.limit == 2.0 * testing.PYTEST_LIMIT
    failed = testing._only_failed_cases(result(group.command, ["test_z.test_a[b.c]", "test_x.test_d"]))
    folder = tmp_path / "typed"
    assert failed.command == [*alone.command[:-1], f"{folder}/test_z.py::test_a[b.c]", f"{folder}/test_x.py::test_d"]


def test_a_single_selected_file_of_a_group_keeps_its_name(tmp_path):
    (tmp_path / "test_x.py").write_text('GROUP = "stops"\n')
    test, = testing._in_groups(testing._pytest(Layout.of_environment(), "driver", tmp_path))
    assert test.name == "driver: test_x"


def test_a_test_whose_failed_cases_have_no_names_is_repeated_as_a_whole():
    for whole in (result(["python", "-m", "pytest", "a/test_x.py"], ["failed after its last case"]), result(["a/program"], ["Suite.bad"])):
        assert testing._only_failed_cases(whole) is whole.test


class FakeRunner:
    """Determines which failures a repetition has."""

    def __init__(self, failures=()):
        self._failures, self.repeated = list(failures), []

    def run(self, test):
        self.repeated.append(test)
        return runner.Result(test, runner.Cases(1, self._failures), 1.0, 0.1, "")


def test_a_failed_case_fails_the_run_even_if_it_passes_alone(capsys):
    results = [result(["a/program"], ["Suite.bad"])]
    for failures, verdict in ((["Suite.bad"], "fails alone too"), ([runner.NO_REPORT], "fails alone too"),
                              ([], "passes alone: depends on load or on other tests")):
        verdicts = testing._diagnose(FakeRunner(failures), results)
        assert summary.report(results, [], verdicts, 1.0) == 1
        lines = capsys.readouterr().out.splitlines()
        assert f"    a: test Suite.bad ({verdict})" in lines
        assert lines[-1] == "3 passed, 1 failed"


def test_skipped_cases_are_named_with_their_reason_and_fail_in_continuous_integration(capsys, monkeypatch):
    for ci, reason, status in (("true", "no device", 1), ("", "no device", 0), ("true", summary.EXPECTED_SKIPS[0], 0)):
        monkeypatch.setenv("CI", ci)
        results = [result(["a/program"], [], {f"Suite.part{number}": reason for number in range(5)}), result(["b"], [])]
        assert summary.report(results, [], {}, 1.0) == status, (ci, reason)
        text = capsys.readouterr().out
        assert f"Skipped: 5\n    5: {reason}" in text and "        a: test Suite.part0\n" in text and "        and 2 more\n" in text
        assert ("not expected with CI=true" in text) == (status == 1)
        assert text.splitlines()[-1] == "6 passed, 0 failed"


def test_results_without_failures_and_those_at_their_time_limit_are_not_repeated():
    assert testing._diagnose(None, [result(["a/program"], []), replace(result(["a/program"], ["Suite.bad"]), in_time=False)]) == {}


def test_the_repetition_of_failures_is_bounded(capsys):
    started = FakeRunner()
    failed = result(["a/program"], ["Suite.bad"])
    slow = replace(failed, test=replace(failed.test, limit=1200.0), seconds=50.0)
    testing._diagnose(started, [failed, slow] + [failed] * 5)
    assert [test.limit for test in started.repeated] == [1.0, 100.0, 1.0, 1.0, 1.0]
    assert "2 more failed tests are not repeated" in capsys.readouterr().out


def run_program(tmp_path, monkeypatch, program, limit=20.0):
    monkeypatch.setattr(runner, "ROOT", tmp_path)  # log files are named relative to it
    test = runner.Test("a: test", [sys.executable, "-c", program], tmp_path, limit)
    with runner.Runner(Layout(Layout.of_environment().ros), tmp_path) as started:  # a sanitizer prolongs the limits
        return started.run(test)


def test_the_processor_time_of_a_test_includes_its_child_processes(tmp_path, monkeypatch):
    busy = "import time\nwhile time.process_time() < 0.3: pass"
    found = run_program(tmp_path, monkeypatch, f"import subprocess, sys; subprocess.run([sys.executable, '-c', {busy!r}])")
    assert found.cases == runner.Cases(1, [])
    assert 0.25 < found.processor_seconds < found.seconds + 0.1


def test_a_program_that_fails_is_reported_with_the_reason(tmp_path, monkeypatch):
    for program, limit, explanation in (
            ("import time; time.sleep(60)", 0.3, "stopped at its time limit of 0.3 s"),
            ("import os, signal; os.kill(os.getpid(), signal.SIGABRT)", 20.0, "ended by signal 6"),
            ("print('the reason'); raise SystemExit(3)", 20.0, "the reason")):
        found = run_program(tmp_path, monkeypatch, program, limit)
        assert found.cases == runner.Cases(0, [""]) and explanation in found.output, found.output


def test_a_case_that_hangs_is_named_before_the_time_limit(tmp_path):
    file = tmp_path / "test_a.py"
    file.write_text("import time\n\n\ndef test_hangs():\n    time.sleep(120.0)\n")
    test, = testing._pytest(Layout.of_environment(), "a", tmp_path)
    command = [sys.executable, *runner._command(test, tmp_path / "report.xml", 0.4)[1:]]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as running:
        assert any("in test_hangs" in line for line in running.stdout)
        running.kill()


def test_each_copy_of_a_repeated_program_has_its_own_report(tmp_path, monkeypatch):
    monkeypatch.setattr(runner, "ROOT", tmp_path)
    program = ("import pathlib, sys; path = pathlib.Path(sys.argv[1].partition(':')[2]); "
               "path.write_text('<testsuite><testcase name=\"a\"/></testsuite>'); print(path)")
    test = runner.Test("a: test", [sys.executable, "-c", program, "--gtest_output=xml:shared.xml"], tmp_path, 20.0)
    with runner.Runner(Layout(Layout.of_environment().ros), tmp_path) as started:
        results = [started.run(test) for _unused in range(2)]
    assert [found.cases for found in results] == [runner.Cases(1, [])] * 2
    assert len({found.output.split()[0] for found in results}) == 2


def test_unknown_options_of_a_command_are_forwarded_to_its_program():
    current = Layout.of_environment().ros
    for arguments, ros, debug, jobs, forwarded in (("demo --model ur5e --ros kilted", "kilted", False, 0, ["--model", "ur5e"]),
                                                   ("demo --debug --speed 0.1", current, True, 0, ["--speed", "0.1"]),
                                                   ("demo --speed 0.1 -j4", current, False, 4, ["--speed", "0.1"]),
                                                   ("demo -j 4 --jog", current, False, 4, ["--jog"]),
                                                   ("demo --help", current, False, 0, ["--help"]),
                                                   ("sim -- --help", current, False, 0, ["--help"])):
        options = main._parse(arguments.split())
        assert (options.ros, options.debug, options.jobs, main._forwarded(options)) == (ros, debug, jobs, forwarded), arguments
