"""Starts the drivers of two robots. Each has its own namespace, prefix of joints and frames, and port for the URCap."""

from launch.actions import GroupAction, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare
from ur_ros_rtde_launch.launch_arguments import PER_ROBOT, SIDES, TWO_ROBOTS, ArgumentError, check_differ
from ur_ros_rtde_launch.launch_support import make_launch_description


def generate_launch_description():
    return make_launch_description("two_robots.launch.py", TWO_ROBOTS, check, [robot(side) for side in SIDES], PER_ROBOT)


def check(context, given):
    values = {**{argument.name: argument.default for argument in TWO_ROBOTS}, **given}
    check_differ(values)
    others = context.launch_configurations
    if others.get("sim") != "true" and not others.get("params_file"):
        for side in SIDES:
            if not values[f"{side}_robot_ip"]:
                raise ArgumentError(f"the address of the {side} robot is missing: set {side}_robot_ip:=<address>, or sim:=true "
                                    "for simulated robots")
    return []


def robot(side):
    driver = PathJoinSubstitution([FindPackageShare("ur_ros_rtde"), "launch", "driver.launch.py"])
    arguments = {name: LaunchConfiguration(f"{side}_{name}") for name in PER_ROBOT}
    return GroupAction([IncludeLaunchDescription(PythonLaunchDescriptionSource(driver), launch_arguments=arguments.items())])
