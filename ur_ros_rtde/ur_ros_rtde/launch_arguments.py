"""The arguments of the launch files, and what is wrong with a value or a name. Needs no launch."""

import copy
import difflib
import tempfile
from dataclasses import dataclass
from typing import Any, Collection, Dict, Iterable, List, Optional, Tuple

import yaml

NODES = ("robot_state_receiver", "command_server", "dashboard_server")
MODELS = ("ur3", "ur5", "ur10", "ur3e", "ur5e", "ur7e", "ur10e", "ur12e", "ur16e", "ur8long", "ur15", "ur18", "ur20", "ur30")
SIMULATED_MODEL = "ur10e"  # where ur_type leaves it open
QOS = ("default", "reliable", "best_effort", "sensor_data", "latched", "transient_local", "services_default", "parameters",
       "system_default")


class ArgumentError(RuntimeError):
    """A launch argument that cannot be used: name, value, and what it may be."""


@dataclass(frozen=True)
class Argument:
    """`default` has the type of the values: `()` stands for a list of strings, None for a text that has to be given."""

    name: str
    default: Any
    description: str
    choices: Tuple[str, ...] = ()
    limits: Optional[Tuple[float, float]] = None

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
    def help(self) -> str:
        if self.limits is None:
            return self.description
        return f"{self.description} From {self.limits[0]:g} to {self.limits[1]:g}."

    def value(self, text: str) -> Any:
        """What `text` says, in the parameter's type."""
        if self.text_choices and text not in self.text_choices:
            raise self._error(text, "one of: " + ", ".join(choice or "'' (empty)" for choice in self.text_choices))
        if isinstance(self.default, bool):
            return text == "true"
        if isinstance(self.default, (int, float)):
            return self._number(text)
        return self._strings(text) if isinstance(self.default, tuple) else text

    def _number(self, text: str) -> float:
        kind = type(self.default)
        low, high = self.limits
        allowed = f"{'an integer' if kind is int else 'a number'} from {low:g} to {high:g}"
        try:
            number = kind(text)
        except ValueError:
            raise self._error(text, allowed) from None
        if not low <= number <= high:
            raise self._error(text, allowed)
        return number

    def _strings(self, text: str) -> List[str]:
        try:
            strings = yaml.safe_load(text)
        except yaml.YAMLError:
            strings = None
        if not isinstance(strings, list) or not strings or not all(isinstance(string, str) for string in strings):
            raise self._error(text, f"a list of names, as in {self.name}:=\"[first, second]\"; leave it out for the default")
        return strings

    def _error(self, text: str, allowed: str) -> ArgumentError:
        return ArgumentError(f"launch argument {self.name} is \"{text}\", it must be {allowed}")


# Each is a parameter of the nodes with this name, type, default, choices and limits.
PARAMETERS = (
    Argument("robot_ip", "", "Address or host name of the robot's controller; with sim:=true it is sim_ip."),
    Argument("ur_type", "", "Model of the arm; empty: detected from the controller.", ("", *MODELS)),
    Argument("tf_prefix", "", "Put before the names of joints and frames, for example left_."),
    Argument("publish_tf", True, "Broadcast the transform from base to tool0_controller."),
    Argument("rtde_frequency", 500.0, "Hz, rate of the published state; a CB3 controller gives at most 125.", limits=(1.0, 500.0)),
    Argument("qos", "reliable", "Quality of service of the published state.", QOS),
    Argument("robot_state_fields", (), "RTDE outputs to publish on robot_state, for example [timestamp, actual_q]."),
    Argument("silence_limit", 0.1, "s, the link counts as lost after this time without a package.", limits=(0.02, 10.0)),
    Argument("realtime_priority", 0, "SCHED_FIFO priority of the threads in the control cycle; 0: none.", limits=(0, 99)),
    Argument("control_mode", "upload", "The control program is sent to the robot, or fetched by the External Control URCap.",
             ("upload", "control_urcap")),
    Argument("urcap_port", 50002, "Port at which the External Control URCap asks for the control program.", limits=(1, 65535)),
    Argument("register_range", "lower", "RTDE registers of the driver: lower (0 to 23), or upper (24 to 47) if a fieldbus "
             "uses the lower ones.", ("lower", "upper")),
    Argument("watchdog_frequency", 10.0, "Hz, the robot stops the arm after 1/watchdog_frequency s without a sign of life; "
             "0: never.", limits=(0.0, 50.0)),
    Argument("restart_program", True, "Start the control program again after it was stopped."),
    Argument("on_busy", "refuse", "What happens to a motion goal while another one runs.", ("refuse", "preempt")),
    Argument("on_client_lost", "stop", "What happens to a motion whose client has died.", ("stop", "continue")),
    Argument("stream_timeout", 0.1, "s, a stream of targets ends after this time without a message.", limits=(0.02, 1.0)),
    Argument("stream_max_joint_jump", 0.2, "rad, largest distance of a streamed target from where the arm is sent.",
             limits=(0.001, 1.0)),
    Argument("stream_max_linear_jump", 0.1, "m, largest distance of a streamed pose from where the TCP is sent.",
             limits=(0.001, 1.0)),
    Argument("stream_acceleration", 1.0, "m/s^2, of the TCP until a twist is reached.", limits=(0.01, 150.0)),
    Argument("stream_deceleration", 2.0, "rad/s^2 and m/s^2, of the stop at the end of a stream.", limits=(0.1, 40.0)),
    Argument("stream_lookahead_time", 0.1, "s, smoothing of streamed targets in the controller.", limits=(0.03, 0.2)),
    Argument("stream_gain", 300.0, "Proportional gain for streamed targets in the controller.", limits=(100.0, 2000.0)),
    Argument("plugins", (), "Names of the plugins to load; default: all that are installed."),
    Argument("plugins_blacklist", (), "Names of plugins that are not loaded."),
)

