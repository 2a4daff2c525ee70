"""./ur test: runs every test of every package (GoogleTest cases, pytest files) and the checks of the sources."""

import ast
import json
import pathlib
import re
import signal
import subprocess
import time
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, field, replace
from typing import Dict, List

from . import browser, console, isolation, lint, machine, selection, summary
from . import build as building
from .layout import ROOT, Layout
from .lock import Lock
from .packages import Package, discover
from .runner import PROGRAM_FAILURES, Result, Runner, Test
from .schedule import Job, Schedule, Times
from .summary import case_name

DEFAULT_LIMIT = 120.0
PYTEST_LIMIT = 1200.0
# Lines of a pytest file that set the field of the same name of its Test.
MARKERS = re.compile(r"^(MEASURES_TIME|BACKGROUND|BROWSER|LOAD|GROUP) = (True|\d+\.\d+|\"\w+\")", re.M)
BACKGROUND_LABEL = "background"  # of a CTest test: the same as BACKGROUND
LAST_LABEL = "last"  # of a CTest test: a background test that starts when no other test waits
THOROUGH_PERIOD = 3600.0  # s, from the start of the build: on a slow host, fuzz replays that start later are short
SHOWN_LINES = 60  # of a failed test's output
MAX_DIAGNOSED = 5  # failed tests that are repeated alone
DIAGNOSIS_LIMIT = 60.0  # s, or twice the duration of the test, for a repetition
FAILS_ALONE, PASSES_ALONE = "fails alone too", "passes alone: depends on load or on other tests"


@dataclass
class Options:
    layout: Layout
    names: List[str] = field(default_factory=list)  # parts of test names; empty: all tests
    changed: bool = False
    base: str = ""  # for `changed`
    jobs: int = 0
    timeout: float = 0.0
    repeat: int = 1
    thorough: bool = False


# --- Collecting -------------------------------------------------------------------------------------------------------


def _ctest(layout: Layout, package: Package) -> List[Test]:
    folder = layout.build / package.name
    if not (folder / "CTestTestfile.cmake").is_file():
        return []
    listing = subprocess.run([str(layout.venv / "bin" / "ctest"), "--show-only=json-v1"], cwd=folder, check=True,
                             stdout=subprocess.PIPE, universal_newlines=True).stdout
    tests = []
    for entry in json.loads(listing)["tests"]:
        command = entry.get("command")
        if not command:
            raise console.Failure(f"{package.name}: the test {entry['name']} has no program; was it built?")
        if "pytest" in command:
            continue  # _pytest() collects these files
        properties = {item["name"]: item["value"] for item in entry.get("properties", [])}
        if properties.get("DISABLED"):
            continue
        labels = properties.get("LABELS", [])
        env = dict(pair.split("=", 1) for pair in properties.get("ENVIRONMENT", []))
        tests.append(Test(f"{package.name}: {entry['name']}", command,
                          pathlib.Path(properties.get("WORKING_DIRECTORY", folder)),
                          float(properties.get("TIMEOUT", DEFAULT_LIMIT)), env, bool(properties.get("RUN_SERIAL")),
                          background=BACKGROUND_LABEL in labels or LAST_LABEL in labels, last=LAST_LABEL in labels))
    return tests


def _pytest(layout: Layout, name: str, folder: pathlib.Path) -> List[Test]:
    # Without the cache provider, which writes into the sources.
    command = [str(layout.python), "-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "ur_tools.host_stalls", "--color=no", "-ra",
               "--disable-warnings"]
    tests = []
    for file in sorted(folder.rglob("test_*.py")):
        markers = {marker.lower(): ast.literal_eval(value) for marker, value in MARKERS.findall(file.read_text())}
        tests.append(Test(f"{name}: {file.relative_to(folder).with_suffix('')}", [*command, str(file)], ROOT, PYTEST_LIMIT,
                          **markers))
    return tests


def _collect(options: Options, packages: Dict[str, Package], chosen: selection.Selection) -> List[Test]:
    tests: List[Test] = []
    for name, folder in selection.test_folders(packages).items():
        if name in packages or chosen.packages is None:
            tests += _pytest(options.layout, name, folder)
    for package in packages.values():
        tests += _ctest(options.layout, package)
    tests = _in_groups([test for test in tests if chosen.chooses(test.package, test.name, test.path)])
    return [test for test in tests for _unused in range(options.repeat)]


def _in_groups(tests: List[Test]) -> List[Test]:
    """Combines the pytest files of each group into one test, whose files share the fixtures with the scope of a session."""
    groups: Dict[str, List[Test]] = {}
    for test in tests:
        name = f"{test.name.rpartition('/')[0]}/{test.group}" if test.group else test.name
        groups.setdefault(name, []).append(test)
    return [_combined(name, members) for name, members in groups.items()]


def _combined(name: str, tests: List[Test]) -> Test:
    if len(tests) == 1:
        return tests[0]
    command = [*tests[0].command[:-1], *(str(test.path) for test in tests)]
    return replace(tests[0], name=name, command=command, limit=sum(test.limit for test in tests))


def _select(options: Options) -> selection.Selection:
    packages = discover()
    if options.changed:
        return selection.by_change(options.base or selection.default_base(), packages)
    return selection.by_name(options.names, packages) if options.names else selection.everything()


