"""Arguments of the launch files and the validation of their names and values. Does not depend on launch."""

import copy
import difflib
import os
import re
import shlex
import tempfile
from dataclasses import dataclass
from typing import Any, Collection, Dict, Iterable, List, Optional, Tuple

import yaml

NODES = ("robot_state_receiver", "command_server", "dashboard_server")
MODELS = ("ur3", "ur5", "ur10", "ur3e", "ur5e", "ur7e", "ur10e", "ur12e", "ur16e", "ur8long", "ur15", "ur18", "ur20", "ur30")
DEFAULT_SIMULATED_MODEL = "ur10e"  # used if ur_type is empty
QOS = ("default", "reliable", "best_effort", "sensor_data", "latched", "transient_local", "services_default", "parameters",
       "system_default")


# (regular expression, what it allows)
NAME_PART = (r"[A-Za-z0-9_/]*", "letters, digits, _ and /")
_NAME = r"[A-Za-z_][A-Za-z0-9_]*"
NAMESPACE = (rf"/?|/?{_NAME}(/{_NAME})*", "names of letters, digits and _ that begin with no digit, separated by /")
_BYTE = r"(25[0-5]|2[0-4]\d|1?\d?\d)"
LOOPBACK = (rf"127(\.{_BYTE}){{3}}", "a loopback address: 127.0.0.1, 127.0.0.2, ...")


class ArgumentError(RuntimeError):
    """An invalid launch argument. The text states the name, the value and the allowed values."""


@dataclass(frozen=True)
class Argument:
    """A launch argument. The type of `default` is the type of its values.

    `()` stands for a list of strings. None stands for a required string.
    """

    name: str
    default: Any
    description: str
    choices: Tuple[str, ...] = ()
    limits: Optional[Tuple[float, float]] = None
    least: float = 0.0  # of a number that may be 0: the smallest other value
    pattern: Optional[Tuple[str, str]] = None

    @property
    def default_text(self) -> Optional[str]:
        if self.default is None:
            return None
        if isinstance(self.default, tuple):
            return "[" + ", ".join(self.default) + "]"
        return str(self.default).lower() if isinstance(self.default, bool) else str(self.default)

    @property
    def text_choices(self) -> Tuple[str, ...]:
        return ("true", "false") if isinstance(self.default, bool) else self.choices

    @property
    def range(self) -> str:
        low, high = self.limits or (0.0, 0.0)
        return f"from {self.least or low:g} to {high:g}{', or 0' if self.least else ''}"

    @property
    def help(self) -> str:
        return f"{self.description} F{self.range[1:]}." if self.limits else self.description

    def value(self, text: str) -> Any:
        """Converts `text` to the type of the argument. Raises ArgumentError if it is not a valid value."""
        if self.text_choices and text not in self.text_choices:
            raise self._error(text, "one of: " + ", ".join(choice or "'' (empty)" for choice in self.text_choices))
        if isinstance(self.default, bool):
            return text == "true"
        if isinstance(self.default, (int, float)):
            return self._number(text)
        if isinstance(self.default, tuple):
            return self._strings(text)
        if self.pattern is not None and not re.fullmatch(self.pattern[0], text):
            raise self._error(text, self.pattern[1])
        return text

    def _number(self, text: str) -> float:
        kind = type(self.default)
        assert self.limits is not None  # every number has limits
        low, high = self.limits
        allowed = f"{'an integer' if kind is int else 'a number'} {self.range}"
        try:
            number = kind(text)
        except ValueError:
            raise self._error(text, allowed) from None
        if not low <= number <= high or 0.0 < number < self.least:
            raise self._error(text, allowed)
        return number

    def _strings(self, text: str) -> List[str]:
        try:
            strings = yaml.safe_load(text)
        except yaml.YAMLError:
            strings = None
        if not isinstance(strings, list) or not strings or not all(isinstance(string, str) for string in strings):
            raise self._error(text, f"a list of names, for example {self.name}:=\"[first, second]\"; omit the "
                              "argument to use the default")
        return strings

    def _error(self, text: str, allowed: str) -> ArgumentError:
        return ArgumentError(f"launch argument {self.name} is \"{text}\", it must be {allowed}")


