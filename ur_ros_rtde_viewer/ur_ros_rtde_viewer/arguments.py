"""Arguments of the viewer. Depends on the standard library alone, so that --help needs nothing else."""

import argparse
import math
import re
from dataclasses import dataclass
from typing import Any, Optional, Sequence, Tuple

DEFAULT_PORT = 8080
DEFAULT_RATE = 30.0  # Hz
DESCRIPTION = """\
Shows robots in the browser: the arm and its target, plots, the state of the driver, recordings.

    ur view
    ur view --robot left,model=ur5e,y=0.4 --robot right,model=ur5e,y=-0.4
"""
_POSE_FIELDS = ("x", "y", "z", "roll", "pitch", "yaw")
_TEXT_FIELDS = ("model", "kinematics_params_file", "tool")
_NUMBER_FIELDS = (*_POSE_FIELDS, "tool_length")


@dataclass(frozen=True)
class RobotOptions:
    """One robot of the scene."""

    namespace: str = ""  # of the driver's nodes, without slashes at its ends
    model: str = ""  # empty: the model that the driver reports
    xyz: Tuple[float, float, float] = (0.0, 0.0, 0.0)  # m, position of base_link in the scene
    rpy: Tuple[float, float, float] = (0.0, 0.0, 0.0)  # rad, orientation of base_link
    kinematics_params_file: str = ""  # calibration
    tool: str = ""  # URDF of a tool
    tool_length: Optional[float] = None  # m, of a cylinder as a tool

    @property
    def name(self) -> str:
        """Name for messages and titles."""
        return self.namespace or "robot"


def parse_robot(text: str) -> RobotOptions:
    """Reads NAMESPACE[,model=MODEL][,x=M]…[,yaw=RAD][,tool=FILE]…"""
    namespace, *fields = text.split(",")
    values = {}
    for field in fields:
        key, separator, value = field.partition("=")
        if not separator or key not in (*_TEXT_FIELDS, *_NUMBER_FIELDS):
            raise argparse.ArgumentTypeError(f"\"{field}\" in \"{text}\": expected {', '.join(name + '=TEXT' for name in _TEXT_FIELDS)}"
                                             f" or {', '.join(name + '=NUMBER' for name in _NUMBER_FIELDS)}")
        values[key] = value
    x, y, z, roll, pitch, yaw = (_number(text, key, values.get(key, "0")) for key in _POSE_FIELDS)
    length = _number(text, "tool_length", values["tool_length"]) if "tool_length" in values else None
    return RobotOptions(_namespace(namespace), values.get("model", ""), (x, y, z), (roll, pitch, yaw),
                        values.get("kinematics_params_file", ""), values.get("tool", ""), length)


def _number(text: str, key: str, value: str) -> float:
    try:
        number = float(value)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise argparse.ArgumentTypeError(f"{key} is \"{value}\" in \"{text}\": expected a finite number")
    return number


def _namespace(text: str) -> str:
    from ur_ros_rtde_cli.namespaces import valid  # imported here because --help does not need it
    return valid(text)


def _port(text: str) -> int:
    if not text.isdigit() or not 0 <= int(text) <= 65535:
        raise argparse.ArgumentTypeError(f"\"{text}\": expected a port from 1 to 65535, or 0 for a free one")
    return int(text)


def _token(text: str) -> str:
    if text != "none" and not re.fullmatch(r"[A-Za-z0-9_-]{8,}", text):
        raise argparse.ArgumentTypeError(f"expected 8 or more letters, digits, _ and -, or none, not {text!r}")
    return text


def _rate(text: str) -> float:
    try:
        rate = float(text)
    except ValueError:
        rate = math.nan
    if not 1.0 <= rate <= 60.0:
        raise argparse.ArgumentTypeError(f"\"{text}\": expected 1 to 60 updates per second")
    return rate


class _ShowVersion(argparse.Action):
    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        from ur_ros_rtde_cli.version import version_line  # imported here because nothing else needs it
        print(version_line())
        parser.exit()


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--robot", action="append", type=parse_robot, default=[], metavar="NS[,model=M][,x=…]",
                        help="robot with this namespace; model, position (x, y, z in m) and orientation (roll, pitch, yaw in rad) of "
                             "its base_link, kinematics_params_file, tool and tool_length are optional; can be given several times")
    parser.add_argument("--version", action=_ShowVersion, nargs=0, help="show the version of the driver")
    parser.add_argument("--namespace", default="", type=_namespace, metavar="NS", help="namespace of the only robot (default: none)")
    parser.add_argument("--model", default="", metavar="MODEL", help="model of the only robot (default: reported by the driver)")
    parser.add_argument("--kinematics-params-file", default="", metavar="FILE", help="calibration of the only robot, of `ur calibration`")
    parser.add_argument("--tool", default="", metavar="FILE", help="tool of the only robot, a URDF, of which cylinders, boxes and spheres "
                                                                   "are shown")
    parser.add_argument("--tool-length", type=float, metavar="M", help="length of a cylinder as the tool of the only robot")
    parser.add_argument("--address", default="127.0.0.1", metavar="IP",
                        help="address on which the page is served (default: 127.0.0.1, this machine only)")
    parser.add_argument("--token", type=_token, metavar="TEXT", help="what the URL of a page on the network must contain (default: a new "
                        "one at each start; none: nothing)")
    parser.add_argument("--port", type=_port, default=DEFAULT_PORT, metavar="PORT", help="port of the page; 0: a free one (default: 8080)")
    parser.add_argument("--rate", type=_rate, default=DEFAULT_RATE, metavar="HZ", help="updates per second, 1 to 60 (default: 30)")
    parser.add_argument("--simulator", default="", metavar="IP",
                        help="address of a simulator, whose surfaces are shown (default: the address that the driver reports)")
    parser.add_argument("--recordings", default=".", metavar="FOLDER",
                        help="folder for recordings, on the machine of the driver (default: the current folder)")
    parser.add_argument("--control", action="store_true", help="allow commands from the page")
    parser.add_argument("--dark", action="store_true", help="light text on a dark page")
    parser.add_argument("--plan", default="", metavar="FILE", help="show a plan of `./ur plan FILE --json` instead of a robot")


def robots(options: argparse.Namespace) -> Sequence[RobotOptions]:
    """Returns the robots of the scene. Raises ValueError if a namespace appears twice or options contradict each other."""
    if not options.robot:
        return (RobotOptions(options.namespace, options.model, kinematics_params_file=options.kinematics_params_file,
                             tool=options.tool, tool_length=options.tool_length),)
    for name in ("namespace", "model", "kinematics_params_file", "tool", "tool_length"):
        if getattr(options, name):
            option = "--" + name.replace("_", "-")
            field = "NAMESPACE" if name == "namespace" else f"NAMESPACE,{name}={getattr(options, name)}"
            raise ValueError(f"--robot replaces {option}: write --robot {field}")
    namespaces = [robot.namespace for robot in options.robot]
    for namespace in namespaces:
        if namespaces.count(namespace) > 1:
            raise ValueError(f"--robot {namespace} is given {namespaces.count(namespace)} times: each robot needs a namespace of its own")
    return tuple(options.robot)
