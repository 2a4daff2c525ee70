"""Starts the driver of one robot: robot_state_receiver, command_server and dashboard_server, in one or three processes."""

import pathlib

from launch.actions import EmitEvent, ExecuteProcess, OpaqueFunction, RegisterEventHandler
from launch.event_handlers import OnProcessExit, OnShutdown
from launch.events import Shutdown, matches_action
from launch.events.process import ShutdownProcess
from launch_ros.actions import Node
from launch_ros.substitutions import ExecutableInPackage
from ur_ros_rtde_launch.launch_arguments import (
    DEFAULT_SIMULATED_MODEL,
    DRIVER,
    NODES,
    PARAMETERS,
    ArgumentError,
    check_file,
    write_parameters,
)
from ur_ros_rtde_launch.launch_support import make_launch_description

DEFAULTS = {argument.name: argument.default for argument in DRIVER}


def generate_launch_description():
    return make_launch_description("driver.launch.py", DRIVER, start)


def start(_context, given):
    options = {**DEFAULTS, **given}
    parameters = {argument.name: given[argument.name] for argument in PARAMETERS if argument.name in given}
    if options["sim"]:
        parameters["robot_ip"] = options["sim_ip"]
    elif not options["robot_ip"] and not options["params_file"]:
        raise ArgumentError("the address of the robot is missing: set robot_ip:=<address>, or sim:=true for a simulated robot")
    check_file("params_file", options["params_file"])

    nodes = driver(options, parameters)
    return [*(simulator(options, nodes) if options["sim"] else []), *nodes]


def driver(options, parameters):
    temporary_files = [write_parameters(parameters)] if parameters else []
    given = [options["params_file"]] if options["params_file"] else []
    common = {"package": "ur_ros_rtde", "namespace": options["namespace"], "output": "screen",
              "parameters": [*given, *temporary_files]}
    if options["one_process"]:
        nodes = [Node(executable="driver", **common)]  # no name: it would rename all three nodes
    else:
        nodes = [Node(executable=name, name=name, **common) for name in NODES]

    def remove(_context):
        for file in temporary_files:
            pathlib.Path(file).unlink(missing_ok=True)

    return [*nodes, RegisterEventHandler(OnShutdown(on_shutdown=[OpaqueFunction(function=remove)]))]


def simulator(options, nodes):
    """Returns the process of the simulated robot. It ends together with the node that commands it. If it ends alone, the launch ends."""
    # ExecuteProcess instead of Node, because the simulator does not accept --ros-args.
    process = ExecuteProcess(cmd=[ExecutableInPackage(package="ur_simulator", executable="ur_simulator"), "--address",
                                  options["sim_ip"], "--model", options["ur_type"] or DEFAULT_SIMULATED_MODEL], output="screen")
    commander = nodes[0] if options["one_process"] else nodes[NODES.index("command_server")]
    end = EmitEvent(event=ShutdownProcess(process_matcher=matches_action(process)))
    failed = EmitEvent(event=Shutdown(reason="the simulated robot has ended"))
    driver_has_ended = []

    def on_driver_exit(_event, _context):
        driver_has_ended.append(True)
        return [end]

    def on_simulator_exit(_event, _context):
        return [] if driver_has_ended else [failed]

    return [process, RegisterEventHandler(OnProcessExit(target_action=commander, on_exit=on_driver_exit)),
            RegisterEventHandler(OnProcessExit(target_action=process, on_exit=on_simulator_exit))]
