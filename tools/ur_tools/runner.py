"""Runs one test at a time, in a ROS domain of its own, and reads which of its cases passed."""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import threading
import time
import xml.etree.ElementTree as xml
from dataclasses import dataclass, field, replace
from typing import Dict, List, Optional, Set

from . import isolation
from .environment import fastdds_profile, run_environment
from .layout import ROOT, SANITIZERS, Layout
from .processes import end_group
from .stall_watch import REPEATS, SANITIZER_STATUS, StallWatch, failure

BACKGROUND_NICENESS = 10  # of background tests: they get about a tenth of a core that other tests use all the time
LOWEST_PRIORITY = 19
TOOLS = pathlib.Path(__file__).resolve().parents[1]
SANITIZED_PATIENCE = 4.0  # programs with a sanitizer are slower by about this factor
SANITIZED_REAL_TIME_FACTOR = 0.5  # lets the simulated robot's time pass at half speed, so that its cycles are not late
LEAVING_LIMIT = 5.0  # s, in which the processes of a test have to end after it
# Failures of a program besides those of its cases.
NO_REPORT, AFTER_LAST_CASE, NO_CASE, LEFT_BEHIND = "", "failed after its last case", "ran no case", "left processes behind"
PROGRAM_FAILURES = {NO_REPORT, AFTER_LAST_CASE, NO_CASE, LEFT_BEHIND}
STALLED = re.compile(r"^failed while the host stalled for .*$", re.M)  # stall_watch.failure()


@dataclass
class Test:
    """One or more pytest files, a GoogleTest case or a program."""

    name: str
    command: List[str]
    folder: pathlib.Path
    limit: float  # s
    env: Dict[str, str] = field(default_factory=dict)
    exclusive: bool = False  # runs while no other test does
    background: bool = False  # runs with low priority beside the other tests: its result does not depend on its speed
    last: bool = False  # a background test that starts when no other test waits
    measures_time: bool = False  # is given a core, even if it uses less
    browser: bool = False  # needs a browser: see browser.py
    load: Optional[float] = None  # cores that it is given; None: its measured load
    group: str = ""  # of pytest files that run in one process

    @property
    def package(self) -> str:
        return self.name.split(":")[0]

    @property
    def is_pytest(self) -> bool:
        return "pytest" in self.command

    @property
    def writes_report(self) -> bool:
        """GoogleTest and pytest do, fuzz replays do not."""
        return "test" in self.path.name

    @property
    def path(self) -> pathlib.Path:
        """The pytest file or the program."""
        return pathlib.Path(self.command[-1] if self.is_pytest else self.command[0])

    @property
    def files(self) -> List[pathlib.Path]:
        """The pytest files."""
        return [pathlib.Path(part) for part in self.command if self.is_pytest and part.endswith(".py")]


@dataclass
class Cases:
    """What became of the cases of a test."""

    passed: int
    failures: List[str]  # names
    skipped: Dict[str, str] = field(default_factory=dict)  # reasons by name


@dataclass
class Result:
    test: Test
    cases: Cases
    seconds: float
    processor_seconds: float  # of all its processes
    output: str
    repeats: List[str] = field(default_factory=list)  # lines about tests that failed while the host stalled, and were repeated
    in_time: bool = True
    status: int = 0  # of the process, as Popen.returncode

    @property
    def has_failed_assertions(self) -> bool:
        """Whether a program of GoogleTest has reported failed cases, and nothing else has failed: no crash, no report of a sanitizer."""
        return self.in_time and self.status == 1 and bool(self.cases.failures) and not PROGRAM_FAILURES & set(self.cases.failures)


