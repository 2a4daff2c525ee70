"""Launch arguments match the parameters of the nodes and override a parameter file. Does not require the launch package."""

import os
import pathlib
import shlex

import pytest
import rclpy
import yaml
from programs import Process, find_program
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters
from rclpy.parameter import parameter_value_to_python
from support import wait_for
from ur_ros_rtde_launch import launch_arguments
from ur_ros_rtde_launch.launch_arguments import (
    DRIVER,
    NODES,
    PARAMETERS,
    TWO_ROBOTS,
    ArgumentError,
    check_differ,
    check_file,
    check_name,
    to_values,
    xacro_arguments,
)

CONFIG = pathlib.Path(__file__).resolve().parents[3] / "ur_ros_rtde" / "config" / "driver.yaml"
ROS_PARAMETERS = {"use_sim_time"}


@pytest.fixture(scope="module")
def parameter_node():
    rclpy.init()
    node = rclpy.create_node("parameter_node")
    yield node
    node.destroy_node()
    rclpy.shutdown()


@pytest.fixture
def start(parameter_node, addresses, tmp_path):
    """Returns a function that starts a program without a robot and returns the parameters of its nodes."""
    processes = []

    def run(*arguments, executable="driver", namespace=""):
        processes.append(Process([find_program("ur_ros_rtde", executable), "--ros-args", "-r", f"__ns:=/{namespace}",
                                  "-p", f"robot_ip:={addresses[3]}", *map(str, arguments)]))
        nodes = NODES if executable == "driver" else (executable,)
        return {node: get_parameters(parameter_node, f"/{namespace}/{node}".replace("//", "/")) for node in nodes}

    yield run
    for process in processes:
        process.stop()
        print(process.output())
    # The next process has the same names: a request to a server that is still discovered would be lost.
    wait_for(lambda: not set(NODES) & set(parameter_node.get_node_names()), 20.0, "the nodes to disappear")


def wait_until_it_answers(parameter_node, node):
    """The middleware may lose requests in the first quarter of a second of a node: what these tests check begins afterwards."""
    client = parameter_node.create_client(ListParameters, f"{node}/list_parameters")
    wait_for(client.service_is_ready, 20.0, f"{node}/list_parameters")

    def answers():
        future = client.call_async(ListParameters.Request())
        rclpy.spin_until_future_complete(parameter_node, future, timeout_sec=1.0)
        return future.done()

    wait_for(answers, 20.0, f"the first answer of {node}")
    parameter_node.destroy_client(client)


def call_parameter_service(parameter_node, node, kind, **request):
    name = {ListParameters: "list_parameters", DescribeParameters: "describe_parameters", GetParameters: "get_parameters"}[kind]
    client = parameter_node.create_client(kind, f"{node}/{name}")
    wait_for(client.service_is_ready, 20.0, f"{node}/{name}")
    future = client.call_async(kind.Request(**request))
    rclpy.spin_until_future_complete(parameter_node, future, timeout_sec=10.0)
    parameter_node.destroy_client(client)
    assert future.done(), f"no response from {node}/{name}"
    return future.result()


def get_parameters(parameter_node, node):
    """Returns {name: (value, descriptor)} without the parameters of plugins, whose names contain a dot."""
    wait_until_it_answers(parameter_node, node)
    listed = call_parameter_service(parameter_node, node, ListParameters).result.names
    names = [name for name in listed if "." not in name and name not in ROS_PARAMETERS]
    values = call_parameter_service(parameter_node, node, GetParameters, names=names).values
    descriptors = call_parameter_service(parameter_node, node, DescribeParameters, names=names).descriptors
    return {name: (parameter_value_to_python(value), descriptor)
            for name, value, descriptor in zip(names, values, descriptors)}


def limits(descriptor):
    ranges = [*descriptor.floating_point_range, *descriptor.integer_range]
    return (ranges[0].from_value, ranges[0].to_value) if ranges else None


def choices(descriptor):
    prefix, begins, names = descriptor.additional_constraints.partition("one of: ")
    if not begins:
        return None
    return (*(("",) if prefix == "empty, or " else ()), *names.split(", "))


def test_every_parameter_is_a_launch_argument_with_its_type_default_limits_and_choices(start):
    found = start()
    names = set().union(*found.values())
    assert names == {argument.name for argument in PARAMETERS}
    for argument in PARAMETERS:
        for node, parameters in found.items():
            if argument.name not in parameters:
                continue
            value, descriptor = parameters[argument.name]
            assert limits(descriptor) == argument.limits, (node, argument.name)
            if choices(descriptor):
                assert choices(descriptor) == argument.choices, (node, argument.name)
            if argument.name != "robot_ip":  # has no default
                expected = list(argument.default) if isinstance(argument.default, tuple) else argument.default
                assert value == expected and type(value) is type(expected), (node, argument.name)


ARGUMENTS = {"tf_prefix": "left_", "on_busy": "preempt", "rtde_frequency": 100.0, "urcap_port": 50007, "restart_program": False,
             "plugins": ["move_j"]}


# All node names that a parameter file may use, in the orders that affect priority.
@pytest.mark.parametrize("names", [["/**"], ["/**/command_server", "/**"], ["/left/command_server", "/**"],
                                   ["/**/command_server", "/left/command_server"], ["/left/*", "/*/command_server"]])
