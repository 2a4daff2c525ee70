"""Starts the driver: robot_state_receiver, command_server and dashboard_server, in one process or in three."""

import os

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, SetEnvironmentVariable
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, PythonExpression
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import ExecutableInPackage, FindPackageShare

MODELS = ["ur3", "ur5", "ur10", "ur3e", "ur5e", "ur7e", "ur10e", "ur12e", "ur16e", "ur8long", "ur15", "ur18", "ur20", "ur30"]
PROFILE = "FASTDDS_DEFAULT_PROFILES_FILE"


def arguments():
    return [
        DeclareLaunchArgument("ur_type", default_value="ur10e", choices=MODELS, description="Model of the arm."),
        DeclareLaunchArgument("robot_ip", default_value="192.168.56.101", description="Address of the robot's controller."),
        DeclareLaunchArgument("sim", default_value="false", choices=["true", "false"],
                              description="Start the simulator of this project as the robot; its address then is sim_ip."),
        DeclareLaunchArgument("sim_ip", default_value="127.0.0.1",
                              description="Loopback address of the simulator: one for each robot, 127.0.0.1, 127.0.0.2, ..."),
        DeclareLaunchArgument("namespace", default_value="", description="Name of the robot, before all topics and actions."),
        DeclareLaunchArgument("tf_prefix", default_value="", description="Before the names of joints and frames, e.g. left_."),
        DeclareLaunchArgument("on_busy", default_value="refuse", choices=["refuse", "preempt"],
                              description="What happens to a motion that comes while another one runs."),
        DeclareLaunchArgument("control_mode", default_value="upload", choices=["upload", "control_urcap"],
                              description="The control program is sent to the robot, or fetched by the External Control URCap."),
        DeclareLaunchArgument("rtde_frequency", default_value="500.0", description="Hz, of the published state: 1 to 500."),
        DeclareLaunchArgument("one_process", default_value="true", choices=["true", "false"],
                              description="All nodes in one process, with one RTDE connection for the state."),
        DeclareLaunchArgument("params_file", default_value=PathJoinSubstitution([FindPackageShare("ur_ros_rtde"), "config",
                                                                                "driver.yaml"]),
                              description="YAML file of further parameters; the arguments here win over it."),
    ]


def nodes():
    sim = LaunchConfiguration("sim")
    address = PythonExpression(["'", LaunchConfiguration("sim_ip"), "' if '", sim, "' == 'true' else '",
                                LaunchConfiguration("robot_ip"), "'"])
    parameters = [
        LaunchConfiguration("params_file"),
        {
            "robot_ip": ParameterValue(address, value_type=str),
            "ur_type": ParameterValue(LaunchConfiguration("ur_type"), value_type=str),
            "tf_prefix": ParameterValue(LaunchConfiguration("tf_prefix"), value_type=str),
            "on_busy": LaunchConfiguration("on_busy"),
            "control_mode": LaunchConfiguration("control_mode"),
            "rtde_frequency": ParameterValue(LaunchConfiguration("rtde_frequency"), value_type=float),
        },
    ]
    common = {"package": "ur_ros_rtde", "namespace": LaunchConfiguration("namespace"), "parameters": parameters,
              "output": "screen"}
    one_process = LaunchConfiguration("one_process")
    # No Node, which adds --ros-args: it knows nothing of ROS.
    simulator = ExecuteProcess(cmd=[ExecutableInPackage(package="ur_simulator", executable="ur_simulator"), "--address",
                                    LaunchConfiguration("sim_ip"), "--model", LaunchConfiguration("ur_type")],
                               output="screen", condition=IfCondition(sim))
    separate = [Node(executable=name, name=name, condition=UnlessCondition(one_process), **common)
                for name in ("robot_state_receiver", "command_server", "dashboard_server")]
    # Without a name: it would be given to all three nodes of the process.
    return [simulator, Node(executable="driver", condition=IfCondition(one_process), **common), *separate]


def profile():
    """For Fast DDS, as docs/interfaces.md says; its options are there from Kilted on. The user's own is left alone."""
    if PROFILE in os.environ or os.environ.get("ROS_DISTRO", "") < "kilted":
        return []
    return [SetEnvironmentVariable(PROFILE, PathJoinSubstitution([FindPackageShare("ur_ros_rtde"), "config", "fastdds.xml"]))]


def generate_launch_description():
    return LaunchDescription([*arguments(), *profile(), *nodes()])
