"""Arguments of view.launch.py. Does not depend on launch."""

import os
import shlex
from dataclasses import dataclass
from typing import Dict, Iterable, Tuple

from .errors import DescriptionError, nearest
from .options import read_options
from .urdf import Options


@dataclass(frozen=True)
class Argument:
    name: str
    description: str
    default: "str | None" = ""  # None: required


ARGUMENTS = (
    Argument("ur_type", "Model of the arm: ur3e, ur5e, ur10e, ur20, ...", None),
    Argument("namespace", "Namespace of the nodes, as that of the driver."),
    Argument("tf_prefix", "Prefix of the names of joints and frames, as that of the driver."),
    Argument("kinematics_params_file", "YAML file with the calibration of the arm. If empty, the nominal kinematics are used."),
    Argument("parent", "Link on which the arm is mounted.", "world"),
    Argument("xyz", "Position of base_link in the parent in m: \"0 0.4 0.8\".", "0 0 0"),
    Argument("rpy", "Roll, pitch and yaw of base_link in the parent in rad.", "0 0 0"),
    Argument("tool", "URDF file of a tool, whose root link is attached to tool0."),
    Argument("meshes", "Uses the URDF of the installed package ur_description, which has meshes: true or false.", "false"),
    Argument("launch_rviz", "Starts RViz: true or false.", "true"),
)
LAUNCH_OWN = ("launch-prefix", "launch-prefix-filter")  # arguments that `ros2 launch` adds itself


def check_names(names: Iterable[str]) -> None:
    """Raises DescriptionError for a name that is no launch argument."""
    known = [argument.name for argument in ARGUMENTS]
    for name in names:
        if name not in (*known, *LAUNCH_OWN):
            raise DescriptionError(f"view.launch.py has no launch argument {name}; {nearest(name, known)}The arguments are: "
                                   f"{', '.join(known)}")


def is_true(name: str, values: Dict[str, str]) -> bool:
    if values[name] not in ("true", "false"):
        raise DescriptionError(f"launch argument {name} is \"{values[name]}\", it must be one of: true, false")
    return values[name] == "true"


def description_options(values: Dict[str, str]) -> Options:
    """Returns the options of the description from the values of the launch arguments."""
    return read_options(values["ur_type"], values["tf_prefix"], values["kinematics_params_file"], values["parent"],
                        _numbers("xyz", values), _numbers("rpy", values), values["tool"])


def xacro_arguments(values: Dict[str, str], options: Options) -> str:
    """Returns the arguments of ur.urdf.xacro of ur_description, which would look for a relative path in its own folder."""
    file, name = values["kinematics_params_file"], options.model.name
    kinematics = f" kinematics_params:={shlex.quote(os.path.abspath(file))}" if file else ""
    return f"name:={name} ur_type:={name} tf_prefix:=\"{options.tf_prefix}\"{kinematics}"


def _numbers(name: str, values: Dict[str, str]) -> Tuple[float, ...]:
    try:
        numbers = tuple(map(float, values[name].split()))
    except ValueError:
        numbers = ()
    if len(numbers) != 3:
        raise DescriptionError(f"launch argument {name} is \"{values[name]}\", it must be three numbers: {name}:=\"0 0 0\"")
    return numbers
