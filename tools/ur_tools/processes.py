"""Starts programs, and stops all of them at the end.

    with Programs(log_folder) as programs:
        simulator = programs.start("simulator", ["ur_simulator", "--model", "ur10e"], env)
        programs.wait_until(lambda: port_answers(), 10.0, "the simulator's dashboard")
        ...
    # all programs have ended here, also after an exception or Ctrl-C

Each program runs in its own session: Ctrl-C does not reach it directly, so that programs are stopped in order, and a signal
reaches its children too. Its output is written to <log_folder>/<name>.log, ROS's logs to <log_folder>/ros, unless ROS_LOG_DIR is set.
"""

import contextlib
import os
import pathlib
import signal
import subprocess
import time
from typing import Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple

from .console import Failure, tail

# Signals, each with the time in s that a program has to exit.
GENTLY: Tuple[Tuple[int, float], ...] = ((signal.SIGINT, 5.0), (signal.SIGTERM, 3.0), (signal.SIGKILL, 5.0))
# For a program in Python that handles SIGTERM: SIGINT leaves a traceback while the interpreter starts.
QUIETLY = GENTLY[1:]
TERMINATING = (signal.SIGTERM, signal.SIGHUP)


def group_is_alive(group: int) -> bool:
    """Returns whether a process of the group is running. Zombies do not count."""
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[2]) == group and fields[0] not in "ZX":
            return True
    return False


def signal_group(group: int, number: int) -> None:
    try:
        os.killpg(group, number)
    except ProcessLookupError:
        pass


def end_group(process: "subprocess.Popen[bytes]", how: Sequence[Tuple[int, float]] = GENTLY) -> Optional[int]:
    """Stops a program and its children with signals of rising severity. Returns the exit code; None if it still runs."""
    for number, limit in how:
        if process.poll() is not None and not group_is_alive(process.pid):
            break
        signal_group(process.pid, number)
        deadline = time.monotonic() + limit
        while time.monotonic() < deadline:
            if process.poll() is not None and not group_is_alive(process.pid):
                return process.returncode
            time.sleep(0.02)
    return process.poll()


class Program:
    def __init__(self, name: str, process: "subprocess.Popen[bytes]", log: pathlib.Path):
        self.name = name
        self.process = process
        self.log = log

    @property
    def running(self) -> bool:
        return self.process.poll() is None

    @property
    def output(self) -> str:
        return self.log.read_text(errors="replace")

    def stop(self, how: Sequence[Tuple[int, float]] = GENTLY) -> Optional[int]:
        return end_group(self.process, how)

    def failure(self) -> Failure:
        return Failure(
            f"{self.name} exited with status {self.process.returncode}. Its last lines ({self.log}):\n{tail(self.output)}")


class Programs:
    """The programs of one run. They are stopped in reverse order."""

    def __init__(self, log_folder: pathlib.Path):
        self._folder = log_folder
        self._programs: List[Program] = []
        self._handlers: Dict[int, Any] = {}

    def __enter__(self) -> "Programs":
        self._handlers = interrupt_on_termination()
        return self

    def __exit__(self, *_unused: object) -> None:
        try:
            with _uninterrupted():
                self.stop_all()
        finally:
            for number, handler in self._handlers.items():
                signal.signal(number, handler)

    def _environment(self, env: Mapping[str, str]) -> Dict[str, str]:
        """Keeps the logs of simulated robots apart from those of the user's robots, of which ROS's log folder has the last stops."""
        return {"ROS_LOG_DIR": str(self._folder.absolute() / "ros"), **env}

    def start(self, name: str, command: Sequence[str], env: Optional[Mapping[str, str]] = None,
              cwd: Optional[pathlib.Path] = None) -> Program:
        self._folder.mkdir(parents=True, exist_ok=True)
        log = self._folder / f"{name}.log"
        try:
            with log.open("wb") as output:
                process = subprocess.Popen([str(part) for part in command], stdin=subprocess.DEVNULL, stdout=output,
                                           stderr=subprocess.STDOUT, env=self._environment(os.environ if env is None else env),
                                           cwd=cwd, start_new_session=True)
        except OSError as error:
            raise Failure(f"{name} cannot be started: {error}. Command: {' '.join(map(str, command))}") from error
        program = Program(name, process, log)
        self._programs.append(program)
        return program

    def run(self, command: Sequence[str], env: Mapping[str, str], limit: float, how: Sequence[Tuple[int, float]] = GENTLY) -> int:
        """Runs a command in the foreground and returns its exit code. Raises Failure at `limit`, s, or if a program exits; the command
        is stopped with the signals of `how` then."""
        process = subprocess.Popen(command, env=self._environment(env), stdin=subprocess.DEVNULL, start_new_session=True)
        deadline = time.monotonic() + limit
        try:
            while process.poll() is None:
                self.check()
                if time.monotonic() > deadline:
                    raise Failure(f"{command[1]} did not end within {limit:g} s")
                time.sleep(0.02)
            return process.returncode
        finally:
            with _uninterrupted():
                end_group(process, how)

    def check(self) -> None:
        """Raises Failure, with the end of its log, if a program has exited."""
        for program in self._programs:
            if not program.running:
                raise program.failure()

    def wait_until(self, condition: Callable[[], bool], limit: float, what: str) -> None:
        """Waits for the condition. Raises Failure after `limit` s, or as soon as a program exits."""
        deadline = time.monotonic() + limit
        while not condition():
            self.check()
            if time.monotonic() > deadline:
                logs = ", ".join(str(program.log) for program in self._programs)
                raise Failure(f"timeout after {limit:g} s waiting for {what}. Logs: {logs}")
            time.sleep(0.02)

    def stop_all(self) -> None:
        while self._programs:
            self._programs.pop().stop()


@contextlib.contextmanager
def _uninterrupted() -> Iterator[None]:
    """Signals take effect at the end: while programs are stopped, they would leave the remaining ones running."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, *TERMINATING})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def interrupt_on_termination() -> Dict[int, Any]:
    """Lets `kill` and a closing terminal act like Ctrl-C, but not those that are ignored, as by nohup. Returns the handlers before."""
    return {number: signal.signal(number, ignore if signal.getsignal(number) in (signal.SIG_IGN, ignore) else _interrupt)
            for number in TERMINATING}


def ignore(_number: int, _frame: object) -> None:
    """Ignores a signal in this process alone: the programs that it starts would inherit SIG_IGN."""


def _interrupt(_number: int, _frame: object) -> None:
    raise KeyboardInterrupt
