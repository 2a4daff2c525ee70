"""Shared by the system tests: processes with their logs, the simulator's control port, and a client of the nodes."""

import contextlib
import json
import os
import pathlib
import signal
import socket
import subprocess
import threading
import time

import own_domain  # noqa: F401 -- reserves a domain
import rclpy
from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from ur_ros_rtde_msgs.action import MoveJ
from ur_ros_rtde_msgs.msg import GoalRejected
from ur_ros_rtde_msgs.srv import GetJointState

TRANSIENT_LOCAL = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
TIMEOUT_FACTOR = float(os.environ.get("UR_TEST_PATIENCE", "1"))  # scales all timeouts; programs with a sanitizer are slower
REAL_TIME_FACTOR = float(os.environ.get("UR_TEST_REAL_TIME_FACTOR", "1"))  # slows down the simulated robot along with the driver
LONGEST_PAUSE = 0.02  # s, between two checks of a condition: a wait for a long motion takes little processor time
# Parameter of a driver that is started for a single test. With all plugins, the driver and the clients that discover its actions take
# five times as much processor time (2 s).
FEW_PLUGINS = "plugins:=[move_j,stop]"
# Arguments of a driver that is to log the names of all commands.
NAMES_COMMANDS = ("--log-level", "command_server:=debug", "--log-level", "dashboard_server:=debug")
RECOVERY_TIME_FACTOR = 0.2  # scales the simulator's durations of power on, brake release, protective stop delay and safety restart
HOME = [0.0, -1.57, 1.57, -1.57, -1.57, 0.0]
JOINTS = ["shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint", "wrist_3_joint"]


def wait_for(condition, limit, what):
    """Returns the first true value of `condition()`. Fails if there is none within `limit` s."""
    end, pause = time.monotonic() + TIMEOUT_FACTOR * limit, 0.001
    while True:
        value = condition()
        if value:
            return value
        assert time.monotonic() < end, f"timeout after {limit} s waiting for {what}"
        time.sleep(pause)
        pause = min(1.5 * pause, LONGEST_PAUSE)


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
        self._socket.close()
        self.process.stop()


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


class Goal:
    def __init__(self, client, future):
        self._client, self._future = client, future
        self.feedback = []
        self.result_at = 0  # ns since the epoch; 0: there is none yet
        self._result = None

    def answered(self):
        """Returns whether the goal has been accepted or rejected."""
        return self._future.done()

    @property
    def handle(self):
        return wait_for(lambda: self._future.done() and self._future.result(), 10.0, "the goal response")

    @property
    def accepted(self):
        return self.handle.accepted

    @property
    def id(self):
        return bytes(self.handle.goal_id.uuid)

    def request_result_when_accepted(self):
        """Requests the result on acceptance, in the executor's thread. Otherwise is_finished() requests it."""

        def request_result(future):
            handle = future.result()
            if handle is not None and handle.accepted:
                self._request_result(handle)

        self._future.add_done_callback(request_result)

    def _request_result(self, handle):
        def on_result(_future):
            self.result_at = time.time_ns()

        if self._result is None:
            self._result = handle.get_result_async()
            self._result.add_done_callback(on_result)
        return self._result

    def is_finished(self):
        """Returns whether the result has been received."""
        assert self.accepted, self._client.rejection(self)
        if self._result is None:
            self._client.call_in_executor(lambda: self._request_result(self.handle))
        return self.result_at > 0

    def wait_until(self, condition, limit, what):
        """Waits until `condition()` is true. Fails with the goal's result if the goal ends before."""

        def holds_or_ended():
            return "holds" if condition() else "ended" if self.is_finished() else ""

        assert wait_for(holds_or_ended, limit, what) == "holds", f"the goal ended before {what}: {self.result().message}"

    def wait_for_result(self, limit=30.0):
        """Returns the status and the result."""
        wait_for(self.is_finished, limit, "the result")
        answer = self._result.result()
        return answer.status, answer.result

    def result(self, limit=30.0):
        return self.wait_for_result(limit)[1]

    def succeeded(self, limit=30.0):
        """Asserts that the goal succeeds and returns its result."""
        status, result = self.wait_for_result(limit)
        assert status == GoalStatus.STATUS_SUCCEEDED and result.success, (status, result.error_code, result.message)
        assert result.error_code == 0
        return result

    def cancel(self):
        future = self._client.call_in_executor(self.handle.cancel_goal_async)
        return wait_for(lambda: future.done() and future.result(), 10.0, "the cancel response")


