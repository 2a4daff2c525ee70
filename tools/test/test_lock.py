"""One ./ur at a time builds or tests in a checkout."""

import contextlib
import errno
import fcntl
import os
import signal
import subprocess
import sys

import pytest
from ur_tools import console, isolation, lint, lock, selection, testing
from ur_tools.layout import Layout

BACKGROUND = True
HOLDER = """
import pathlib, sys
sys.path[:0] = {path!r}
sys.argv = ["ur", "build", "--tests"]
from ur_tools.lock import Lock
with Lock("build", pathlib.Path({folder!r})):
    print("holding", flush=True)
    sys.stdin.readline()
"""


@contextlib.contextmanager
def holder(folder):
    """Another process that holds the lock, until it reads a line."""
    process = subprocess.Popen([sys.executable, "-c", HOLDER.format(path=sys.path, folder=str(folder))], stdin=subprocess.PIPE,
                               stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout.readline() == "holding\n"
        yield process
    finally:
        process.kill()
        process.communicate()


def is_locked(folder):
    with (folder / "build.lock").open() as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
    return False


def test_a_second_build_waits_and_reports_the_first(tmp_path, monkeypatch):
    printed = []

    def on_message(text):
        printed.append(text)
        assert first.poll() is None  # it is still holding the lock
        first.stdin.write("\n")
        first.stdin.flush()

    monkeypatch.setattr(lock.console, "step", on_message)
    with holder(tmp_path) as first, lock.Lock("build", tmp_path):
        assert first.wait(20.0) == 0
    assert printed == [f"Waiting for `./ur build --tests` (process {first.pid}), which is running in this checkout"]


def test_a_lock_is_released_when_its_holder_is_killed(tmp_path, monkeypatch):
    with holder(tmp_path) as first:
        first.kill()
        first.wait(20.0)
        monkeypatch.setattr(lock.console, "step", lambda text: pytest.fail(text))
        with lock.Lock("build", tmp_path):
            pass


def test_a_lock_lasts_as_long_as_a_program_that_inherits_it(tmp_path, monkeypatch):
    """As colcon, which goes on when ./ur is killed."""
    code = HOLDER.format(path=sys.path, folder=str(tmp_path)).replace('print("holding"', """
    import subprocess
    from ur_tools.lock import descriptors
    print(subprocess.Popen(["sleep", "60"], stdout=subprocess.DEVNULL, pass_fds=descriptors()).pid""")
    first = subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    heir = int(first.stdout.readline())
    first.kill()
    first.wait(20.0)
    waited = []
    monkeypatch.setattr(lock.console, "step", lambda text: waited.append(text) or os.kill(heir, signal.SIGKILL))
    with lock.Lock("build", tmp_path):
        assert len(waited) == 1


def test_a_lock_that_is_entered_again_is_kept_until_the_outer_block_ends(tmp_path):
    with lock.Lock("build", tmp_path):
        with lock.Lock("build", tmp_path):
            assert is_locked(tmp_path)
        assert is_locked(tmp_path)
    assert not is_locked(tmp_path)


@pytest.mark.parametrize("count", ["", ":7"])
def test_a_test_does_not_wait_for_the_run_that_it_belongs_to(tmp_path, monkeypatch, count):
    with holder(tmp_path) as run:
        monkeypatch.setenv(isolation.MARK, f"{run.pid}{count}")
        with pytest.raises(console.Failure, match=f"A test of `./ur build --tests` .process {run.pid}.* would change the build"):
            with lock.Lock("build", tmp_path):
                pass


def test_no_build_can_change_the_programs_while_they_are_tested(tmp_path, monkeypatch):
    monkeypatch.setattr("ur_tools.layout.STATE", tmp_path)
    monkeypatch.setattr(isolation, "_SHARED_MEMORY", tmp_path)
    locked = {}

    def during(what, result):
        def run(*_unused):
            locked[what] = is_locked(tmp_path)
            return result
        return run

    monkeypatch.setattr(testing, "Lock", lambda name: lock.Lock(name, tmp_path))
    monkeypatch.setattr(lint, "checks", lambda _: [])
    for name, result in (("_build", {}), ("_collect", []), ("_run_all", []), ("_diagnose", {})):
        monkeypatch.setattr(testing, name, during(name, result))
    testing._run_selected(testing.Options(Layout.of_environment(), changed=True), selection.everything())
    assert locked == dict.fromkeys(("_build", "_collect", "_run_all", "_diagnose"), True)


def test_a_lock_is_acquired_again_if_its_file_was_removed_in_the_meantime(tmp_path, monkeypatch):
    taken = lock.Lock("build", tmp_path)
    lock_file = lock.Lock._lock

    def removed_once(self, file):
        monkeypatch.setattr(lock.Lock, "_lock", lock_file)
        lock_file(self, file)
        (tmp_path / "build.lock").unlink()

    monkeypatch.setattr(lock.Lock, "_lock", removed_once)
    with taken:
        assert "process" in (tmp_path / "build.lock").read_text()


def test_a_read_only_checkout_is_reported(tmp_path, monkeypatch):
    def reject(*_unused, **_more):
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr(lock.pathlib.Path, "open", reject)
    with pytest.raises(console.Failure, match="cannot be written: Read-only file system"):
        with lock.Lock("build", tmp_path):
            pass
