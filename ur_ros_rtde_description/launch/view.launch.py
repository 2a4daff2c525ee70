"""Shows an arm in RViz: robot_state_publisher with the URDF and the joint states of the driver, and RViz."""

import pathlib
from typing import Dict

from ament_index_python.packages import PackageNotFoundError, get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction
from launch.substitutions import Command, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare
from ur_ros_rtde_description.errors import DescriptionError
from ur_ros_rtde_description.launch_arguments import ARGUMENTS, check_names, description_options, is_true, xacro_arguments
from ur_ros_rtde_description.urdf import Options, make_urdf


def generate_launch_description():
    declared = [DeclareLaunchArgument(argument.name, default_value=argument.default, description=argument.description)
                for argument in ARGUMENTS]

    def check(context):
        if is_started_by_ros2_launch(context, description):
            check_names(argument.split(":=")[0] for argument in context.argv or ())

    description = LaunchDescription([OpaqueFunction(function=check), *declared, OpaqueFunction(function=start)])
    return description


def is_started_by_ros2_launch(context, description):
    """Returns whether no other launch file includes this one: then all arguments of the command line are for it."""
    root = getattr(context.get_locals_as_dict().get("event"), "launch_description", None)
    return root is not None and any(entity.launch_description_source.try_get_launch_description_without_context() is description
                                    for entity in root.entities if isinstance(entity, IncludeLaunchDescription))


def start(context):
    values = {argument.name: context.launch_configurations[argument.name] for argument in ARGUMENTS}
    options = description_options(values)
    urdf = ur_description(values, options) if is_true("meshes", values) else make_urdf(options)
    common = {"namespace": values["namespace"], "output": "screen"}
    nodes = [Node(package="robot_state_publisher", executable="robot_state_publisher",
                  parameters=[{"robot_description": ParameterValue(urdf, value_type=str)}], **common)]
    if is_true("launch_rviz", values):
        config = str(pathlib.Path(get_package_share_directory("ur_ros_rtde_description"), "config", "view.rviz"))
        fixed_frame = options.parent or options.tf_prefix + "base_link"
        nodes.append(Node(package="rviz2", executable="rviz2", arguments=["-d", config, "-f", fixed_frame], **common))
    return nodes


def ur_description(values: Dict[str, str], options: Options) -> Command:
    """Returns the command that prints the URDF of ur_description, which has meshes and the same links and joints."""
    for package in ("ur_description", "xacro"):
        try:
            get_package_share_directory(package)
        except PackageNotFoundError:
            raise DescriptionError(f"launch argument meshes is \"true\", but the package {package} is not installed: install it "
                                   "with `sudo apt install ros-$ROS_DISTRO-ur-description`, or omit meshes:=true") from None
    if options.parent != "world" or options.mount != Options(options.model).mount or options.tool is not None:
        raise DescriptionError("launch argument meshes is \"true\": the URDF of ur_description has no mounting pose and no tool; omit "
                               "parent, xyz, rpy and tool, or meshes:=true")
    xacro = PathJoinSubstitution([FindPackageShare("ur_description"), "urdf", "ur.urdf.xacro"])
    return Command(["xacro ", xacro, " ", xacro_arguments(values, options)])