def read_cases(report: pathlib.Path, succeeded: bool, writes_report: bool) -> Cases:
    """Reads a JUnit report (GoogleTest's or pytest's). A program that writes none counts as one case, without a name."""
    try:
        tree = xml.parse(report).getroot()
    except (OSError, xml.ParseError):
        return Cases(1, []) if succeeded and not writes_report else Cases(0, [NO_REPORT])
    found = Cases(0, [])
    cases = {f"{case.get('classname', '').split('.')[-1]}.{case.get('name')}": case for case in tree.iter("testcase")}
    for name, case in cases.items():  # the last attempt of each
        skipped = case.find("skipped")
        if case.find("failure") is not None or case.find("error") is not None:
            found.failures.append(name)
        elif skipped is not None:
            found.skipped[name] = skipped.get("message", "").rpartition("\n")[2] or "no reason"  # GoogleTest's begins with its place
        elif case.get("status") != "notrun":
            found.passed += 1
    if not (found.passed or found.failures or found.skipped):
        found.failures.append(NO_CASE)
    elif not succeeded and not found.failures:
        found.failures.append(AFTER_LAST_CASE)
    return found


def _command(test: Test, report: pathlib.Path, limit: float) -> List[str]:
    """Returns the command of the test with this report. pytest shows what it is doing at half of the limit, s."""
    if test.is_pytest:
        return [*test.command, f"--junitxml={report}", "-o", f"faulthandler_timeout={limit / 2.0:g}"]
    output = f"--gtest_output=xml:{report}"
    return [output if part.startswith("--gtest_output=") else part for part in test.command]


def _sanitizer_environment() -> Dict[str, str]:
    suppressions = ROOT / "tools" / "sanitizers" / "thread.txt"
    status = f"exitcode={SANITIZER_STATUS}"
    return {"ASAN_OPTIONS": f"{status}:detect_leaks=0:strict_string_checks=1:detect_stack_use_after_return=1",
            "UBSAN_OPTIONS": f"{status}:print_stacktrace=1",
            "TSAN_OPTIONS": f"{status}:halt_on_error=1:second_deadlock_stack=1:suppressions={suppressions}"}


def _wait(process: "subprocess.Popen[bytes]", limit: float) -> bool:
    """Returns whether the process exits within the limit, s. It remains a zombie, so that its times can be read."""
    deadline, pause = time.monotonic() + limit, 0.001
    try:
        while os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None:
            if time.monotonic() > deadline:
                return False
            time.sleep(pause)
            pause = min(2.0 * pause, 0.02)
    except ChildProcessError:
        pass  # cancel() has waited for it
    return True


def _processor_seconds(pid: int) -> float:
    """Returns the processor time of a process, and of the children that it has waited for, in s."""
    try:
        fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")


def _bytecode_folder(layout: Layout) -> pathlib.Path:
    """Returns where Python caches its bytecode: not beside the sources. The bytecode of earlier temporary files is removed."""
    folder = layout.base / "bytecode"
    temporary = pathlib.Path(tempfile.gettempdir()).resolve()
    shutil.rmtree(folder / temporary.relative_to(temporary.anchor), ignore_errors=True)
    return folder


def _lower_priority(pid: int) -> None:
    """Lets the processes of other tests run before this process and the children that it will start."""
    try:
        os.setpriority(os.PRIO_PROCESS, pid, min(LOWEST_PRIORITY, os.getpriority(os.PRIO_PROCESS, 0) + BACKGROUND_NICENESS))
    except ProcessLookupError:
        pass  # it has exited


