"""The last lines of ./ur test: what passed, failed, was skipped and was repeated, by package, and why."""

import os
from typing import Dict, List

from . import console
from .lint import Check
from .runner import Result

# Reasons to skip a test that are in order in continuous integration (CI=true), where any other one fails the run.
EXPECTED_SKIPS = (
    "Fast DDS 2 has no type propagation",
    "Humble does not report new subscriptions",
    "ends immediately",  # a command that is over before it can be interrupted
    "rclcpp is not installed: no examples in C++",
    "rclpy of Humble has no client of parameters",
    "the profile for Fast DDS 2 has no flow controller",
    "this build cannot count allocations",
    "this host does not permit real-time priorities",
    "this middleware sends the text before the null character",
    "this user may not create network namespaces and TUN devices",
    "up to Jazzy, the middleware requires them",
    "zsh is not installed",
)
SHOWN_NAMES = 3  # of the tests that are skipped for one reason


def case_name(result: Result, case: str) -> str:
    return f"{result.test.name} {case}".rstrip()


def _packages(results: List[Result]) -> None:
    by_package: Dict[str, List[Result]] = {}
    for result in results:
        by_package.setdefault(result.test.package, []).append(result)
    for name, group in sorted(by_package.items()):
        passed, failed = sum(result.cases.passed for result in group), sum(len(result.cases.failures) for result in group)
        console.line(f"    {name:28} {passed:5} passed {failed:4} failed")


def _failures(results: List[Result], checks: List[Check], verdicts: Dict[str, str]) -> int:
    names = [case_name(result, case) for result in results for case in result.cases.failures]
    names += [check.name for check in checks if not check.ok]
    if names:
        console.line("Failed:")
        for name in sorted(set(names)):
            console.line(f"    {name}" + (f" ({verdicts[name]})" if name in verdicts else ""))
    return len(names)


def _skipped(results: List[Result]) -> int:
    """Prints the skipped tests by reason. Returns how many should not be: continuous integration has to provide what they need."""
    by_reason: Dict[str, List[str]] = {}
    for result in results:
        for case, reason in result.cases.skipped.items():
            by_reason.setdefault(reason, []).append(case_name(result, case))
    if by_reason:
        console.line(f"Skipped: {sum(map(len, by_reason.values()))}")
    wrong = 0
    for reason, names in sorted(by_reason.items()):
        is_wrong = os.environ.get("CI") == "true" and reason not in EXPECTED_SKIPS
        wrong += len(names) * is_wrong
        console.line(f"    {len(names)}: {reason}" + (" (not expected with CI=true: see EXPECTED_SKIPS)" if is_wrong else ""))
        for name in sorted(names)[:SHOWN_NAMES]:
            console.line(f"        {name}")
        if len(names) > SHOWN_NAMES:
            console.line(f"        and {len(names) - SHOWN_NAMES} more")
    return wrong


def report(results: List[Result], checks: List[Check], verdicts: Dict[str, str], seconds: float) -> int:
    """Returns the exit status, to which `verdicts` contribute nothing."""
    console.line("")
    _packages(results)
    unexpected = _skipped(results)
    failed = _failures(results, checks, verdicts)
    passed = sum(result.cases.passed for result in results) + sum(1 for check in checks if check.ok)
    repeats = sum(len(result.repeats) for result in results)
    console.line(f"{seconds:.0f} s" + (f"; {repeats} repeated because the host stalled" if repeats else ""))
    console.line(f"{passed} passed, {failed} failed")
    return 1 if failed or unexpected or passed == 0 else 0
