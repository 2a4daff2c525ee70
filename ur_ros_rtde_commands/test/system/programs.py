"""Programs of the tests: nodes with their output, and the simulator with its control port."""

import json
import os
import pathlib
import signal
import socket
import subprocess
import threading

from support import HOME, REAL_TIME_FACTOR, RECOVERY_TIME_FACTOR, TIMEOUT_FACTOR, wait_for


def find_program(package, name):
    """Returns the path of an installed program."""
    for prefix in os.environ["AMENT_PREFIX_PATH"].split(os.pathsep):
        for file in (pathlib.Path(prefix, "lib", package, name), pathlib.Path(prefix, "bin", name)):
            if file.is_file():
                return str(file)
    raise FileNotFoundError(f"{package}/{name} is in no prefix of AMENT_PREFIX_PATH")


class Process:
    """A running program and the lines it has printed."""

    def __init__(self, command, env=None, stdin=False):
        self.lines = []
        self._process = subprocess.Popen([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                         stdin=subprocess.PIPE if stdin else None,
                                         env={**os.environ, **(env or {})}, text=True, errors="replace")
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self._process.stdout:
            self.lines.append(line.rstrip("\n"))

    def output(self):
        return "\n".join(self.lines)

    def wait_for_output(self, text, limit=15.0):
        return wait_for(lambda: next((line for line in list(self.lines) if text in line), None), limit,
                        f"'{text}' in the output:\n{self.output()}")

    def write(self, text):
        """Writes to the program's stdin."""
        self._process.stdin.write(text)
        self._process.stdin.flush()

    @property
    def pid(self):
        return self._process.pid

    def running(self):
        return self._process.poll() is None

    def wait(self, limit):
        try:
            code = self._process.wait(TIMEOUT_FACTOR * limit)
        except subprocess.TimeoutExpired:
            raise AssertionError(f"the process is still running after {limit} s:\n{self.output()}") from None
        self._reader.join(5.0)
        return code

    def interrupt(self):
        self.signal(signal.SIGINT)

    def signal(self, number):
        self._process.send_signal(number)

    def pause(self):
        """Stops all threads. On a busy machine, some still run for a while after the signal."""
        self._process.send_signal(signal.SIGSTOP)
        wait_for(lambda: os.waitid(os.P_PID, self.pid, os.WSTOPPED | os.WNOHANG), 10.0, "the process to stop")

    def resume(self):
        self._process.send_signal(signal.SIGCONT)

    def kill(self):
        self._process.kill()
        self._process.wait(10.0)

    def stop(self):
        """Sends SIGINT; kills the process if it does not exit within 15 s."""
        if self.running():
            self.interrupt()
            try:
                self._process.wait(15.0)
            except subprocess.TimeoutExpired:
                self.kill()


class Simulator:
    def __init__(self, address, *arguments, model="ur10e", urcaps=("onrobot_soft_gripper", "robotiq_gripper"),
                 recovery_time_factor=RECOVERY_TIME_FACTOR, real_time_factor=REAL_TIME_FACTOR):
        self.address = address
        self._real_time_factor = real_time_factor
        self._arguments = ["--model", model, "--recovery-time-factor", str(recovery_time_factor),
                           *(f"--urcap={urcap}" for urcap in urcaps), *arguments]
        self.process = None
        self._lock = threading.Lock()
        self.start()

    def start(self):
        self.process = Process([find_program("ur_simulator", "ur_simulator"), "--address", self.address,
                                "--joints", ",".join(map(str, HOME)), "--real-time-factor", str(self._real_time_factor),
                                *self._arguments])
        wait_for(self._connect, 20.0, "the simulator's control port")
        return self

    def _connect(self):
        assert self.process.running(), self.process.output()
        try:
            self._socket = socket.create_connection((self.address, 30099), 5.0)
        except OSError:
            return False
        self._answers = self._socket.makefile("r")
        return True

    def control(self, command, **fields):
        with self._lock:
            try:
                self._socket.sendall((json.dumps({"command": command, **fields}) + "\n").encode())
                answer = json.loads(self._answers.readline())
            except TimeoutError:
                self._connect()  # the late answer must not be that of the next command
                raise
        assert answer.get("ok"), answer
        return answer

    def may(self, command, **fields):
        """Sends a command that the controller may reject. Returns whether it has accepted it."""
        try:
            self.control(command, **fields)
            return True
        except AssertionError:
            return False

    def state(self):
        return self.control("state")["state"]

    def wait(self, seconds, limit=10.0):
        """Waits for a duration of simulated time."""
        end = self.state()["timestamp"] + seconds
        wait_for(lambda: self.state()["timestamp"] >= end, limit, f"{seconds:g} s of simulated time")

    def unlock_protective_stop(self):
        """Returns whether the controller unlocks it. The controller rejects in the first seconds of a protective stop."""
        return self.may("unlock_protective_stop")

    def is_at_rest(self):
        """Returns whether all joints are slower than 0.01 rad/s."""
        return max(map(abs, self.state()["actual"]["velocity"])) < 0.01

    def kill(self):
        self._socket.close()
        self.process.kill()

    def stop(self):
        """Ends it. Fails if a motion of the control program was broken off, or a path began in motion: a robot may not forgive that."""
        lapses = self.state()["lapses"] if self.process.running() else {}
        self._socket.close()
        self.process.stop()
        assert not any(lapses.values()), lapses


def start_node(name, address, *parameters, namespace="", env=None, arguments=(), executable=None):
    # Generous timeouts: on a busy machine, a simulator may be delayed more than a real controller.
    generous = ["silence_limit:=2.0", "watchdog_frequency:=2.0"]
    command = [executable or find_program("ur_ros_rtde", name), "--ros-args", "-p", f"robot_ip:={address}"]
    parameters = [*(p for p in generous if not any(q.split(":=")[0] == p.split(":=")[0] for q in parameters)), *parameters]
    for parameter in parameters:
        command += ["-p", parameter]
    if namespace:
        command += ["-r", f"__ns:=/{namespace}"]
    return Process([*command, *arguments], env)