class Runner:
    """Runs tests of one build. `run` may be called from several threads."""

    def __init__(self, layout: Layout, folder: pathlib.Path, limit: float = 0.0, thorough_until: float = 0.0):
        """`folder` receives the logs. `limit` replaces the limits of the tests, s; 0: none.

        Tests that start before `thorough_until`, on the monotonic clock, are thorough."""
        self._folder, self._limit, self._thorough_until = folder, limit, thorough_until
        self._env = {**run_environment(layout), **fastdds_profile(layout), **_sanitizer_environment()}
        self._patience = 1.0
        if layout.variant in SANITIZERS:
            self._patience = SANITIZED_PATIENCE
            self._env["UR_TEST_CELLS"] = "1"
            self._env["UR_TEST_REAL_TIME_FACTOR"] = str(SANITIZED_REAL_TIME_FACTOR)
        self._env["UR_TEST_PATIENCE"] = str(self._patience)
        self._env["ROS_LOG_DIR"] = str(folder / "ros")
        self._env.pop("PYTHONDONTWRITEBYTECODE", None)
        self._env["PYTHONPATH"] = os.pathsep.join([self._env["PYTHONPATH"], str(TOOLS)])  # for host_stalls.py
        self._env["PYTHONPYCACHEPREFIX"] = str(_bytecode_folder(layout))
        self._env["UR_LAYOUT"] = f"{layout.ros}:{layout.variant}"
        self._watch = StallWatch()
        self._lock = threading.Lock()
        self._count = 0
        self._running: "Set[subprocess.Popen[bytes]]" = set()
        self._cancelled = False

    def __enter__(self) -> "Runner":
        return self

    def __exit__(self, *_unused: object) -> None:
        self._watch.close()

    def run(self, test: Test) -> Optional[Result]:
        """Repeats the test if it failed while the host stalled. Returns None after cancel()."""
        repeats: List[str] = []
        while True:
            begin = time.monotonic()
            result = self._run_once(test)
            if result is None:
                return None
            may_be_repeated = result.has_failed_assertions and not test.is_pytest  # pytest repeats cases itself
            stall = self._watch.longest_since(begin) if may_be_repeated else 0.0
            if stall == 0.0 or len(repeats) == REPEATS:
                return replace(result, repeats=[*repeats, *result.repeats])
            repeats.append(failure(stall, test.name))

    def _run_once(self, test: Test) -> Optional[Result]:
        with self._lock:
            if self._cancelled:
                return None
            self._count += 1
            mark = f"{os.getpid()}:{self._count}"
            base = self._folder / f"{self._count:04d}-{re.sub(r'[^A-Za-z0-9_.]+', '-', test.name)[:80]}"
        with isolation.Domain() as domain:
            env = {**self._env, **test.env, isolation.MARK: mark}
            domain.isolate(env)
            return self._run(test, base, env)

    def _run(self, test: Test, base: pathlib.Path, env: Dict[str, str]) -> Result:
        report, log = base.with_suffix(".xml"), base.with_suffix(".log")
        env.update(GTEST_OUTPUT=f"xml:{report}", GTEST_COLOR="no")
        if time.monotonic() < self._thorough_until:
            env["UR_TEST_THOROUGH"] = "1"
        limit = self._limit or self._patience * test.limit
        start = time.monotonic()
        process = self._start(test, _command(test, report, limit), env, log)
        in_time = _wait(process, limit)
        processor_seconds = _processor_seconds(process.pid)
        seconds = time.monotonic() - start
        left = self._left_behind(env[isolation.MARK]) if in_time else []
        end_group(process)
        if left or not in_time:
            isolation.kill(lambda mark: mark == env[isolation.MARK])
        with self._lock:
            self._running.discard(process)
        cases = read_cases(report, process.returncode == 0 and in_time, test.writes_report)
        text = log.read_text(errors="replace") + "".join(f"\nleft behind: {command}\n" for command in left)
        if left:
            cases.failures.append(LEFT_BEHIND)
        if not in_time:
            text += f"\nstopped at its time limit of {limit:g} s\n"
        elif process.returncode < 0:
            text += f"\nended by signal {-process.returncode}\n"
        return Result(test, cases, seconds, processor_seconds, text + f"(log: {log.relative_to(ROOT)})\n",
                      STALLED.findall(text) if test.is_pytest else [], in_time, process.returncode)

    def _start(self, test: Test, command: List[str], env: Dict[str, str], log: pathlib.Path) -> "subprocess.Popen[bytes]":
        with log.open("wb") as output:
            process = subprocess.Popen(command, cwd=test.folder, env=env, stdin=subprocess.DEVNULL, stdout=output,
                                       stderr=subprocess.STDOUT, start_new_session=True)
        if test.background:
            _lower_priority(process.pid)
        with self._lock:
            self._running.add(process)
        return process

    def _left_behind(self, mark: str) -> List[str]:
        """Returns the commands of the processes that a test has left, as far as they do not end by themselves."""
        return isolation.left_behind(mark, 0.0 if self._cancelled else self._patience * LEAVING_LIMIT)

    def cancel(self) -> None:
        """Stops the running tests; later ones are not started."""
        with self._lock:
            self._cancelled = True
            running = list(self._running)
        for process in running:
            end_group(process)
