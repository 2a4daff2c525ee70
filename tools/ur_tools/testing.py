"""Runs every test of every package: those CTest knows, each pytest file, and the checks of the sources."""

import json
import os
import pathlib
import re
import signal
import subprocess
import threading
import time
import xml.etree.ElementTree as xml
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, field, replace
from typing import Dict, List, Optional

from . import build as building
from . import boilerplate, isolation, lint, say, selection
from .environment import run_environment
from .layout import ROOT, SANITIZERS, Layout
from .lock import Lock
from .packages import Package, discover
from .processes import end_group

DEFAULT_LIMIT = 120.0
PYTEST_LIMIT = 600.0
SANITIZED_PATIENCE = 4.0  # their programs are slower by about that
SANITIZED_REAL_TIME_FACTOR = 0.5  # and the simulated robot's time passes slower, or all of them are late for each cycle


@dataclass
class Options:
    layout: Layout
    names: List[str] = field(default_factory=list)  # parts of test names; empty: all tests
    changed: bool = False
    base: str = ""  # for `changed`
    jobs: int = 0
    timeout: float = 0.0
    repeat: int = 1


@dataclass
class Test:
    name: str
    command: List[str]
    folder: pathlib.Path
    limit: float
    env: Dict[str, str] = field(default_factory=dict)


@dataclass
class Result:
    test: Test
    passed: int
    failures: List[str]
    seconds: float
    output: str
    failed_at_first: List[str] = field(default_factory=list)  # passed when run again, alone


# --- What there is to run ---------------------------------------------------------------------------------------------


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
            raise say.Failure(f"{package.name}: the test {entry['name']} has no program; was it built?")
        if any("pytest" in part for part in command):
            continue  # those files are run below, one by one
        properties = {item["name"]: item["value"] for item in entry.get("properties", [])}
        if properties.get("DISABLED"):
            continue
        env = dict(pair.split("=", 1) for pair in properties.get("ENVIRONMENT", []))
        tests.append(Test(f"{package.name}: {entry['name']}", command,
                          pathlib.Path(properties.get("WORKING_DIRECTORY", folder)),
                          float(properties.get("TIMEOUT", DEFAULT_LIMIT)), env))
    return tests


def _pytest(layout: Layout, name: str, folder: pathlib.Path) -> List[Test]:
    # The cache folder would otherwise be written into the sources.
    command = [str(layout.python), "-m", "pytest", "-q", "-p", "no:cacheprovider", "--color=no", "-ra", "--disable-warnings"]
    return [Test(f"{name}: {file.stem}", [*command, str(file)], ROOT, PYTEST_LIMIT)
            for file in sorted(folder.rglob("test_*.py"))]


def _path_of(test: Test) -> pathlib.Path:
    """Returns the pytest file or the test program."""
    return pathlib.Path(test.command[-1] if "pytest" in test.command else test.command[0])


def _collect(options: Options, packages: Dict[str, Package], chosen: selection.Selection) -> List[Test]:
    layout = options.layout
    names = list(packages)
    tests: List[Test] = []
    for name, folder in selection.test_folders(packages).items():
        if name in packages or chosen.packages is None:
            tests += _pytest(layout, name, folder)
    for name in names:
        tests += _ctest(layout, packages[name])
    tests = [test for test in tests if chosen.chooses(test.name.split(":")[0], test.name, _path_of(test))]
    return [test for test in tests for _unused in range(options.repeat)]


def _select(options: Options) -> selection.Selection:
    packages = discover()
    if options.changed:
        return selection.by_change(options.base or selection.default_base(), packages)
    return selection.by_name(options.names, packages) if options.names else selection.everything()


# --- Running one ------------------------------------------------------------------------------------------------------


def _cases(report: pathlib.Path, succeeded: bool) -> "tuple[int, List[str]]":
    """How many cases of a JUnit report (GoogleTest's or pytest's) passed, and the names of those that did not.

    A program without a report is one case, without a name.
    """
    try:
        tree = xml.parse(report).getroot()
    except (OSError, xml.ParseError):
        return (1, []) if succeeded else (0, [""])
    passed, failures = 0, []
    for case in tree.iter("testcase"):
        if case.find("failure") is not None or case.find("error") is not None:
            failures.append(f"{case.get('classname', '').split('.')[-1]}.{case.get('name')}")
        elif case.find("skipped") is None and case.get("status") != "notrun":
            passed += 1
    if not succeeded and not failures:
        failures.append("ended badly after its last case")
    return passed, failures


