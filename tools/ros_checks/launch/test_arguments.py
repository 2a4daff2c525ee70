"""Arguments of the launch files: all are declared, invalid ones are rejected with one message, valid ones reach the nodes."""

import subprocess

import pytest
from ros2 import ROOT, parameter, ready, ros2
from ur_ros_rtde_launch.launch_arguments import DRIVER, MOVEIT, PER_ROBOT, TWO_ROBOTS

DRIVER_FILE = ("launch", "ur_ros_rtde", "driver.launch.py")
INCLUDING_LAUNCH_FILE = '''
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

def generate_launch_description():
    driver = PathJoinSubstitution([FindPackageShare("ur_ros_rtde"), "launch", "driver.launch.py"])
    return LaunchDescription([
        DeclareLaunchArgument("cell", default_value="one"),
        DeclareLaunchArgument("robot_description", default_value="mine"),
        IncludeLaunchDescription(PythonLaunchDescriptionSource(driver), launch_arguments=ARGUMENTS.items()),
    ])
'''


def errors(printed):
    return [line for line in printed.splitlines() if "ERROR" in line]


@pytest.mark.parametrize("launch_file, arguments", [("driver", DRIVER), ("two_robots", (*TWO_ROBOTS, *DRIVER)),
                                                    ("moveit", (*MOVEIT, *DRIVER))])
def test_show_args_lists_all_with_description_and_default(launch_file, arguments):
    code, printed = ros2("launch", "ur_ros_rtde", f"{launch_file}.launch.py", "--show-args")
    assert code == 0, printed
    for argument in arguments:
        assert f"'{argument.name}':" in printed
    for argument in (argument for argument in arguments if argument.name != "ur_type"):
        assert argument.help in printed and f"(default: '{argument.default_text}')" in printed


@pytest.mark.parametrize("given, message", [
    ("tf_prefx:=left_", "driver.launch.py has no launch argument tf_prefx; did you mean tf_prefix?"),
    ("realtime_prio:=40", "did you mean realtime_priority?"),
    ("ur_type:=ur11", 'launch argument ur_type is "ur11", it must be one of: '),
    ("on_busy:=maybe", 'launch argument on_busy is "maybe", it must be one of: reject, preempt'),
    ("rtde_frequency:=1000", 'launch argument rtde_frequency is "1000", it must be a number from 1 to 500'),
    ("plugins:=move_j", 'launch argument plugins is "move_j", it must be a list of names'),
    ("params_file:=/nowhere.yaml", 'params_file is "/nowhere.yaml": the file does not exist'),
    ("on_busy:=reject", "the address of the robot is missing: set robot_ip:=<address>, or sim:=true"),
    ("sim_ip:=banana", 'launch argument sim_ip is "banana", it must be a loopback address'),
    ("tf_prefix:=bad-prefix/", 'launch argument tf_prefix is "bad-prefix/", it must be letters, digits, _ and /'),
])
def test_an_invalid_argument_is_rejected_with_one_message_before_any_process_starts(given, message):
    code, printed = ros2(*DRIVER_FILE, given)
    assert code != 0
    assert len(errors(printed)) == 1 and message in errors(printed)[0], printed
    assert "process started" not in printed


@pytest.mark.parametrize("given, message", [
    ("robot_ip:=192.168.0.10", "two_robots.launch.py has no launch argument robot_ip; did you mean "),
    ("right_urcap_port:=50002", 'left_urcap_port and right_urcap_port are both "50002", they must differ'),
    ("left_robot_ip:=192.168.0.10 right_robot_ip:=192.168.0.10", "are both \"192.168.0.10\", they must differ"),
    ("left_robot_ip:=192.168.0.10", "the address of the right robot is missing: set right_robot_ip:=<address>"),
    ("on_bussy:=preempt", "did you mean on_busy?"),
])
def test_an_invalid_argument_of_two_robots_is_rejected_with_one_message(given, message):
    code, printed = ros2("launch", "ur_ros_rtde", "two_robots.launch.py", *given.split())
    assert code != 0
    assert len(errors(printed)) == 1 and message in errors(printed)[0], printed