@pytest.mark.parametrize("executable", ["driver", "command_server"])
def test_launch_arguments_have_priority_over_a_file(start, tmp_path, names, executable):
    file = tmp_path / "mine.yaml"
    file.write_text("".join(f"{name}:\n  ros__parameters: {{on_busy: reject, urcap_port: 50009, stream_gain: 500.0}}\n"
                            for name in names))
    written = launch_arguments.write_parameters(ARGUMENTS)
    try:
        found = start("--params-file", file, "--params-file", written, executable=executable, namespace="left")
    finally:
        os.unlink(written)
    for node, parameters in found.items():
        for name, value in ARGUMENTS.items():
            if name in parameters:
                actual = parameters[name][0]
                assert (list(actual) if isinstance(value, list) else actual) == value, (node, name)
    assert found["command_server"]["stream_gain"][0] == 500.0  # not given as an argument, therefore from the file


def test_the_parameter_file_contains_all_parameters_with_their_defaults():
    parameters = yaml.safe_load(CONFIG.read_text())["/**"]["ros__parameters"]
    assert parameters == {argument.name: argument.default for argument in PARAMETERS if argument.default != ()}
    for argument in PARAMETERS:
        if argument.default == ():
            assert f"# {argument.name}: [" in CONFIG.read_text()


def test_every_default_and_every_choice_is_a_valid_value():
    for argument in (*DRIVER, *TWO_ROBOTS):
        for text in (argument.default_text, *argument.text_choices):
            if text != "[]":
                argument.value(text)


def test_two_robots_must_differ():
    values = {argument.name: argument.default for argument in TWO_ROBOTS}
    check_differ(values)
    for name, value in (("urcap_port", 50003), ("sim_ip", "127.0.0.5"), ("robot_ip", "192.168.0.10"), ("tf_prefix", "arm_")):
        with pytest.raises(ArgumentError, match=f"left_{name} and right_{name} are both"):
            check_differ({**values, f"left_{name}": value, f"right_{name}": value})
    with pytest.raises(ArgumentError, match="left_namespace and right_namespace"):
        check_differ({**values, "left_namespace": "arm", "right_namespace": "/arm"})


@pytest.mark.parametrize("name, text, message", [
    ("ur_type", "ur11", 'ur_type is "ur11", it must be one of: '),
    ("on_busy", "maybe", 'on_busy is "maybe", it must be one of: reject, preempt'),
    ("rtde_frequency", "fast", 'rtde_frequency is "fast", it must be a number from 1 to 500'),
    ("rtde_frequency", "nan", 'rtde_frequency is "nan", it must be a number from 1 to 500'),
    ("urcap_port", "70000", 'urcap_port is "70000", it must be an integer from 1 to 65535'),
    ("urcap_port", "50002.5", 'urcap_port is "50002.5", it must be an integer'),
    ("watchdog_frequency", "0.5", 'watchdog_frequency is "0.5", it must be a number from 1 to 50, or 0'),
    ("restart_program", "yes", 'restart_program is "yes", it must be one of: true, false'),
    ("plugins", "move_j", 'plugins is "move_j", it must be a list of names'),
    ("plugins", "[", 'plugins is "[", it must be a list of names'),
    ("tf_prefix", "bad prefix/", 'tf_prefix is "bad prefix/", it must be letters, digits, _ and /'),
    ("namespace", "2nd", 'namespace is "2nd", it must be names of letters'),
    ("namespace", "left_robot_cell_number_of_the_second_hall-2", 'it must be names of letters'),
    ("sim_ip", "banana", 'sim_ip is "banana", it must be a loopback address'),
    ("sim_ip", "10.0.0.1", 'sim_ip is "10.0.0.1", it must be a loopback address'),
    ("sim_ip", "127.0.0.256", 'sim_ip is "127.0.0.256", it must be a loopback address'),
])
def test_an_invalid_value_is_rejected_with_the_valid_values(name, text, message):
    with pytest.raises(ArgumentError) as error:
        to_values(DRIVER, {name: text})
    assert message in str(error.value)


def test_xacro_reads_the_calibration_of_a_relative_path(tmp_path, monkeypatch):
    """xacro looks for a relative path in the folder of ur.urdf.xacro."""
    monkeypatch.chdir(tmp_path)
    assert shlex.split(xacro_arguments("ur5e", "my robot.yaml")) == [
        "name:=ur5e", "ur_type:=ur5e", f"kinematics_params:={tmp_path}/my robot.yaml"]
    assert xacro_arguments("ur5e", "") == "name:=ur5e ur_type:=ur5e"


def test_a_file_that_does_not_exist_is_rejected(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    pathlib.Path("mine.yaml").touch()
    for path in ("", "mine.yaml", str(tmp_path / "mine.yaml")):
        check_file("kinematics_params_file", path)
    for path in ("none.yaml", str(tmp_path)):
        with pytest.raises(ArgumentError, match=f'kinematics_params_file is "{path}": the file does not exist'):
            check_file("kinematics_params_file", path)


def test_values_have_the_type_of_the_parameter():
    assert to_values(DRIVER, {"rtde_frequency": "100", "urcap_port": "50007", "restart_program": "false", "tf_prefix": "1",
                              "plugins": "[move_j, stop]"}) == {
        "rtde_frequency": 100.0, "urcap_port": 50007, "restart_program": False, "tf_prefix": "1", "plugins": ["move_j", "stop"]}


@pytest.mark.parametrize("name, hint", [("model", "; did you mean ur_type?"), ("ip", "; did you mean robot_ip?"), ("speed", "; `ros2")])
def test_names_of_other_programs_are_known_and_nothing_far_away_is_suggested(name, hint):
    with pytest.raises(ArgumentError) as raised:
        check_name(name, [argument.name for argument in DRIVER], "driver.launch.py")
    assert f"has no launch argument {name}{hint}" in str(raised.value)


def test_an_unknown_argument_is_rejected_with_a_suggestion():
    with pytest.raises(ArgumentError, match="has no launch argument realtime_prio; did you mean realtime_priority?"):
        check_name("realtime_prio", [argument.name for argument in DRIVER], "driver.launch.py")
