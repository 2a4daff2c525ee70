"""Checks a robot over the network and prints what to do about each problem. Nothing moves.

    ur doctor --robot 192.168.56.101
    ur doctor --robot 192.168.56.101 --ur-type ur5e --kinematics-params-file my_robot.yaml

Without --robot, `./ur doctor` in a checkout checks whether this machine can build and run everything.

Exit code: 0 no fault, 1 at least one fault.
"""

import argparse
import math

from .robot_check.finding import State


def _seconds(text: str) -> float:
    value = float(text)
    if not 0.1 <= value <= 3600.0 or not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"is {text}, it must be 0.1 to 3600 s")
    return value


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--robot", required=True, metavar="ADDRESS", help="address of the controller")
    parser.add_argument("--ur-type", default="", metavar="MODEL", help="model that the arm must be, for example ur5e (default: any)")
    parser.add_argument("--serial-number", default="", metavar="NUMBER", help="serial number that the robot must have (default: any)")
    parser.add_argument("--kinematics-params-file", default="", metavar="FILE",
                        help="calibration that the description uses (default: nominal kinematics)")
    parser.add_argument("--duration", type=_seconds, default=2.0, metavar="S",
                        help="duration of the measurement of the packages (default: %(default)s s)")
    parser.add_argument("--limit", type=_seconds, default=2.0, metavar="S", help="time limit of each answer (default: %(default)s s)")


def run(options: argparse.Namespace) -> int:
    from .robot_check.checks import Options, RobotCheck
    checks = RobotCheck(Options(options.robot, options.ur_type, options.serial_number, options.kinematics_params_file, options.limit,
                                options.duration))
    findings = []
    for finding in checks.findings():
        print(finding.line(), flush=True)
        findings.append(finding)
    states = [finding.state for finding in findings]
    faults, warnings = states.count(State.FAULT), states.count(State.WARNING)
    in_use = any(finding.subject == "clients" for finding in findings)
    conclusion = "." if faults else "; the robot is in use." if in_use else "; the driver can be started."
    print(f"{faults} fault{'s' * (faults != 1)}, {warnings} warning{'s' * (warnings != 1)}{conclusion}")
    return 1 if faults else 0