def test_moveit_rejects_a_calibration_that_does_not_exist():
    code, printed = ros2("launch", "ur_ros_rtde", "moveit.launch.py", "ur_type:=ur5e", "sim:=true", "kinematics_params_file:=none.yaml")
    assert code != 0
    assert len(errors(printed)) == 1 and 'kinematics_params_file is "none.yaml": the file does not exist' in errors(printed)[0], printed
    assert "process started" not in printed


def test_moveit_reports_missing_packages():
    code, printed = ros2("launch", "ur_ros_rtde", "moveit.launch.py", "ur_type:=ur5e", "sim:=true")
    if "needs packages that are not installed" not in printed:
        pytest.skip("MoveIt is installed")
    assert code != 0
    assert len(errors(printed)) == 1 and "ur_moveit_config" in printed and "sudo apt install ros-$ROS_DISTRO-ur" in printed
    assert "process started" not in printed


def test_moveit_rejects_arguments_that_its_configuration_does_not_support():
    code, printed = ros2("launch", "ur_ros_rtde", "moveit.launch.py", "ur_type:=ur5e", "tf_prefix:=left_")
    assert code != 0 and "moveit.launch.py has no launch argument tf_prefix" in printed


def test_arguments_of_an_including_launch_file_are_accepted(launch, tmp_path):
    file = tmp_path / "cell.launch.py"
    file.write_text(INCLUDING_LAUNCH_FILE.replace("ARGUMENTS", "{'sim': 'true', 'sim_ip': '127.0.0.41', 'on_busy': 'preempt'}"))
    started = launch(file, "cell:=two", "rviz:=true", "tf_prefix:=cell_")
    ready(started)
    assert parameter("/command_server", "on_busy") == "preempt"
    assert parameter("/robot_state_receiver", "tf_prefix") == "cell_"


def test_an_invalid_argument_passed_by_an_including_launch_file_is_rejected(tmp_path):
    file = tmp_path / "cell.launch.py"
    file.write_text(INCLUDING_LAUNCH_FILE.replace("ARGUMENTS", "{'sim': 'true', 'on_bussy': 'preempt'}"))
    code, printed = ros2("launch", file, "cell:=two")
    assert code != 0 and "driver.launch.py has no launch argument on_bussy; did you mean on_busy?" in printed


@pytest.mark.parametrize("one_process", ["true", "false"])
def test_arguments_reach_the_nodes_and_have_priority_over_a_file(launch, tmp_path, one_process):
    file = tmp_path / "mine.yaml"
    file.write_text("/**/command_server:\n  ros__parameters: {on_busy: reject, stream_gain: 500.0}\n"
                    "/**/robot_state_receiver:\n  ros__parameters: {rtde_frequency: 250.0, tf_prefix: mine_}\n")
    started = launch(*DRIVER_FILE[1:], "sim:=true", "sim_ip:=127.0.0.42", f"one_process:={one_process}", f"params_file:={file}",
                     "tf_prefix:=left_", "on_busy:=preempt", "rtde_frequency:=100.0", "namespace:=left", "realtime_priority:=0")
    ready(started, "/left")
    assert parameter("/left/command_server", "on_busy") == "preempt"
    assert parameter("/left/robot_state_receiver", "rtde_frequency") == "100.0"
    assert parameter("/left/robot_state_receiver", "tf_prefix") == "left_"
    assert parameter("/left/command_server", "stream_gain") == "500.0"  # only in the file
    assert parameter("/left/command_server", "watchdog_frequency") == "10.0"  # in neither
    code, printed = ros2("topic", "echo", "--once", "--field", "name", "/left/joint_states")
    assert code == 0 and "left_shoulder_pan_joint" in printed


