"""A robot cell for one test: simulator, driver and client, with a separate address and ROS domain."""

import time

import messages
from action_msgs.msg import GoalStatus, GoalStatusArray
from own_domain import Domain
from programs import Simulator, start_node
from publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile
from ros_client import Client
from support import HOME, own_address, wait_for

from ur_ros_rtde_msgs.action import DashboardCommand, DashboardQuery, EnableExternalFtSensor, MoveJ, Stop
from ur_ros_rtde_msgs.msg import ErrorCode

EXAMPLE_LIMIT = 20.0  # s, time limit of the examples in the documentation
SETTINGS = ("tcp_offset", "payload", "io", "robot_mode", "safety_mode", "remote_control", "freedrive", "popup")
STATUS = QoSProfile(depth=50, durability=DurabilityPolicy.TRANSIENT_LOCAL)
TERMINAL = (GoalStatus.STATUS_SUCCEEDED, GoalStatus.STATUS_CANCELED, GoalStatus.STATUS_ABORTED)
AT_REST = 0.01  # rad/s
RETRY_INTERVAL = 0.05  # s
RESTART_DISABLED = "restart_program is off: start the driver again"
PREPARE_LIMIT = 3.0  # s, to return home after an example
# The plugins that a cell itself, or a tutorial, uses.
OWN_PLUGINS = {"move_j", "move_l_relative", "move_until_force", "stop", "ft_rtde_input_enable", *(f"dashboard/{name}" for name in
               ("robot_mode", "unlock_protective_stop", "power_on", "brake_release"))}
CODES = {value: name for name, value in vars(ErrorCode).items() if name.isupper() and isinstance(value, int)}


class StatusTrackingClient(Client):
    """Records the terminal states of goals from the status topics, which would reveal a second terminal state."""

    def __init__(self, domain=None, name="test_client"):
        self._terminal_states, self._status_subscriptions = {}, {}
        super().__init__(domain=domain, name=name)

    def send_goal(self, action, name, message):
        if name not in self._status_subscriptions:
            self._status_subscriptions[name] = self.node.create_subscription(GoalStatusArray, f"{name}/_action/status",
                                                                             self._on_status, STATUS)
        goal = super().send_goal(action, name, message)
        goal.request_result_when_accepted()
        return goal

    def destroy_action_client(self, name):
        super().destroy_action_client(name)
        subscription = self._status_subscriptions.pop(name, None)
        if subscription is not None:
            self.call_in_executor(lambda: self.node.destroy_subscription(subscription))

    def _on_status(self, message):
        for entry in message.status_list:
            if entry.status in TERMINAL:
                self._terminal_states.setdefault(bytes(entry.goal_info.goal_id.uuid), set()).add(entry.status)

    def get_terminal_states(self, goal):
        """Waits for a terminal state of the goal on the status topic. Returns all of its terminal states."""
        return wait_for(lambda: self._terminal_states.get(goal.id), 15.0, "a terminal state on the status topic")

    def forget(self, goal):
        """Removes the goal from the records, so that they do not grow in long runs."""
        self._terminal_states.pop(goal.id, None)


