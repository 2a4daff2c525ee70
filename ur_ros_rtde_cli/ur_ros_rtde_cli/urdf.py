"""Prints the URDF of an arm, or a xacro macro.

    ur urdf --model ur10e > ur10e.urdf
    ur urdf --model ur5e --tf-prefix left_ --parent table --xyz 0 0.4 0.8 --output left.urdf

Links and joints have the names and frames of ur_description. The geometry consists of cylinders and spheres.
"""

import argparse

from ur_ros_rtde_description.arguments import add_arguments  # noqa: F401  (used by main)


def run(options: argparse.Namespace) -> int:
    from ur_ros_rtde_description import program  # imported here because --help does not need its dependencies
    return program.run(options)
