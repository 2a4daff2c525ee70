"""A pytest plugin that repeats a test that failed while the host stalled: the failure shows nothing about the software.

A failure without a measured stall, or after the crash of a program, is never repeated. pytest-rerunfailures does the repetition. A
fixture whose work began before the test sets `request.node.began` to that time of time.monotonic(). A module with JUDGES_STALLS = True
has its own measurement, and is not repeated.
"""

import gc
import subprocess
import time

import pytest

from ur_tools.stall_watch import CRASHED, REPEATS, StallWatch, failure

_watch = pytest.StashKey()
_begin = pytest.StashKey()
_stalled = pytest.StashKey()


class HostStalled(Exception):
    """A test failed while the host stalled. The cause is the failure."""


def pytest_configure(config):
    config.stash[_watch], config.stash[_stalled] = StallWatch(), []
    config.option.reruns, config.option.only_rerun = REPEATS, [HostStalled.__name__]


def pytest_unconfigure(config):
    config.stash[_watch].close()


def _a_program_has_crashed():
    """Returns whether one of the programs of this process has crashed that a test or a fixture still refers to."""
    return any(found.poll() in CRASHED for found in gc.get_objects() if type(found) is subprocess.Popen)


def _blame_host(item):
    try:
        return (yield)
    except (Exception, pytest.fail.Exception) as error:
        began = getattr(item, "began", None) or item.stash[_begin]
        stall = item.config.stash[_watch].longest_since(began)
        if stall == 0.0 or getattr(item.module, "JUDGES_STALLS", False) or _a_program_has_crashed():
            raise
        text = failure(stall, item.nodeid)
        item.config.stash[_stalled].append(text)
        raise HostStalled(text) from error


@pytest.hookimpl(wrapper=True)
def pytest_runtest_setup(item):
    item.stash[_begin] = time.monotonic()
    return (yield from _blame_host(item))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item):
    return (yield from _blame_host(item))


def pytest_terminal_summary(terminalreporter):
    for text in terminalreporter.config.stash[_stalled]:
        terminalreporter.write_line(text)
