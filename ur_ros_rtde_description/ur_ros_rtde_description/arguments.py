"""Arguments of the program urdf. Depends on the standard library alone, so that --help needs nothing else."""

import argparse
import pathlib

DEFAULT_TOOL_RADIUS = 0.03  # m


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--model", required=True, help="ur3e, ur5e, ur10e, ur20, ...")
    parser.add_argument("--tf-prefix", default="", metavar="PREFIX",
                        help="prefix of all names, for example left_, as the parameter tf_prefix of the driver")
    parser.add_argument("--kinematics-params-file", default="", metavar="FILE",
                        help="calibration of the arm, in the format of ur_description (default: nominal kinematics)")
    parser.add_argument("--parent", default="world", metavar="LINK",
                        help="link on which the arm is mounted; '' makes base_link the root (default: %(default)s)")
    parser.add_argument("--xyz", nargs=3, type=float, default=(0.0, 0.0, 0.0), metavar=("X", "Y", "Z"),
                        help="position of base_link in the parent in m")
    parser.add_argument("--rpy", nargs=3, type=float, default=(0.0, 0.0, 0.0), metavar=("R", "P", "Y"),
                        help="roll, pitch and yaw of base_link in the parent in rad")
    parser.add_argument("--tool", default="", metavar="FILE", help="URDF of a tool, whose root link is attached to tool0")
    parser.add_argument("--tool-length", type=float, metavar="M",
                        help="length in m of a cylinder as a tool, with the frame tool_tip at its end")
    parser.add_argument("--tool-radius", type=float, metavar="M", help=f"radius of this cylinder in m (default: {DEFAULT_TOOL_RADIUS})")
    parser.add_argument("--tool-mass", type=float, metavar="KG", help="mass of this cylinder in kg (default: 0)")
    parser.add_argument("--xacro", action="store_true",
                        help="print a xacro macro instead, with the parameters tf_prefix and parent and a block origin")
    parser.add_argument("--output", type=pathlib.Path, metavar="FILE", help="write to this file instead of the standard output")
