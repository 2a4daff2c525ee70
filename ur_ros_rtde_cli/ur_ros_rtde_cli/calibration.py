"""Reads the calibration of an arm from its controller: a kinematics file in the format of ur_description.

    ur calibration --robot 192.168.56.101 --output my_robot.yaml
    ur calibration --robot 192.168.56.101 --compare my_robot.yaml
    ur urdf --model ur5e --kinematics-params-file my_robot.yaml

Nothing moves, and the robot may be powered off.

Exit code: 0 success, 1 no answer or a deviation from the compared file, 2 wrong arguments.
"""

import argparse
import pathlib
import sys

TIMEOUT = 5.0  # s, for each answer of the controller


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--robot", required=True, metavar="ADDRESS", help="address of the controller")
    parser.add_argument("--ur-type", default="", metavar="MODEL", help="model of the arm (default: as the controller reports it)")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--output", type=pathlib.Path, metavar="FILE", help="write to this file instead of the standard output")
    what.add_argument("--compare", type=pathlib.Path, metavar="FILE",
                      help="print how far the flange is from where this calibration says, at the joint positions where it is farthest")


def run(options: argparse.Namespace) -> int:
    from ur_ros_rtde_description.errors import DescriptionError  # imported here because --help does not need its dependencies

    from .robot_check.connection import ConnectionFailure
    try:
        return _run(options)
    except ConnectionFailure as failure:
        print(f"{options.robot}: {failure}; `ur doctor --robot {options.robot}` finds the cause", file=sys.stderr)
        return 1
    except DescriptionError as error:
        print(error, file=sys.stderr)
        return 2


def _run(options: argparse.Namespace) -> int:
    from ur_ros_rtde_description import controller_calibration, program
    from ur_ros_rtde_description.models import find_model

    from .robot_check import identity
    from .robot_check.connection import ConnectionFailure
    from .robot_check.primary import read_arm_data
    from .robot_check.rtde import Rtde
    if options.ur_type:
        find_model(options.ur_type)  # an unknown model is rejected before the robot is asked
    data = read_arm_data(options.robot, TIMEOUT)
    if data.kinematics is None:
        raise ConnectionFailure("port 30001: the controller does not report its kinematics")
    with Rtde(options.robot, TIMEOUT) as rtde:
        version = rtde.version()
    name = options.ur_type or identity.model_of_type(data.type_number, version[0] == 3)
    if not name:
        raise ConnectionFailure(f"port 30001: the robot type {data.type_number} is unknown, give --ur-type")
    if options.compare:
        deviation = controller_calibration.deviation(data.kinematics, name, options.compare)
        print(f"{options.compare}: the flange deviates by up to {1e3 * deviation.distance:.3f} mm and {deviation.angle:.6f} rad"
              + ("" if deviation.is_negligible() else "; `ur calibration --output` saves the calibration of this arm"))
        return 0 if deviation.is_negligible() else 1
    model = find_model(name)
    polyscope = ".".join(map(str, version[:3]))
    comment = f"Calibration of the {model.display_name} at {options.robot}, PolyScope {polyscope}, by `ur calibration`"
    text = controller_calibration.calibration_yaml(data.kinematics, model, comment)
    if options.output is None:
        sys.stdout.write(text)
    else:
        program.write(options.output, text)
    return 0
