"""The ROS node of a Robot. One thread executes its callbacks and sends its requests."""

import concurrent.futures
import contextlib
import logging
import os
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

from ur_ros_rtde_cli import actions, errors, fastdds_profile

from .conversions import interface
from .errors import NoDriver, RobotError, Timeout, UnknownCommand

T = TypeVar("T")
Answer = concurrent.futures.Future[Any]  # of a request

REQUEST_TIMEOUT = 10.0  # s, to send a request
REJECTION_TIMEOUT = 2.0  # s, for the reason of a rejected goal
REJECTIONS = 100  # messages to keep: those of all clients are received
DISCOVERY_TIME = 1.0  # s, after which a name that was not discovered counts as unknown
POLL_PERIOD = 0.01  # s; changes of the ROS graph do not wake the executor
OPEN_PERIOD = 0.5  # s, between two checks of whether the connection is open


def until(condition: Callable[[], T], timeout: float, period: float = POLL_PERIOD) -> T | None:
    """Returns the first true value of `condition`, or None after `timeout` s."""
    end = time.monotonic() + timeout
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() >= end:
            return None
        time.sleep(period)


def load(name: str, kind: str) -> Any:
    """Returns the class of an action type. Raises RobotError if it is not installed."""
    try:
        return actions.load(name, kind)
    except errors.CliError as error:
        raise RobotError(str(error)) from None


@contextlib.contextmanager
def own_signals() -> Iterator[None]:
    """For a wait in the main thread: without the signal handlers of rclpy.init(), which shut down all contexts. That of a Robot would be
    gone before its goals can be canceled."""
    from rclpy.signals import (
        SignalHandlerOptions,
        get_current_signal_handlers_options,
        install_signal_handlers,
        uninstall_signal_handlers,
    )

    installed = get_current_signal_handlers_options()
    if installed == SignalHandlerOptions.NO or threading.current_thread() is not threading.main_thread():
        yield
        return
    uninstall_signal_handlers()
    try:
        yield
    finally:
        install_signal_handlers(installed)


@contextlib.contextmanager
def ending(what: str) -> Iterator[None]:
    """For an end of `what` while an exception propagates: an error of the end is only logged. An interruption propagates, too."""
    try:
        yield
    except BaseException as error:
        reason = str(error) or type(error).__name__
        logging.getLogger("ur_ros_rtde").error("the end of %s is not confirmed: %s", what, reason)  # on stderr by default
        if not isinstance(error, RobotError):
            raise


def end_even_if_interrupted(what: str, function: Callable[[], object], may_repeat: Callable[[], bool] = lambda: True) -> None:
    """Calls `function`, which ends `what`. Ctrl-C propagates after a second call, if `may_repeat` returns true."""
    try:
        function()
    except (KeyboardInterrupt, SystemExit):
        if may_repeat():
            with ending(what):
                function()
        raise


