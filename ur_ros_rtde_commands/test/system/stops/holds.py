"""Holds threads of another process for a while, at any point of their execution, with ptrace.

Runs as a process of its own: a process that waits for its own children, as subprocess does, would take the reports of held threads
from the thread that holds them. `Holder` starts it and talks to it: one request per line, one report per line.
"""

import ctypes
import errno
import json
import os
import pathlib
import subprocess
import sys
import threading
import time
from typing import Dict, Iterable, List, Sequence, Tuple

PTRACE_DETACH, PTRACE_SEIZE, PTRACE_INTERRUPT = 17, 0x4206, 0x4207
WALL = 0x40000000
EVENT_STOP = 128  # the report of PTRACE_INTERRUPT
STOP_LIMIT = 2.0  # s, for a seized thread to report that it has stopped


# --- The process that holds ---


def _ptrace(request: int, thread: int, data: int = 0) -> bool:
    """Returns False if the thread has ended."""
    libc = _ptrace.__dict__.setdefault("libc", ctypes.CDLL(None, use_errno=True))
    libc.ptrace.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]
    libc.ptrace.restype = ctypes.c_long
    if libc.ptrace(request, thread, None, data) == 0:
        return True
    number = ctypes.get_errno()
    if number == errno.ESRCH or _has_ended(thread):
        return False
    raise OSError(number, os.strerror(number))


def _has_ended(thread: int) -> bool:
    """Also while its process remains: ptrace then reports a lack of permission."""
    try:
        return pathlib.Path(f"/proc/{thread}/stat").read_text().rpartition(")")[2].split()[0] in "ZX"
    except OSError:
        return True


def _wait_for_reports(threads: Iterable[int]) -> Dict[int, int]:
    """Waits until each thread has stopped or ended, in any order. Returns the signals to deliver when the stopped ones go on; 0: none.

    A thread that was killed remains until its end has been waited for here, and with it its process.
    """
    waiting, stopped = set(threads), {}
    end = time.monotonic() + STOP_LIMIT
    while waiting:
        for thread in list(waiting):
            try:
                found, status = os.waitpid(thread, WALL | os.WNOHANG)
            except ChildProcessError:
                waiting.discard(thread)
                continue
            if found == thread:
                waiting.discard(thread)
                if os.WIFSTOPPED(status):
                    stopped[thread] = 0 if status >> 16 == EVENT_STOP else os.WSTOPSIG(status)
        if time.monotonic() > end:
            raise TimeoutError(f"threads {waiting} do not stop")
        time.sleep(0.0002 if waiting else 0.0)
    return stopped


def _hold(threads: Sequence[int], seconds: float) -> Dict[str, object]:
    seized = [thread for thread in threads if _ptrace(PTRACE_SEIZE, thread)]
    begin = time.time_ns()
    for thread in seized:
        _ptrace(PTRACE_INTERRUPT, thread)
    stopped = _wait_for_reports(seized)
    time.sleep(max(0.0, seconds - 1e-9 * (time.time_ns() - begin)))
    killed = [thread for thread, signal in stopped.items() if not _ptrace(PTRACE_DETACH, thread, signal)]
    report: Dict[str, object] = {"begin": begin, "end": time.time_ns(), "held": len(stopped)}
    _wait_for_reports(killed)
    return report


def _serve() -> None:
    for line in sys.stdin:
        request = json.loads(line)
        time.sleep(max(0.0, 1e-9 * (request["at"] - time.time_ns())))
        try:
            report = _hold(request["threads"], request["seconds"])
        except OSError as error:
            report = {"error": str(error)}
        print(json.dumps(report), flush=True)


# --- Its client ---


class Hold:
    """A hold that was requested."""

    def __init__(self) -> None:
        self._done = threading.Event()
        self.report: Dict[str, object] = {}

    def finish(self, report: Dict[str, object]) -> None:
        self.report = report
        self._done.set()

    def wait(self) -> Dict[str, object]:
        assert self._done.wait(10.0), "a hold has not ended"
        assert "error" not in self.report, f"threads cannot be held: {self.report['error']}"
        return self.report


class Holder:
    def __init__(self) -> None:
        self._process = subprocess.Popen([sys.executable, str(pathlib.Path(__file__).resolve())], stdin=subprocess.PIPE,
                                         stdout=subprocess.PIPE, text=True)
        self._waiting: List[Hold] = []
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        assert self._process.stdout
        for line in self._process.stdout:
            self._waiting.pop(0).finish(json.loads(line))

    def request(self, threads: Sequence[int], at: int, seconds: float) -> Hold:
        """Holds these threads together from the time `at`, ns since the epoch. Requests are executed one after the other."""
        hold = Hold()
        self._waiting.append(hold)
        assert self._process.stdin
        self._process.stdin.write(json.dumps({"threads": list(threads), "at": at, "seconds": seconds}) + "\n")
        self._process.stdin.flush()
        return hold

    def close(self) -> None:
        assert self._process.stdin
        self._process.stdin.close()
        self._process.wait(10.0)


def threads_of(process: int) -> List[Tuple[int, str]]:
    """Returns number and name of the threads of a process, the oldest first."""
    found = []
    for number in sorted(map(int, os.listdir(f"/proc/{process}/task"))):
        try:
            found.append((number, pathlib.Path(f"/proc/{process}/task/{number}/comm").read_text().strip()))
        except OSError:
            continue  # it has just ended
    return found


def why_impossible() -> str:
    """Returns why threads cannot be held on this machine; an empty text if they can."""
    target = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    holder = Holder()
    try:
        report = holder.request([target.pid], time.time_ns(), 0.001)
        report.wait()
        return ""
    except AssertionError as error:
        return str(error)
    finally:
        holder.close()
        target.kill()
        target.wait()


if __name__ == "__main__":
    _serve()
