"""A simulated robot with its driver and a client, from one case to the next."""

import os
import pathlib
import socket
import time
from typing import Any, Dict, List, Optional, Tuple

from cell import StatusTrackingClient
from own_domain import Domain
from plugin_prefix import TEST_COMMANDS, environment_of_test_commands
from programs import Process, Simulator, start_node
from rclpy.qos import QoSProfile
from support import HOME, wait_for

from ur_ros_rtde_msgs.action import MoveJ
from ur_ros_rtde_msgs.msg import ErrorCode

from .cases import PROFILES
from .events import CONTROL_PROGRAM
from .goal_kinds import home_plus
from .running import start_client

READY_LIMIT = 10.0  # s, from the end of a disturbance to the first accepted motion
RETRY_INTERVAL = 0.05  # s
DISCOVERY_LIMIT = 20.0  # s


class Robot:
    def __init__(self, address: str, log: pathlib.Path):
        self._domain = Domain()
        test_commands = environment_of_test_commands(log / f"prefix_{TEST_COMMANDS}_{os.getpid()}")
        self.packages = ["ur_ros_rtde_tutorials", *([TEST_COMMANDS] if test_commands else [])]  # that are built with the tests
        self._env = {"ROS_DOMAIN_ID": str(self._domain.number), **test_commands}
        self._address, self.profile = address, ""
        self.driver: Any = None  # Process
        self.simulator = Simulator(address, recovery_time_factor=0.02)
        self._known_lapses = self.simulator.state()["lapses"]
        self._logged = 0  # number of the newest known entry of the simulator's log
        self.client = StatusTrackingClient(self._domain.number, "stops")
        self.accepted_at = 0  # the newest motion to home, ns since the epoch
        self._spare: Optional[Process] = None
        self._publishers: Dict[str, Any] = {}

    def close(self) -> None:
        if self._spare is not None:
            self._spare.kill()
        if self.driver is not None:
            self.driver.stop()
        self.client.close()
        self.simulator.kill()
        self._domain.close()

    def now(self) -> int:
        return time.time_ns()

    def sleep_until(self, when: float) -> None:
        time.sleep(max(0.0, 1e-9 * (when - time.time_ns())))

    # --- Clients ---

    def take_client(self) -> Process:
        client = self._spare or start_client(self._env)
        self._spare = None
        client.wait_for_output("ready", 30.0)
        return client

    def publisher(self, kind: Any, topic: str) -> Any:
        if topic not in self._publishers:
            create = self.client.node.create_publisher
            self._publishers[topic] = self.client.call_in_executor(lambda: create(kind, topic, QoSProfile(depth=1)))
        publisher = self._publishers[topic]
        wait_for(lambda: publisher.get_subscription_count() > 0, 20.0, f"a subscription of {topic}")
        return publisher

    # --- The driver ---

    def restart_driver(self, profile: str = "") -> None:
        """With the URCap, what follows its node in the program of the operator moves the arm: it must not be reached."""
        if self.driver is not None:
            self.driver.stop()
            # Until then, the client sends its requests to the driver that has ended.
            wait_for(lambda: not self.client.sees("move_j"), DISCOVERY_LIMIT, "the driver to disappear")
        self.profile = profile or self.profile
        parameters = PROFILES[self.profile]
        if self.profile == "urcap":
            port = unused_port()
            parameters = (*parameters, f"urcap_port:={port}")
            next_motion = f"movej({home_plus(0.3)}, a=5, v=1)"
            self.simulator.control("store_external_control", host="127.0.0.1", port=port, next=next_motion)
        self.driver = start_node("driver", self._address, "ur_type:=ur10e", *parameters, env=self._env)
        if self.profile == "urcap":
            self.driver.wait_for_output("start the program with the External Control node", 30.0)
        self.move_home(30.0)

    def move_home(self, limit: float = READY_LIMIT, accepts_at_once: bool = False) -> Tuple[List[str], List[str]]:
        """Moves home, as soon as the driver accepts it. Returns the violations, and those of a driver that `accepts_at_once`."""
        leaks: List[str] = []
        delays: List[str] = []

        def has_moved() -> bool:
            assert self.driver.running(), "the driver has exited"
            self.play()
            goal = self.client.send(MoveJ, "move_j", joint_positions=HOME, speed=3.0, acceleration=15.0)
            if not goal.accepted:
                rejection = self.client.rejection(goal)
                if rejection.error_code == ErrorCode.BUSY:
                    leaks.append(f"the lease is not free: {rejection.message}")
                else:
                    delays.append(f"the next goal was rejected: {rejection.message}")
                time.sleep(RETRY_INTERVAL)
                return False
            self.accepted_at = self.now()
            _status, result = goal.wait_for_result()
            self.client.forget(goal)
            if not result.success:
                delays.append(f"the next goal failed: {result.message}")
            return bool(result.success)

        wait_for(has_moved, limit, "the driver to move the arm home")
        return leaks[:1], delays[:1] if accepts_at_once else []

    def start_over(self) -> None:
        """After a failure that has left the robot or the driver in an unknown state."""
        self.driver.stop()
        self.simulator.kill()
        self.simulator.start()
        self._known_lapses, self._logged = self.simulator.state()["lapses"], 0
        self.restart_driver()

    def wait_until_commands_have_returned(self) -> None:
        """The driver rejects a goal of a command whose abandoned goal has not returned: one that never looks, of the case before."""
        def lines(text: str) -> int:
            return sum(text in line for line in list(self.driver.lines))

        wait_for(lambda: lines("its command has returned after its result was sent") >= lines("the command did not return after that"),
                 READY_LIMIT, "the return of an abandoned command")

    # --- The program of the robot ---

    def play(self) -> None:
        """With the URCap, the operator starts the program when it is stopped."""
        if self.profile == "urcap" and self.simulator.state()["program"]["state"] == "STOPPED":
            self.simulator.may("play")

    def wait_until_program_runs(self) -> None:
        """The driver starts its program again: from now on, an old goal could use it. An arm that is pressed on something while the driver
        is held may come to a protective stop."""
        def runs() -> bool:
            self.play()
            state = self.simulator.state()
            if state["safety_mode"] == "PROTECTIVE_STOP":
                self.simulator.unlock_protective_stop()
            return state["program"]["state"] == "PLAYING" and state["clients"]["rtde_control"] > 0

        wait_for(runs, READY_LIMIT, "the control program")

    def program_has_started(self) -> bool:
        """Returns whether the control program has started since the last call, according to the log of the simulator."""
        entries = self.simulator.control("log", after=self._logged)["entries"]
        self._logged = entries[-1]["number"] if entries else self._logged
        return any(entry["text"] == f"program '{CONTROL_PROGRAM}' started" for entry in entries)

    def new_lapses(self) -> Dict[str, int]:
        """Returns how many motions were broken off, and how many began while the arm moved, since the last call."""
        before, self._known_lapses = self._known_lapses, self.simulator.state()["lapses"]
        return {name: count - before[name] for name, count in self._known_lapses.items() if count != before[name]}


def unused_port() -> int:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]