def _report_of(test: Test, base: pathlib.Path) -> pathlib.Path:
    """Where the test writes its report: where its own command says, else where we ask for it."""
    for part in test.command:
        if part.startswith("--gtest_output=xml:"):
            return pathlib.Path(part.split(":", 1)[1])
    return base.with_suffix(".xml")


def _sanitizer_environment() -> Dict[str, str]:
    suppressions = ROOT / "tools" / "sanitizers" / "thread.txt"
    return {"ASAN_OPTIONS": "detect_leaks=0:strict_string_checks=1:detect_stack_use_after_return=1",
            "UBSAN_OPTIONS": "print_stacktrace=1",
            "TSAN_OPTIONS": f"halt_on_error=1:second_deadlock_stack=1:suppressions={suppressions}"}


class Runner:
    def __init__(self, options: Options, folder: pathlib.Path):
        self._options = options
        self._folder = folder
        self._env = run_environment(options.layout)
        self._env.update(_sanitizer_environment())
        self._patience = 1.0
        if options.layout.variant in SANITIZERS:
            self._patience = SANITIZED_PATIENCE
            self._env["UR_TEST_CELLS"] = "1"
            self._env["UR_TEST_REAL_TIME_FACTOR"] = str(SANITIZED_REAL_TIME_FACTOR)
        self._env["UR_TEST_PATIENCE"] = str(self._patience)
        self._env["ROS_LOG_DIR"] = str(folder / "ros")
        self._env["PYTHONDONTWRITEBYTECODE"] = "1"
        self._env["UR_LAYOUT"] = f"{options.layout.ros}:{options.layout.variant}"
        self._env[isolation.MARK] = str(os.getpid())
        self._lock = threading.Lock()
        self._count = 0
        self._running: "set[subprocess.Popen[bytes]]" = set()
        self._cancelled = False

    def run(self, test: Test) -> Optional[Result]:
        with self._lock:
            if self._cancelled:
                return None
            self._count += 1
            base = self._folder / f"{self._count:04d}-{re.sub(r'[^A-Za-z0-9_.]+', '-', test.name)[:80]}"
        with isolation.Domain() as domain:
            return self._run(test, base, domain)

    def _run(self, test: Test, base: pathlib.Path, domain: isolation.Domain) -> Result:
        report, log = _report_of(test, base), base.with_suffix(".log")
        if report.exists():
            report.unlink()  # an earlier run's
        env = {**self._env, **domain.environment(), **test.env, "GTEST_OUTPUT": f"xml:{report}", "GTEST_COLOR": "no"}
        command = test.command + ([f"--junitxml={report}"] if "pytest" in test.command else [])
        limit = self._options.timeout or self._patience * test.limit
        start = time.monotonic()
        with log.open("wb") as output:
            process = subprocess.Popen(command, cwd=test.folder, env=env, stdin=subprocess.DEVNULL, stdout=output,
                                       stderr=subprocess.STDOUT, start_new_session=True)
        with self._lock:
            self._running.add(process)
        late = False
        try:
            process.wait(limit)
        except subprocess.TimeoutExpired:
            late = True
        end_group(process)
        with self._lock:
            self._running.discard(process)
        passed, failures = _cases(report, process.returncode == 0 and not late)
        text = log.read_text(errors="replace")
        if late:
            text += f"\nstopped after its limit of {limit:g} s\n"
        elif process.returncode < 0:
            text += f"\nended by signal {-process.returncode}\n"
        return Result(test, passed, failures, time.monotonic() - start, text + f"(log: {log.relative_to(ROOT)})\n")

    def cancel(self) -> None:
        with self._lock:
            self._cancelled = True
            running = list(self._running)
        for process in running:
            end_group(process)


# --- All of them --------------------------------------------------------------------------------------------------------


def _durations(file: pathlib.Path) -> Dict[str, float]:
    try:
        return json.loads(file.read_text())
    except (OSError, ValueError):
        return {}