class Client:
    """A node with action and service clients, spun in a thread of its own."""

    def __init__(self, namespace="", domain=None, name="test_client"):
        self.context = rclpy.Context()
        rclpy.init(context=self.context, domain_id=domain)
        # The executor checks every entity on each wake-up: services that no test uses cost processor time.
        self.node = rclpy.create_node(name, namespace=namespace or None, context=self.context, start_parameter_services=False,
                                      enable_rosout=False)
        self._executor = SingleThreadedExecutor(context=self.context)
        self._executor.add_node(self.node)
        self._actions, self._services, self._subscriptions = {}, {}, []
        self.rejections = []
        self.node.create_subscription(GoalRejected, "goal_rejections", self.rejections.append, TRANSIENT_LOCAL)
        self._thread = threading.Thread(target=self._executor.spin, daemon=True)
        self._thread.start()

    def close(self):
        self._executor.shutdown()
        self._thread.join(10.0)
        self.node.destroy_node()
        self.context.try_shutdown()

    def call_in_executor(self, send):
        """Calls `send` in the executor's thread and returns its result.

        rclpy loses a response that arrives while another thread is still sending the request."""
        task = self._executor.create_task(send)
        return wait_for(lambda: task.done() and task.result(), 10.0, "the executor to send the request")

    def send(self, action, name, **fields):
        return self.send_goal(action, name, action.Goal(**fields))

    def send_goal(self, action, name, message):
        if name not in self._actions:
            self._actions[name] = self.call_in_executor(lambda: ActionClient(self.node, action, name))
        client = self._actions[name]
        self._wait_for_server(client, name)
        goal = Goal(self, None)
        goal._future = self.call_in_executor(lambda: client.send_goal_async(
            message, feedback_callback=lambda message: goal.feedback.append(message.feedback)))
        return goal

    def sees(self, name):
        """Returns whether the server of an action that was used before is known."""
        return self._actions[name].server_is_ready()

    def destroy_action_client(self, name):
        """Destroys an action client. This saves processor time: the executor checks every action client on each wake-up."""
        client = self._actions.pop(name, None)
        if client is not None:
            self.call_in_executor(lambda: client.destroy() or True)

    def _wait_for_server(self, client, name):
        try:
            wait_for(client.server_is_ready, 60.0, f"the action {name}")
        except AssertionError as error:
            topics = {topic: self.node.count_publishers(f"{name}/_action/{topic}") for topic in ("feedback", "status")}
            services = sorted(service for service, _ in self.node.get_service_names_and_types() if f"/{name}/_action/" in service)
            raise AssertionError(f"{error}; found topics {topics} and services {services}") from None

    def rejection(self, goal):
        return self.rejection_of(goal.id)

    def rejection_of(self, goal_id: bytes):
        return wait_for(lambda: next((r for r in list(self.rejections) if bytes(r.goal_id.uuid) == goal_id), None), 10.0,
                        "the message on goal_rejections")

    def call(self, service, name, limit=10.0, **fields):
        if name not in self._services:
            self._services[name] = self.node.create_client(service, name)
        client = self._services[name]
        wait_for(client.service_is_ready, 20.0, f"the service {name}")
        future = self.call_in_executor(lambda: client.call_async(service.Request(**fields)))
        return wait_for(lambda: future.done() and future.result(), limit, f"the response of {name}")

    def subscribe(self, message, topic, transient_local=False):
        """Returns a list to which all received messages are appended."""
        messages = []
        qos = TRANSIENT_LOCAL if transient_local else QoSProfile(depth=2000, reliability=ReliabilityPolicy.RELIABLE)
        self._subscriptions.append(self.node.create_subscription(message, topic, messages.append, qos))
        return messages

    def destroy_subscriptions(self):
        """Destroys all subscriptions. A few of them at 500 Hz delay goal responses in Python considerably."""
        subscriptions, self._subscriptions = self._subscriptions, []
        for subscription in subscriptions:
            self.call_in_executor(lambda s=subscription: self.node.destroy_subscription(s))

    def messages_until_now(self, states):
        """Returns the received messages of a state topic up to the current time. Topics lag behind results."""
        now = seconds(self.call(GetJointState, "get_joint_state").joint_state.header.stamp)
        wait_for(lambda: states and seconds(states[-1].header.stamp) >= now, 20.0, "the current state on the topic")
        return list(states)


def seconds(stamp):
    return stamp.sec + 1e-9 * stamp.nanosec


def robot_seconds(stamp):
    """Converts a stamp or duration of the host to seconds of the simulated robot's time."""
    return REAL_TIME_FACTOR * seconds(stamp)


def own_address(number=0):
    """Returns a loopback address of this test: each run has a ROS domain of its own, and `./ur test` reserves an address with it."""
    first, second, *others = os.environ.get("UR_TEST_ADDRESS", f"127.0.1.{os.environ.get('ROS_DOMAIN_ID', '0')}").split(".")
    return ".".join([first, str(int(second) + number), *others])


@contextlib.contextmanager
def simulated_robot(*parameters, model="ur10e", env=None):
    """Yields a simulator whose driver, with these parameters, accepts motions."""
    simulator = Simulator(own_address(), model=model)
    driver = start_node("driver", simulator.address, *parameters, env=env)
    client = Client()
    try:
        wait_for(lambda: client.send(MoveJ, "move_j", joint_positions=HOME).accepted, 30.0, "the driver to accept a motion")
        yield simulator
    finally:
        client.close()
        driver.stop()
        simulator.stop()
