"""Starts a node of rcl_cxx in a process of its own and checks it with rclpy."""

import fcntl
import os
import pathlib
import signal
import subprocess
import tempfile
import threading
import time

LIMIT = 10.0

_own_domain = None


def _take_own_domain():
    """Takes a ROS domain that no other test on this machine uses, by locking a file until the process ends.

    The project's test runner does the same and sets the domain in the environment.
    """
    global _own_domain
    folder = pathlib.Path(tempfile.gettempdir()) / f"ur-domains-{os.getuid()}"
    folder.mkdir(exist_ok=True)
    for domain in range(1, 102):
        lock = (folder / str(domain)).open("w")
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            lock.close()
            continue
        _own_domain = lock
        return str(domain)
    raise RuntimeError("all ROS domains are in use by other tests")


# Before rclpy is used for the first time.
os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
if "ROS_DOMAIN_ID" not in os.environ:
    os.environ["ROS_DOMAIN_ID"] = _take_own_domain()

import pytest  # noqa: E402
import rclpy  # noqa: E402
from rclpy.executors import SingleThreadedExecutor  # noqa: E402


def eventually(condition, limit=LIMIT):
    """Returns the value of the condition as soon as it is true; fails after the limit."""
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
    """The test node, with arguments of its own."""

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
        """Returns the exit code and sets `self.seconds_to_stop`."""
        start = time.monotonic()
        if self.process.poll() is None:
            self.process.send_signal(sig)
        return self.wait(start)

    def wait(self, start=None):
        try:
            self.process.wait(LIMIT)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            raise AssertionError("the node did not end") from None
        finally:
            for reader in self._readers:
                reader.join()
            self.process.stdout.close()
            self.process.stderr.close()
        self.seconds_to_stop = time.monotonic() - start if start else None
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

    def in_executor(self, function):
        """The function's value, computed in the thread of the executor.

        rclpy's action client wants that: made in another thread, the executor may meet it half-made, and used in
        another thread, it loses an answer that arrives before it has noted the question.
        """
        return result_of(self.executor.create_task(function))

    def call(self, service_type, name, request):
        client = self.node.create_client(service_type, name)
        try:
            assert client.wait_for_service(LIMIT), f"no service {name}"
            return result_of(client.call_async(request))
        finally:
            self.node.destroy_client(client)

    def listen(self, message_type, topic, qos):
        """Returns a list that grows with the messages of the topic, once the publisher is matched."""
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
    """Starts further nodes. After a failed test they are killed and their output is printed."""
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
    """The node that all tests of a file share."""
    process = NodeProcess()
    yield process
    assert process.stop() == 0