def _run_all(options: Options, tests: List[Test], folder: pathlib.Path) -> List[Result]:
    known_file = options.layout.base / "durations.json"
    known = _durations(known_file)
    # The longest first, so that none runs alone at the end; pytest files stand in front while nothing is known.
    tests = sorted(tests, key=lambda test: -known.get(test.name, 10.0 if "pytest" in test.command else 0.0))
    runner = Runner(options, folder)
    jobs = options.jobs or len(os.sched_getaffinity(0))
    results: List[Result] = []
    status = say.Status()
    with ThreadPoolExecutor(jobs) as pool:
        futures = [pool.submit(runner.run, test) for test in tests]
        try:
            for future in as_completed(futures):
                result = future.result()
                if result is None:
                    continue
                results.append(result)
                known[result.test.name] = round(result.seconds, 2)
                _report(status, result, len(results), len(tests))
        except BaseException:
            runner.cancel()
            raise
        finally:
            status.clear()
        if options.repeat == 1:
            results = [_once_more(runner, status, result) for result in results]
    known_file.write_text(json.dumps(known, indent=0, sort_keys=True))
    return results


def _failed_part(result: Result) -> Test:
    """Of a pytest file the cases that failed, so that each has one more chance and not one together; else all of it."""
    file = pathlib.Path(result.test.command[-1])
    if "pytest" not in result.test.command or not all(case.startswith(f"{file.stem}.") for case in result.failures):
        return result.test
    cases = [f"{file}::{case[len(file.stem) + 1:]}" for case in result.failures]
    return replace(result.test, command=[*result.test.command[:-1], *cases])


def _once_more(runner: Runner, status: say.Status, result: Result) -> Result:
    """A test that failed beside others gets one more run with the machine to itself, and the summary says so."""
    if not result.failures:
        return result
    status.show(f"once more, alone: {result.test.name}")
    part = _failed_part(result)
    alone = runner.run(part)
    if alone is None:
        return result
    if alone.failures:
        status.keep(f"FAILED AGAIN  {result.test.name}")
        status.keep("\n".join("        " + text for text in say.tail(alone.output, 60).splitlines()))
    if part is not result.test:
        alone.passed += result.passed
    alone.failed_at_first = [case for case in result.failures if case not in alone.failures]
    return alone


def _report(status: say.Status, result: Result, done: int, total: int) -> None:
    if result.failures:
        status.keep(f"FAILED  {result.test.name} ({result.seconds:.1f} s)")
        status.keep("\n".join("        " + text for text in say.tail(result.output, 60).splitlines()))
    status.show(f"{done}/{total} {result.test.name}")


def _summary(results: List[Result], checks: List[lint.Check], seconds: float) -> int:
    passed = sum(result.passed for result in results) + sum(1 for check in checks if check.ok)
    failed = sum(len(result.failures) for result in results) + sum(1 for check in checks if not check.ok)
    say.line("")
    by_package: Dict[str, List[Result]] = {}
    for result in results:
        by_package.setdefault(result.test.name.split(":")[0], []).append(result)
    for name, group in sorted(by_package.items()):
        say.line(f"    {name:28} {sum(r.passed for r in group):5} passed {sum(len(r.failures) for r in group):4} failed")
    bad = sorted({f"{result.test.name} {case}".rstrip() for result in results for case in result.failures}
                 | {check.name for check in checks if not check.ok})
    shaky = sorted(f"{result.test.name} {case}".rstrip() for result in results for case in result.failed_at_first)
    if shaky:
        say.line("Failed beside other tests, passed alone:")
        for name in shaky:
            say.line(f"    {name}")
    if bad:
        say.line("Failed:")
        for name in bad:
            say.line(f"    {name}")
    say.line(f"{seconds:.0f} s")
    say.line(f"{passed} passed, {failed} failed")
    return 1 if failed or passed == 0 else 0


def run(options: Options) -> int:
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)  # begun with "&": programs under test would inherit it
    chosen = _select(options)
    if chosen.packages == [] and options.changed:
        building.setup(options.layout)
        return _run_selected(options, chosen, {})
    return _run_selected(options, chosen,
                         building.build(building.Options(options.layout, chosen.packages, True, options.jobs)))


def _run_selected(options: Options, chosen: selection.Selection, packages: Dict[str, Package]) -> int:
    start = time.monotonic()
    with Lock("test"):
        tests = _collect(options, packages, chosen)
        if options.names and not tests:
            raise say.Failure(f"no test has {' or '.join(options.names)} in its name")
        folder = isolation.fresh_folder(options.layout.base / "test")
        checks = [] if options.names else lint.checks(options.layout)
        for check in checks:
            if not check.ok:
                say.line(f"FAILED  {check.name}\n{check.text}")
        say.step(f"Running {len(tests)} test{'s' * (len(tests) != 1)}")
        with isolation.CleanUp():
            results = _run_all(options, tests, folder)
    if not (options.names or options.changed):
        say.line("\n" + boilerplate.table())
    return _summary(results, checks, time.monotonic() - start)