def test_two_robots_have_separate_names_and_ports_and_share_the_other_arguments(launch):
    started = launch("ur_ros_rtde", "two_robots.launch.py", "sim:=true", "left_sim_ip:=127.0.0.43", "right_sim_ip:=127.0.0.44",
                     "on_busy:=preempt", "right_ur_type:=ur5e")
    for side, port, address in (("left", "50002", "127.0.0.43"), ("right", "50003", "127.0.0.44")):
        ready(started, f"/{side}")
        assert parameter(f"/{side}/command_server", "urcap_port") == port
        assert parameter(f"/{side}/command_server", "robot_ip") == address
        assert parameter(f"/{side}/command_server", "on_busy") == "preempt"
        assert parameter(f"/{side}/robot_state_receiver", "tf_prefix") == f"{side}_"
        code, printed = ros2("action", "send_goal", f"/{side}/move_j", "ur_ros_rtde_msgs/action/MoveJ",
                             "{joint_positions: [0.1, -1.57, 1.57, -1.57, -1.57, 0.0]}")
        assert code == 0 and "success: true" in printed, printed
    assert parameter("/right/command_server", "ur_type") == "ur5e"
    assert set(PER_ROBOT) >= {"namespace", "tf_prefix", "urcap_port"}


def test_a_driver_that_fails_to_start_ends_the_launch_with_its_message(launch):
    started = launch(*DRIVER_FILE[1:], "sim:=true", "sim_ip:=127.0.0.45", "robot_state_fields:=[no_such_field]")
    started.wait(60.0)
    assert sum("no_such_field" in line for line in started.lines) == 1, started.output()


def test_an_occupied_urcap_port_is_reported_with_a_remedy(launch):
    first = launch(*DRIVER_FILE[1:], "sim:=true", "sim_ip:=127.0.0.46", "control_mode:=control_urcap", "urcap_port:=50046")
    first.wait_for("dashboard commands:")
    second = launch(*DRIVER_FILE[1:], "sim:=true", "sim_ip:=127.0.0.47", "control_mode:=control_urcap", "urcap_port:=50046",
                    "namespace:=second")
    second.wait_for("50046")
    printed = [line for line in second.lines if "50046" in line]
    assert len(printed) == 1 and "choose another urcap_port" in printed[0], second.output()


def test_ctrl_c_stops_driver_and_simulator(launch):
    started = launch(*DRIVER_FILE[1:], "sim:=true", "sim_ip:=127.0.0.48")
    ready(started)
    started.stop()
    assert not started.running()
    assert "process has died" not in started.output()


def test_a_dead_simulator_ends_the_launch(launch):
    started = launch(*DRIVER_FILE[1:], "sim:=true", "sim_ip:=127.0.0.48")
    ready(started)
    subprocess.run(["pkill", "-9", "-f", "ur_simulator --address 127.0.0.48"], check=True)
    started.wait(20.0)  # raises an exception if the driver goes on
    assert "ur_simulator-1]: process has died" in started.output()


def test_an_unknown_plugin_ends_the_launch_with_its_name(launch):
    started = launch(*DRIVER_FILE[1:], "sim:=true", "sim_ip:=127.0.0.49", "plugins:=[nosuch]")
    started.wait(20.0)
    assert 'parameter plugins names "nosuch", but no installed plugin has that name' in started.output()


def test_a_copy_of_the_parameter_file_is_accepted(launch, tmp_path):
    text = (ROOT / "ur_ros_rtde" / "config" / "driver.yaml").read_text()
    file = tmp_path / "copy.yaml"
    file.write_text(text.replace('robot_ip: ""', 'robot_ip: "127.0.0.49"').replace("stream_gain: 300.0", "stream_gain: 400.0"))
    started = launch(*DRIVER_FILE[1:], f"params_file:={file}")
    started.wait_for("dashboard commands:")
    assert parameter("/command_server", "stream_gain") == "400.0"
    assert parameter("/command_server", "robot_ip") == "127.0.0.49"