# What else driver.launch.py takes.
OPTIONS = (
    Argument("sim", False, "Start the simulated robot of ur_simulator and connect to it."),
    Argument("sim_ip", "127.0.0.1", "Loopback address of the simulated robot: 127.0.0.1, 127.0.0.2, ..."),
    Argument("namespace", "", "Namespace of the nodes: one for each robot."),
    Argument("one_process", True, "All nodes in one process, with one RTDE connection for the state."),
    Argument("params_file", "", "YAML file with parameters of the nodes; arguments given to the launch file have priority."),
)

DRIVER = (*PARAMETERS, *OPTIONS)


def _of_robot(side: str, number: int) -> Tuple[Argument, ...]:
    return (Argument(f"{side}_robot_ip", "", f"Address or host name of the {side} robot's controller."),
            Argument(f"{side}_ur_type", "", f"Model of the {side} arm; empty: detected from the controller.", ("", *MODELS)),
            Argument(f"{side}_namespace", side, f"Namespace of the {side} robot's nodes."),
            Argument(f"{side}_tf_prefix", f"{side}_", f"Put before the names of the {side} robot's joints and frames."),
            Argument(f"{side}_urcap_port", 50001 + number, f"Port for the {side} robot's External Control URCap.",
                     limits=(1, 65535)),
            Argument(f"{side}_sim_ip", f"127.0.0.{number}", f"Loopback address of the {side} simulated robot."))


# Arguments of two_robots.launch.py; the other arguments of driver.launch.py are passed on to both drivers.
SIDES = ("left", "right")
TWO_ROBOTS = (*_of_robot("left", 1), *_of_robot("right", 2))
OF_EACH_ROBOT = tuple(argument.name[len("left_"):] for argument in _of_robot("left", 1))
DIFFERENT = ("namespace", "tf_prefix", "urcap_port", "sim_ip")  # of two robots

# Arguments of moveit.launch.py; the other arguments of driver.launch.py are passed on to the driver.
MOVEIT = (
    Argument("ur_type", None, "Model of the arm.", MODELS),
    Argument("kinematics_params_file", "", "YAML file with the arm's calibration, for ur_description; empty: the model's."),
    Argument("launch_rviz", True, "Start RViz with the display of MoveIt."),
)
NOT_WITH_MOVEIT = ("namespace", "tf_prefix")  # ur_moveit_config has neither


def check_name(name: str, known: Collection[str], launch_file: str) -> None:
    """Raises ArgumentError, with the nearest known name, for a name that is not known."""
    if name in known:
        return
    nearest = difflib.get_close_matches(name, known, 1, 0.0)
    hint = f"did you mean {nearest[0]}? " if nearest else ""
    raise ArgumentError(f"{launch_file} has no launch argument {name}; {hint}"
                        f"`ros2 launch ur_ros_rtde {launch_file} --show-args` lists all")


def to_values(arguments: Iterable[Argument], texts: Dict[str, str]) -> Dict[str, Any]:
    """The values of those arguments that `texts` has."""
    return {argument.name: argument.value(texts[argument.name]) for argument in arguments if argument.name in texts}


def write_parameters(parameters: Dict[str, Any]) -> str:
    """A parameter file for the nodes, to be given to them as the last one.

    Parameters of launch_ros go under "/**" if several nodes run in one process, and then parameters of another file for a certain
    node have priority. The nodes take the last of the names that match theirs, in the order in which the names appear first. The
    name used here matches in every namespace and appears nowhere else, so it is always the last one.
    """
    with tempfile.NamedTemporaryFile("w", prefix="ur_ros_rtde_", suffix=".yaml", delete=False) as file:
        # A copy for each: the parser of rcl does not take references, which YAML has for what occurs several times.
        yaml.safe_dump({f"/**/**/{node}": {"ros__parameters": copy.deepcopy(parameters)} for node in NODES}, file)
    return file.name