# Each argument is a parameter of the nodes with the same name, type, default, choices and limits.
PARAMETERS = (
    Argument("robot_ip", "", "Address or host name of the robot controller. Ignored with sim:=true, which uses sim_ip."),
    Argument("ur_type", "", "Model of the arm. If empty, it is read from the controller.", ("", *MODELS)),
    Argument("tf_prefix", "", "Prefix of the names of joints and frames, for example left_.", pattern=NAME_PART),
    Argument("publish_tf", True, "Broadcasts the transform from base to tool0_controller on /tf."),
    Argument("rtde_frequency", 500.0, "Rate of the published state in Hz. A CB3 controller supports at most 125.",
             limits=(1.0, 500.0)),
    Argument("qos", "reliable", "Quality of service profile of the published state.", QOS),
    Argument("robot_state_fields", (), "RTDE outputs that are published on robot_state, for example [timestamp, actual_q]."),
    Argument("silence_limit", 0.1, "Time in s without an RTDE package after which the connection counts as lost.",
             limits=(0.02, 10.0)),
    Argument("realtime_priority", 0, "SCHED_FIFO priority of the threads that run in each control cycle. 0 selects the default "
             "scheduler.", limits=(0, 99)),
    Argument("control_mode", "upload", "How the robot receives the control program. upload: the driver sends it. control_urcap: "
             "the External Control URCap fetches it.", ("upload", "control_urcap")),
    Argument("urcap_port", 50002, "Port at which the External Control URCap requests the control program.", limits=(1, 65535)),
    Argument("urcap_extensions", False, "With control_urcap: the robot has the URCaps whose functions commands need."),
    Argument("register_range", "lower", "General purpose registers of the driver. lower: 0 to 23. upper: 24 to 47, for robots on "
             "which a fieldbus uses the lower registers.", ("lower", "upper")),
    Argument("watchdog_frequency", 10.0, "Minimum rate in Hz of the driver's heartbeats. The robot stops the arm after "
             "1/watchdog_frequency s without one. 0 disables the watchdog.", limits=(0.0, 50.0), least=1.0),
    Argument("restart_program", True, "Restarts the control program after it was stopped. The interrupted motion is not resumed."),
    Argument("on_busy", "reject", "What happens to a motion goal while another motion runs. reject: it is rejected. preempt: it "
             "stops the running motion.", ("reject", "preempt")),
    Argument("on_client_lost", "stop", "What happens to a motion whose client has disappeared.", ("stop", "continue")),
    Argument("servers", "on_demand", "When the endpoints of an action are created: for its first client, or at the start.",
             ("on_demand", "always")),
    Argument("stream_timeout", 0.1, "Time in s without a message after which teleoperation by a topic ends.", limits=(0.02, 1.0)),
    Argument("stream_max_joint_jump", 0.2, "Largest distance in rad of a teleoperation target from the current setpoint.",
             limits=(0.001, 1.0)),
    Argument("stream_max_linear_jump", 0.1, "Largest distance in m of a teleoperation target from the current setpoint.",
             limits=(0.001, 1.0)),
    Argument("stream_acceleration", 1.0, "Acceleration of the TCP in m/s^2 until a twist is reached.", limits=(0.01, 150.0)),
    Argument("stream_deceleration", 2.0, "Deceleration in rad/s^2 and m/s^2 at the end of teleoperation.", limits=(0.1, 40.0)),
    Argument("stream_lookahead_time", 0.1, "Lookahead time in s of servo control on the controller during teleoperation.",
             limits=(0.03, 0.2)),
    Argument("stream_gain", 300.0, "Proportional gain of servo control on the controller during teleoperation.",
             limits=(100.0, 2000.0)),
    Argument("plugins", (), "Names of the plugins to load. By default, all installed plugins are loaded."),
    Argument("plugins_blacklist", (), "Names of the plugins that are not loaded."),
)

# Further arguments of driver.launch.py.
OPTIONS = (
    Argument("sim", False, "Starts the simulated robot of ur_simulator and connects to it."),
    Argument("sim_ip", "127.0.0.1", "Loopback address of the simulated robot: 127.0.0.1, 127.0.0.2, ...", pattern=LOOPBACK),
    Argument("namespace", "", "Namespace of the nodes. Use one namespace per robot.", pattern=NAMESPACE),
    Argument("one_process", True, "Runs all nodes in one process with one RTDE connection for the state."),
    Argument("params_file", "", "YAML file with parameters of the nodes. Arguments of the launch file have priority over it."),
)

DRIVER = (*PARAMETERS, *OPTIONS)


