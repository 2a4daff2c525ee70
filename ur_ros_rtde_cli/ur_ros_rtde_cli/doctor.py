"""Checks a robot over the network and prints what to do about each problem. Nothing moves.

    ur doctor --robot 192.168.56.101
    ur doctor --robot 192.168.56.101 --ur-type ur5e --kinematics-params-file my_robot.yaml

    ur doctor --report report.md

With --report, it collects what a bug report needs: versions, parameters, state, diagnostics, the check of the robot, the last lines of the
logs. Names, addresses and serial numbers are replaced. The report is shown before it is written.

Without arguments, `./ur doctor` in a checkout checks whether this machine can build and run everything.

Exit code: 0 no fault, 1 at least one fault, or a report that was not written.
"""

import argparse
import math
import pathlib

from . import namespaces
from .errors import CliError
from .robot_check.finding import State


def _seconds(text: str) -> float:
    value = float(text)
    if not 0.1 <= value <= 3600.0 or not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"is {text}, it must be 0.1 to 3600 s")
    return value


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--robot", default="", metavar="ADDRESS", help="address of the controller (--report: default of the driver)")
    parser.add_argument("--report", type=pathlib.Path, metavar="FILE", help="write a report; needs the driver's ROS 2 environment")
    parser.add_argument("--yes", action="store_true", help="write the report without a question")
    parser.add_argument("--namespace", default="", type=namespaces.valid, metavar="NS",
                        help="namespace of the nodes of the robot, for --report (default: none)")
    parser.add_argument("--ur-type", default="", metavar="MODEL", help="model that the arm must be, for example ur5e (default: any)")
    parser.add_argument("--serial-number", default="", metavar="NUMBER", help="serial number that the robot must have (default: any)")
    parser.add_argument("--kinematics-params-file", default="", metavar="FILE",
                        help="calibration that the description uses (default: nominal kinematics)")
    parser.add_argument("--duration", type=_seconds, default=2.0, metavar="S",
                        help="duration of the measurement of the packages (default: %(default)s s)")
    parser.add_argument("--limit", type=_seconds, default=2.0, metavar="S", help="time limit of each answer (default: %(default)s s)")


def run(options: argparse.Namespace) -> int:
    if options.report is not None:
        from . import report  # imported here because a check of the robot needs no ROS
        return report.run(options.report, options.namespace, options.robot, options.yes)
    if not options.robot:
        raise CliError("give --robot ADDRESS to check a robot, or --report FILE to write a report")
    return check_robot(options)


def check_robot(options: argparse.Namespace) -> int:
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