class Cell:
    def __init__(self, number, setup):
        self.number, self.setup = number, setup
        self._domain = Domain()
        self._env = {"ROS_DOMAIN_ID": str(self._domain.number)}
        self.simulator = Simulator(own_address(number), model=setup.controller)
        self.client = StatusTrackingClient(self._domain.number, f"test_client_{number}")
        self.driver, self._plugins = None, None
        self._publishers = []
        self.start_driver()

    def close(self):
        self._stop_publishers()
        self.driver.stop()
        self.client.close()
        self.simulator.stop()
        self._domain.close()

    def _stop_publishers(self):
        for publisher in self._publishers:
            publisher.stop()
        self._publishers.clear()

    def start_driver(self):
        chosen = [f"plugins:=[{', '.join(sorted(self._plugins))}]"] if self._plugins else []
        self.driver = start_node("driver", self.simulator.address, f"ur_type:={self.setup.controller}", *chosen, *self.setup.parameters,
                                 env=self._env)

    def load_plugins(self, *names):
        """Starts the driver again with these plugins and those of the cell, or without names with all. The start of a driver with few
        plugins, and its discovery, take a fifth of the processor time."""
        plugins = {*names, *OWN_PLUGINS} if names else None
        if plugins != self._plugins:
            self._plugins = plugins
            self.driver.stop()
            self.start_driver()

    def restart_simulator(self):
        if self.simulator.process.running():
            self.simulator.kill()
        self.simulator.start()

    def _dashboard_answers(self):
        goal = self.client.send(DashboardQuery, "dashboard/robot_mode")
        return goal.accepted and goal.result().success or time.sleep(RETRY_INTERVAL)

    # --- Goals ---

    def good_goal(self, example):
        kind = messages.load(example.type)
        return kind, messages.fill(kind.Goal(), example.goal)

    def send(self, example):
        kind, message = self.good_goal(example)
        return self.client.send_goal(kind, example.action, message)

    def rejection(self, goal):
        return self.client.rejection(goal).message

    # --- Initial state of an example ---

    def prepare(self, example=None):
        """Moves the arm home, removes obstacles, and sets up the example's scene."""
        assert self.driver.running(), self.driver.output()
        self._stop_publishers()
        if example and self._plugins and example.action not in self._plugins:
            self.load_plugins()
        try:
            self.restore(PREPARE_LIMIT)
        except (AssertionError, OSError):
            # The previous example left the controller in a state that requires a restart.
            self.restart_simulator()
            self.restore()
        for command in example.scene if example else ():
            self._run_scene_command(dict(command))
        for topic in example.topics if example else ():
            self._publish(topic)

    def _publish(self, topic):
        """Publishes the topic until the next example is prepared."""
        kind = messages.load(topic.type)
        message = messages.fill(kind(), topic.message)
        self._publishers.append(Publisher(self.client, kind, topic.name, lambda _time: message, topic.rate))

    def _run_scene_command(self, command):
        """Executes one command of a scene. `then_wait` is a delay afterwards, in seconds of simulated time."""
        seconds = command.pop("then_wait", 0.0)
        self.simulator.control(**command)
        self.simulator.wait(seconds, 10.0 + 5.0 * seconds)

    def restore(self, limit=30.0):
        """Restarts what has exited, resets the simulator and moves the arm home."""
        if not self.simulator.process.running():
            self.restart_simulator()
        self._move_home(limit)
        if self.simulator.state()["external_sensor"]:  # without readings
            self.client.send(EnableExternalFtSensor, "ft_rtde_input_enable", enable=False).succeeded()
        # The dashboard client reconnects at longer intervals.
        wait_for(self._dashboard_answers, 20.0, "the dashboard server")

    def _reset_simulator(self):
        control = self.simulator.control
        for command in ("clear_surfaces", "clear_boxes", "clear_pushes"):
            control(command)
        control("speed_slider", fraction=1.0)
        control("set_sensor_noise", force=0.0)
        state = self.simulator.state()
        if state["popup"] is not None:
            control("close_popup")
        if not state["remote_control"]:
            control("remote_control", on=True)
        if state["robot_mode"] != "RUNNING" and state["safety_mode"] in ("NORMAL", "REDUCED"):
            control("power", to="running")

    def _move_home(self, limit):
        """Waits until the driver accepts motions and the arm is at home."""
        reasons = ["none"]

        def is_at_home():
            if any(RESTART_DISABLED in line for line in list(self.driver.lines)):
                self.driver.stop()
                self.start_driver()
            self._reset_simulator()
            goal = self.client.send(MoveJ, "move_j", joint_positions=HOME, speed=3.0, acceleration=15.0)
            if goal.accepted and goal.result().success:
                return True
            reasons.append(goal.result().message if goal.accepted else self.rejection(goal))
            time.sleep(RETRY_INTERVAL)
            return False

        try:
            wait_for(is_at_home, limit, "the driver to accept a motion")
        except AssertionError as error:
            raise AssertionError(f"{error}; last message: {reasons[-1]}") from None

    def stop_arm(self):
        """Ends a mode that a goal has left active: force mode or freedrive."""
        goal = self.client.send(Stop, "stop")
        if goal.accepted:
            goal.wait_for_result()

    def settings(self):
        """Returns the part of the simulator's state that an example may leave changed."""
        state = self.simulator.state()
        return {name: state[name] for name in SETTINGS}

    # --- Checks and recovery after an event ---

    def at_rest(self):
        return max(map(abs, self.simulator.state()["actual"]["velocity"])) < AT_REST

    def wait_for_rest(self, limit=3.0):
        wait_for(self.at_rest, limit, "standstill")

    def unlock_protective_stop(self):
        """Unlocks a protective stop with the dashboard, which is possible 5 s after the stop at the earliest."""
        if self.simulator.state()["safety_mode"] == "PROTECTIVE_STOP":  # an arm without power cannot stop
            self._repeat_until_success("dashboard/unlock_protective_stop", timeout=10.0)

    def power_up(self):
        """Powers the arm on with the dashboard, which rejects while the safety system restarts."""
        self._repeat_until_success("dashboard/power_on", timeout=20.0)
        goal = self.client.send(DashboardCommand, "dashboard/brake_release", timeout=20.0)
        assert goal.accepted, self.rejection(goal)
        goal.succeeded()

    def _repeat_until_success(self, name, **fields):
        def succeeded():
            goal = self.client.send(DashboardCommand, name, **fields)
            return goal.accepted and goal.result().success or time.sleep(RETRY_INTERVAL)

        wait_for(succeeded, 20.0, f"{name} to succeed")


def describe_result(status, result):
    name = {value: key for key, value in vars(GoalStatus).items() if key.startswith("STATUS_")}.get(status, status)
    return f"{name}, {CODES.get(result.error_code, result.error_code)}: {result.message}"