def _robot_arguments(side: str, number: int) -> Tuple[Argument, ...]:
    return (Argument(f"{side}_robot_ip", "", f"Address or host name of the controller of the {side} robot."),
            Argument(f"{side}_ur_type", "", f"Model of the {side} arm. If empty, it is read from the controller.", ("", *MODELS)),
            Argument(f"{side}_namespace", side, f"Namespace of the nodes of the {side} robot.", pattern=NAMESPACE),
            Argument(f"{side}_tf_prefix", f"{side}_", f"Prefix of the names of joints and frames of the {side} robot.",
                     pattern=NAME_PART),
            Argument(f"{side}_urcap_port", 50001 + number, f"Port for the External Control URCap of the {side} robot.",
                     limits=(1, 65535)),
            Argument(f"{side}_sim_ip", f"127.0.0.{number}", f"Loopback address of the {side} simulated robot.", pattern=LOOPBACK))


# Arguments of two_robots.launch.py. The other arguments of driver.launch.py are passed to both drivers.
SIDES = ("left", "right")
TWO_ROBOTS = (*_robot_arguments("left", 1), *_robot_arguments("right", 2))
PER_ROBOT = tuple(argument.name[len("left_"):] for argument in _robot_arguments("left", 1))
UNIQUE = ("namespace", "tf_prefix", "urcap_port", "robot_ip", "sim_ip")  # must differ between the robots


def check_differ(values: Dict[str, Any]) -> None:
    """Raises ArgumentError if what must be different is the same for both robots. `values` are those of TWO_ROBOTS."""
    for name in UNIQUE:
        left, right = (str(values[f"{side}_{name}"]).strip("/") for side in SIDES)  # the namespaces "arm" and "/arm" are one
        if left == right and (left or name != "robot_ip"):  # without addresses, they are simulated
            raise ArgumentError(f"left_{name} and right_{name} are both \"{left}\", they must differ")


# Arguments of moveit.launch.py. The other arguments of driver.launch.py are passed to the driver.
MOVEIT = (
    Argument("ur_type", None, "Model of the arm.", MODELS),
    Argument("kinematics_params_file", "", "YAML file with the calibration of the arm for ur_description. If empty, that of the "
             "model is used."),
    Argument("launch_rviz", True, "Starts RViz with the MoveIt display."),
)
OTHER_NAMES = {"model": "ur_type", "address": "robot_ip", "ip": "robot_ip", "prefix": "tf_prefix"}  # of other programs and drivers
UNSUPPORTED_BY_MOVEIT = ("namespace", "tf_prefix")  # ur_moveit_config has neither of them


def check_name(name: str, known: Collection[str], launch_file: str) -> None:
    """Raises ArgumentError with the most similar known name if `name` is unknown."""
    if name in known:
        return
    nearest = [OTHER_NAMES[name]] if OTHER_NAMES.get(name) in known else difflib.get_close_matches(name, known, 1)
    hint = f"did you mean {nearest[0]}? " if nearest else ""
    raise ArgumentError(f"{launch_file} has no launch argument {name}; {hint}"
                        f"`ros2 launch ur_ros_rtde {launch_file} --show-args` lists all arguments")


def to_values(arguments: Iterable[Argument], texts: Dict[str, str]) -> Dict[str, Any]:
    """Returns the values of the arguments that `texts` contains."""
    return {argument.name: argument.value(texts[argument.name]) for argument in arguments if argument.name in texts}


def check_file(name: str, path: str) -> None:
    """Raises ArgumentError if `path`, the value of the argument `name`, is given and is no file."""
    if path and not os.path.isfile(path):
        raise ArgumentError(f"{name} is \"{path}\": the file does not exist")


def xacro_arguments(model: str, kinematics_params_file: str) -> str:
    """Returns the arguments of ur.urdf.xacro of ur_description, which would look for a relative path in its own folder."""
    calibration = f" kinematics_params:={shlex.quote(os.path.abspath(kinematics_params_file))}" if kinematics_params_file else ""
    return f"name:={model} ur_type:={model}{calibration}"


def write_parameters(parameters: Dict[str, Any]) -> str:
    """Writes a temporary parameter file and returns its path. It must be the last parameter file of the nodes.

    launch_ros writes parameters under "/**" if several nodes run in one process. Parameters of another file for a specific node
    would then have priority. Of all matching names, a node uses the one that appears last for the first time. The name that is
    used here matches in every namespace and appears in no other file, so it is always the last one.
    """
    with tempfile.NamedTemporaryFile("w", prefix="ur_ros_rtde_", suffix=".yaml", delete=False) as file:
        # One copy per node: YAML writes repeated objects as references, which the parser of rcl does not support.
        yaml.safe_dump({f"/**/**/{node}": {"ros__parameters": copy.deepcopy(parameters)} for node in NODES}, file)
    return file.name