class Connection:
    """`timeout` limits the waits for the driver, its responses and its samples, `result_timeout` those for results, in s."""

    def __init__(self, namespace: str, timeout: float, result_timeout: float):
        fastdds_profile.use()
        import rclpy
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.signals import SignalHandlerOptions

        self.timeout, self.result_timeout = timeout, result_timeout
        self._context = rclpy.Context()
        rclpy.init(context=self._context, signal_handler_options=SignalHandlerOptions.NO)
        # The arguments of the program may move all its nodes to another namespace: that of another arm.
        self.node: Any = rclpy.create_node("ur_ros_rtde_python", namespace=namespace.strip("/") or None, context=self._context,
                                           use_global_arguments=not namespace, enable_rosout=False, start_parameter_services=False)
        self.namespace: str = self.node.get_namespace().rstrip("/")
        self._created_at = time.monotonic()
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self._clients: dict[str, Any] = {}  # of actions and services, by full name
        self.types: dict[str, str] = {}  # of the actions of which there are clients
        self._rejections: dict[bytes, Any] = {}
        self._was_closed = False  # by close()
        self._subscribe_rejections()
        self._thread = threading.Thread(target=self._spin, name="ur_ros_rtde", daemon=True)
        self._thread.start()

    def _spin(self) -> None:
        try:
            self._executor.spin()
        except Exception:  # of rclpy, if ROS was shut down in this program: check_open() reports that
            if self._context.ok():
                raise

    def close(self) -> None:
        self._was_closed = True
        self._executor.shutdown()
        self._thread.join(REQUEST_TIMEOUT)
        self.node.destroy_node()
        self._context.try_shutdown()

    @property
    def is_open(self) -> bool:
        return not self._was_closed and bool(self._context.ok()) and self._thread.is_alive()

    def check_open(self) -> None:
        """Raises RobotError with the cause if the connection is closed."""
        if self.is_open:
            return
        if self._was_closed:
            raise RobotError("the Robot is closed")
        if not self._context.ok():
            raise RobotError("the Robot is closed: a signal handler of rclpy.init() has shut down ROS in this program")
        raise RobotError("the Robot is closed: the thread of its node has ended")

    def over_open_connection(self, function: "Callable[[Connection], T]") -> T:
        """Calls `function` with this connection, or with a new one if this one is closed before or in the meantime: by the signal handlers
        of rclpy.init(), for example while the program was in rclpy.spin()."""
        with own_signals():
            if self.is_open:
                try:
                    return function(self)
                except RobotError:
                    if self.is_open:
                        raise
            with contextlib.closing(Connection(self.namespace, self.timeout, self.result_timeout)) as fresh:
                return function(fresh)

    def wait(self, future: Answer, timeout: float) -> bool:
        """Returns whether a future of the executor's thread is done within `timeout` s. Raises RobotError if the connection is closed."""
        end = time.monotonic() + timeout
        while True:
            rest = end - time.monotonic()
            if concurrent.futures.wait([future], max(0.0, min(OPEN_PERIOD, rest))).done:
                return True
            self.check_open()
            if rest <= 0.0:
                return False

    def ask(self, question: Callable[[], T]) -> T:
        """Returns the answer to a question about the ROS graph. Raises RobotError if the connection is closed."""
        self.check_open()
        try:
            return question()
        except RuntimeError:  # of rclpy: ROS was shut down in the meantime
            self.check_open()
            raise

    def until(self, condition: Callable[[], T], timeout: float) -> T | None:
        """As until(), for a condition in the ROS graph. Raises RobotError if the connection is closed."""
        return until(lambda: self.ask(condition), timeout)

    def in_executor(self, function: Callable[[], T]) -> T:
        """Calls `function` in the executor's thread and returns its result.

        rclpy loses a response that arrives while another thread is still sending the request."""
        self.check_open()
        if threading.current_thread() is self._thread:
            return function()
        done: concurrent.futures.Future[T] = concurrent.futures.Future()

        def call() -> None:
            try:
                done.set_result(function())
            except BaseException as error:
                done.set_exception(error)

        self._executor.create_task(call)
        if not self.wait(done, REQUEST_TIMEOUT):
            raise Timeout(f"the node could not send a request within {REQUEST_TIMEOUT:g} s")
        return done.result()

    # Actions

    def full_name(self, name: str) -> str:
        return f"{self.namespace}/{name}"

    def served(self) -> dict[str, str]:
        """Returns the types of the driver's actions by their name in the namespace."""
        start = self.namespace + "/"
        return {name[len(start):]: kind for name, kind in actions.served(self.node).items() if name.startswith(start)}

    def type_of(self, name: str) -> str:
        """Returns the type of an action: that of its server, which may differ from the installed one."""
        known = actions.type_of_plugin(name)
        timeout = self.timeout if known else self._created_at + DISCOVERY_TIME - time.monotonic()
        found = self.until(lambda: self.served().get(name), timeout)
        if found is None:
            raise self._not_served(name, known)
        return found

    def action_client(self, name: str) -> Any:
        """Returns the client of an action whose server is known. Raises NoDriver or UnknownCommand."""
        self.check_open()
        if name not in self._clients:
            from rclpy.action import ActionClient

            # A client that is created while announcements of the server are still arriving would be discovered only in part.
            self.types[name] = self.type_of(name)
            action = load(name, self.types[name])
            self._clients[name] = self.in_executor(lambda: ActionClient(self.node, action, name))
        client = self._clients[name]
        if not self.until(client.server_is_ready, self.timeout):
            raise self._not_served(name, name)
        return client

    def _not_served(self, name: str, is_installed: str | None) -> RobotError:
        served = self.served()
        if not is_installed:
            known = {*served, *actions.plugin_names()}
            hint = actions.suggestion(name, known) or f"; the commands are: {', '.join(sorted(known))}"
            return UnknownCommand(f"there is no command {name}{hint}")
        domain = os.environ.get("ROS_DOMAIN_ID", "0")
        others = sorted(full for full in actions.served(self.node) if full.endswith("/" + name) and full != self.full_name(name))
        if others:
            hint = f"It is served as {', '.join(others)}: check the namespace of the Robot."
        elif served:
            hint = "The driver runs without this plugin: check its parameter `plugins`, and its log for plugins that failed."
        else:
            hint = f"Start the driver, or check the namespace and ROS_DOMAIN_ID ({domain}): ros2 launch ur_ros_rtde driver.launch.py"
        return NoDriver(f"no driver serves {self.full_name(name)} within {self.timeout:g} s. {hint}")

    def _subscribe_rejections(self) -> None:
        def store(message: Any) -> None:
            self._rejections[bytes(message.goal_id.uuid)] = message
            while len(self._rejections) > REJECTIONS:
                self._rejections.pop(next(iter(self._rejections)), None)

        self.subscribe("ur_ros_rtde_msgs/msg/GoalRejected", "goal_rejections", store, latched=True)

    def rejection(self, goal_id: bytes) -> Any:
        """Returns the message about a rejected goal, or None if there is none."""
        return until(lambda: self._rejections.pop(goal_id, None), REJECTION_TIMEOUT, 0.001)

    # Services and topics

    def call(self, kind: str, name: str, done: Answer | None = None, /, **request: Any) -> Any:
        """Returns the response of a service. Raises NoDriver, or RobotError with the reason if it fails or the connection is closed.

        `done` receives the response, even after an exception. It can be canceled as long as the request was not sent.
        """
        service = interface(kind)
        response = self.request(service, name, service.Request(**request), self.timeout, done)
        if not response.success:
            raise RobotError(response.message)
        return response

    def request(self, service: Any, name: str, request: Any, timeout: float, done: Answer | None = None) -> Any:
        """Returns the response of a service of this class. Raises NoDriver after `timeout` s without one. `done`: see call()."""
        self.check_open()
        if name not in self._clients:
            self._clients[name] = self.in_executor(lambda: self.node.create_client(service, name))
        client = self._clients[name]
        if not self.until(client.service_is_ready, self.timeout):
            raise NoDriver(f"no driver offers the service {self.full_name(name)} within {self.timeout:g} s: start the driver, or check "
                           f"the namespace and ROS_DOMAIN_ID ({os.environ.get('ROS_DOMAIN_ID', '0')})")
        answer: Answer = Answer() if done is None else done
        answer.set_running_or_notify_cancel()  # it cannot be canceled from here on
        self.in_executor(lambda: client.call_async(request).add_done_callback(lambda future: answer.set_result(future.result())))
        if not self.wait(answer, timeout):
            raise NoDriver(f"the service {self.full_name(name)} did not respond within {timeout:g} s")
        return answer.result()

    def subscribe(self, kind: str, topic: str, callback: Callable[[Any], None], latched: bool = False) -> Any:
        from rclpy.qos import DurabilityPolicy, QoSProfile

        durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
        qos = QoSProfile(depth=100 if latched else 2000, durability=durability)
        return self.node.create_subscription(interface(kind), topic, callback, qos)

    def publishers(self, topic: str) -> frozenset[bytes]:
        """Returns the ids of the endpoints that publish a topic now: a driver that has been started again has others."""
        return frozenset(bytes(info.endpoint_gid) for info in self.node.get_publishers_info_by_topic(self.full_name(topic)))

    def unsubscribe(self, subscription: Any) -> None:
        with contextlib.suppress(RobotError):
            self.in_executor(lambda: self.node.destroy_subscription(subscription))
