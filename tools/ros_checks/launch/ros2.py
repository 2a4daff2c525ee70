"""Runs the program `ros2`."""

import os
import pathlib
import signal
import subprocess
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]


def ros2(*arguments, limit=60.0):
    """Runs a command. Returns its exit code and output."""
    result = subprocess.run(["ros2", *map(str, arguments)], capture_output=True, text=True, timeout=limit,
                            env={**os.environ, "PYTHONUNBUFFERED": "1"})
    return result.returncode, result.stdout + result.stderr


class Launch:
    """A running `ros2 launch`. stop() sends Ctrl-C."""

    def __init__(self, *arguments):
        self.lines = []
        self._process = subprocess.Popen(["ros2", "launch", *map(str, arguments)], stdout=subprocess.PIPE,
                                         stderr=subprocess.STDOUT, text=True, start_new_session=True,
                                         env={**os.environ, "PYTHONUNBUFFERED": "1"})
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        assert self._process.stdout is not None
        for line in self._process.stdout:
            self.lines.append(line.rstrip("\n"))

    def output(self):
        return "\n".join(self.lines)

    def running(self):
        return self._process.poll() is None

    def wait_for(self, text, limit=60.0):
        wait_for(lambda: text in self.output() or not self.running(), limit, f"'{text}' in:\n{self.output()}")
        assert text in self.output(), self.output()

    def wait(self, limit=60.0):
        code = self._process.wait(limit)
        self._reader.join(5.0)
        return code

    def stop(self):
        if self.running():
            os.killpg(self._process.pid, signal.SIGINT)
            try:
                self.wait(40.0)
            except subprocess.TimeoutExpired:
                os.killpg(self._process.pid, signal.SIGKILL)
                self._process.wait()
        print(self.output())


def wait_for(condition, limit, what):
    end = time.monotonic() + limit
    while not condition():
        assert time.monotonic() < end, f"timeout after {limit} s waiting for {what}"
        time.sleep(0.05)


def ready(launch, namespace=""):
    """Waits until the driver accepts motion commands."""

    def state():
        assert launch.running(), launch.output()
        try:
            return "READY" in ros2("topic", "echo", "--once", "--field", "name", "--qos-durability", "transient_local",
                                   "--qos-reliability", "reliable", f"{namespace}/driver_state", limit=15.0)[1]
        except subprocess.TimeoutExpired:
            return False

    launch.wait_for("dashboard commands:")
    wait_for(state, 60.0, f"{namespace}/driver_state READY:\n{launch.output()}")


def parameter(node, name):
    code, printed = ros2("param", "get", "--hide-type", node, name)
    assert code == 0, printed
    return printed.strip()
