"""Starts a node of rcl_cxx in a separate process and tests it with rclpy."""

import os
import pathlib
import signal
import subprocess
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent / "support"))
import pytest
import rclpy
from rclpy.executors import SingleThreadedExecutor
from ros_domain import reserve

LIMIT = 10.0

reserve()  # before rclpy is used for the first time


def eventually(condition, limit=LIMIT):
    """Returns the first true value of `condition()`. Fails if there is none within `limit` s."""
    end = time.monotonic() + limit
    while True:
        value = condition()
        if value:
            return value
        assert time.monotonic() < end, "the condition did not become true in time"
        time.sleep(0.005)


def result_of(future, limit=LIMIT):
    done = threading.Event()
    future.add_done_callback(lambda _: done.set())
    assert done.wait(limit), "no response in time"
    return future.result()


class NodeProcess:
    """A process of the test node."""

    def __init__(self, *arguments, ready=True):
        environment = dict(os.environ, RCUTILS_LOGGING_USE_STDOUT="0")
        self.process = subprocess.Popen([str(program()), *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                        text=True, env=environment)
        self.output = []
        self.errors = []
        self._readers = [threading.Thread(target=self._read, args=(stream, lines), daemon=True) for stream, lines in
                         ((self.process.stdout, self.output), (self.process.stderr, self.errors))]
        for reader in self._readers:
            reader.start()
        if ready:
            eventually(lambda: "ready\n" in self.output or self.process.poll() is not None)
            assert "ready\n" in self.output, self.errors

    @staticmethod
    def _read(stream, lines):
        for line in stream:
            lines.append(line)

    def stop(self, sig=signal.SIGINT):
        """Sends the signal and returns the exit code."""
        if self.process.poll() is None:
            self.process.send_signal(sig)
        return self.wait()

    def wait(self):
        try:
            self.process.wait(LIMIT)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            raise AssertionError("the node did not exit") from None
        finally:
            for reader in self._readers:
                reader.join()
            self.process.stdout.close()
            self.process.stderr.close()
        return self.process.returncode


def program():
    if "RCL_CXX_TEST_NODE" in os.environ:
        return pathlib.Path(os.environ["RCL_CXX_TEST_NODE"])
    from ament_index_python.packages import get_package_prefix
    return pathlib.Path(get_package_prefix("rcl_cxx")) / "lib" / "rcl_cxx" / "rcl_cxx_test_node"


class Ros:
    """An rclpy node whose executor spins in a thread."""

    def __init__(self):
        self.context = rclpy.Context()
        rclpy.init(context=self.context)
        self.node = rclpy.create_node("observer", context=self.context)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self._thread = threading.Thread(target=self.executor.spin)
        self._thread.start()

    def close(self):
        self.executor.shutdown()
        self._thread.join(LIMIT)
        self.node.destroy_node()
        rclpy.shutdown(context=self.context)

    def call_in_executor(self, function):
        """Calls the function in the executor's thread and returns its result.

        rclpy's action client is not thread-safe: the executor may access a client that another thread is still
        constructing, and it loses a response that arrives before another thread has registered the request.
        """
        return result_of(self.executor.create_task(function))

    def call(self, service_type, name, request):
        client = self.node.create_client(service_type, name)
        try:
            assert client.wait_for_service(LIMIT), f"no service {name}"
            return result_of(client.call_async(request))
        finally:
            self.node.destroy_client(client)

    def subscribe(self, message_type, topic, qos):
        """Waits for the publisher of the topic. Returns a list to which all received messages are appended."""
        messages = []
        self.node.create_subscription(message_type, topic, messages.append, qos)
        eventually(lambda: self.node.count_publishers(topic) > 0)
        return messages


@pytest.fixture(scope="module")
def ros():
    ros = Ros()
    yield ros
    ros.close()


@pytest.fixture
def start_node():
    """Returns a function that starts further nodes. After a failed test, they are killed and their output is printed."""
    processes = []

    def start(*arguments, **options):
        processes.append(NodeProcess(*arguments, **options))
        return processes[-1]

    yield start
    for process in processes:
        if process.process.poll() is None:
            process.process.kill()
            print(process.output, process.errors, sep="\n")


@pytest.fixture(scope="module")
def test_node():
    """The node shared by all tests of a file."""
    process = NodeProcess()
    yield process
    assert process.stop() == 0