# --- Running ----------------------------------------------------------------------------------------------------------


def _job(test: Test, times: Times) -> Job:
    cost = times.cost(test.name, test.is_pytest)
    load = max(cost.load, float(test.measures_time)) if test.load is None else test.load
    return Job(test, replace(cost, load=load), test.exclusive, test.background, test.last)


def _run_all(options: Options, runner: Runner, tests: List[Test]) -> List[Result]:
    times = Times(options.layout.durations)
    schedule = Schedule([_job(test, times) for test in tests], machine.cores(), options.jobs)
    results: List[Result] = []
    status = console.Status()
    with ThreadPoolExecutor(schedule.most) as pool:
        running: "Dict[Future, Job]" = {}
        try:
            while schedule:
                job = schedule.take()
                if job is not None:
                    running[pool.submit(runner.run, job.what)] = job
                    continue
                for future in wait(running, return_when=FIRST_COMPLETED).done:
                    schedule.end(running.pop(future))
                    result = future.result()
                    if result is not None:
                        results.append(result)
                        times.record(result.test.name, result.seconds, result.processor_seconds)
                        _report(status, result, len(results), len(tests))
        except BaseException:
            runner.cancel()
            raise
        finally:
            status.clear()
            times.write()
    return results


def _report(status: console.Status, result: Result, done: int, total: int) -> None:
    for text in result.repeats:
        status.keep(text)
    if result.cases.failures:
        status.keep(f"FAILED  {result.test.name} ({result.seconds:.1f} s)")
        status.keep("\n".join("        " + text for text in console.tail(result.output, SHOWN_LINES).splitlines()))
    status.show(f"{done}/{total} {result.test.name}")


# --- Diagnosing failures ----------------------------------------------------------------------------------------------


def _only_failed_cases(result: Result) -> Test:
    """Returns the test reduced to the failed cases if it consists of pytest files, otherwise the whole test."""
    test = result.test
    files = {file.stem: file for file in test.files}
    cases = [case.partition(".") for case in result.cases.failures]
    if not all(file in files and name for file, _, name in cases):
        return test
    return replace(test, command=[*test.command[:-len(files)], *(f"{files[file]}::{name}" for file, _, name in cases)])


def _diagnose(runner: Runner, results: List[Result]) -> Dict[str, str]:
    """Repeats the first failed tests alone. Returns, for each failed case, whether it fails then; the results remain as they are."""
    verdicts: Dict[str, str] = {}
    failed = [result for result in results if result.cases.failures and result.in_time]
    for result in failed[:MAX_DIAGNOSED]:
        console.line(f"repeating alone, as a diagnosis: {result.test.name}")
        alone = runner.run(replace(_only_failed_cases(result), limit=min(result.test.limit, max(DIAGNOSIS_LIMIT, 2.0 * result.seconds))))
        if alone is None:
            break
        for case in result.cases.failures:
            fails = {case, *PROGRAM_FAILURES} & set(alone.cases.failures)
            verdicts[case_name(result, case)] = FAILS_ALONE if fails else PASSES_ALONE
    if len(failed) > MAX_DIAGNOSED:
        console.line(f"{len(failed) - MAX_DIAGNOSED} more failed tests are not repeated")
    return verdicts


def run(options: Options) -> int:
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's "&" ignores it, and tests would inherit that
    return _run_selected(options, _select(options))


def _build(options: Options, chosen: selection.Selection) -> Dict[str, Package]:
    if chosen.packages == [] and options.changed:
        building.setup(options.layout)
        return {}
    packages = building.build(building.Options(options.layout, chosen.packages, True, options.jobs))
    if "ur_ros_rtde_viewer" in packages:
        building.setup_viewer(options.layout)
    return packages


def _runner(options: Options, thorough_until: float) -> Runner:
    folder = isolation.fresh_folder(options.layout.base / "test")
    return Runner(options.layout, folder, options.timeout, thorough_until)


def _run_selected(options: Options, chosen: selection.Selection) -> int:
    with Lock("build"):  # until the end of the tests: a build would change their programs
        thorough_until = time.monotonic() + THOROUGH_PERIOD if options.thorough else 0.0
        packages = _build(options, chosen)
        start = time.monotonic()
        tests = _collect(options, packages, chosen)
        if options.names and not tests:
            raise console.Failure(f"no test has {' or '.join(options.names)} in its name")
        if any(test.browser for test in tests):
            provided = browser.environment(options.layout)
            tests = [replace(test, env={**test.env, **provided}) if test.browser else test for test in tests]
        checks = [] if options.names else lint.checks(options.layout)
        for check in checks:
            if not check.ok:
                console.line(f"FAILED  {check.name}\n{check.text}")
        console.step(f"Running {len(tests)} test{'s' * (len(tests) != 1)}")
        with isolation.CleanUp(), _runner(options, thorough_until) as runner:
            results = _run_all(options, runner, tests)
            if 0.0 < thorough_until < time.monotonic():
                console.line(f"Fuzz replays that started after {THOROUGH_PERIOD / 60.0:.0f} min were short.")
            verdicts = _diagnose(runner, results) if options.repeat == 1 else {}
    return summary.report(results, checks, verdicts, time.monotonic() - start)
