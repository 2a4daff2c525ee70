"""Starts the driver and MoveIt for one robot, on top of the launch file of ur_moveit_config.

ur_moveit_config sends trajectories to a controller of ros2_control. The action of the controller is remapped to the action
follow_joint_trajectory of the driver, so the files of ur_moveit_config are used unchanged for every model.
"""

import pathlib

from ament_index_python.packages import PackageNotFoundError, get_package_share_directory
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import Command, PathJoinSubstitution
from launch_ros.actions import Node, SetRemap
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare
from ur_ros_rtde_launch.launch_arguments import MOVEIT, UNSUPPORTED_BY_MOVEIT, ArgumentError, check_file, xacro_arguments
from ur_ros_rtde_launch.launch_support import make_launch_description

# Packages that the launch files of ur_moveit_config need besides RViz. xacro generates the robot_description.
PACKAGES = ("moveit_ros_move_group", "moveit_simple_controller_manager", "robot_state_publisher", "ur_description",
            "ur_moveit_config", "ur_robot_driver", "xacro")
CONTROLLERS = ("joint_trajectory_controller", "scaled_joint_trajectory_controller")  # the second in Humble
ACTION_INTERFACES = ("cancel_goal", "feedback", "get_result", "send_goal", "status")


def generate_launch_description():
    driver = included("ur_ros_rtde", "driver.launch.py")
    return make_launch_description("moveit.launch.py", MOVEIT, start, [driver], UNSUPPORTED_BY_MOVEIT)


def start(_context, given):
    calibration = given.get("kinematics_params_file", "")
    check_file("kinematics_params_file", calibration)
    missing = [package for package in PACKAGES if not installed(package)]
    if missing:
        raise ArgumentError(f"moveit.launch.py needs packages that are not installed: {', '.join(missing)}. "
                            "Install them with `sudo apt install ros-$ROS_DISTRO-ur` and source the workspace again")
    check_model(given["ur_type"])
    check_calibration(calibration)
    arguments = {"ur_type": given["ur_type"], "launch_rviz": str(given.get("launch_rviz", True)).lower(),
                 "launch_servo": "false"}  # on by default in Humble
    return [robot_state_publisher(given["ur_type"], calibration), *remappings(),
            included("ur_moveit_config", "ur_moveit.launch.py", arguments)]


def check_model(model):
    config = pathlib.Path(get_package_share_directory("ur_description"), "config")
    if not (config / model).is_dir():
        models = ", ".join(sorted(path.name for path in config.iterdir() if path.is_dir()))
        raise ArgumentError(f"the installed ur_description does not contain the model {model}. It contains {models}. Install "
                            "a newer version")


def check_calibration(file):
    """Up to Humble, ur_moveit_config makes a robot description of its own for move_group, which would be without the calibration."""
    config = pathlib.Path(get_package_share_directory("ur_moveit_config"), "config")
    if file and (config / "controllers.yaml").is_file():
        raise ArgumentError("kinematics_params_file cannot be used with the installed ur_moveit_config, which gives MoveIt the default "
                            "kinematics: leave it out, or use a launch file of your own that passes the calibrated robot_description")


def installed(package):
    try:
        get_package_share_directory(package)
    except PackageNotFoundError:
        return False
    return True


def robot_state_publisher(model, kinematics_params_file):
    xacro = PathJoinSubstitution([FindPackageShare("ur_description"), "urdf", "ur.urdf.xacro"])
    description = Command(["xacro ", xacro, " ", xacro_arguments(model, kinematics_params_file)])
    return Node(package="robot_state_publisher", executable="robot_state_publisher", output="screen",
                parameters=[{"robot_description": ParameterValue(description, value_type=str)}])


def remappings():
    """Yields remappings for all following nodes. A group would end before ur_moveit.launch.py starts move_group."""
    for controller in CONTROLLERS:
        for interface in ACTION_INTERFACES:
            name = f"follow_joint_trajectory/_action/{interface}"
            yield SetRemap(f"/{controller}/{name}", f"/{name}")


def included(package, launch_file, arguments=None):
    path = PathJoinSubstitution([FindPackageShare(package), "launch", launch_file])
    return IncludeLaunchDescription(PythonLaunchDescriptionSource(path), launch_arguments=(arguments or {}).items())
