"""Start, shutdown and loss of the controller, and addresses without a controller."""

import contextlib
import os
import pathlib
import re
import socket
import subprocess
import threading
import time

import pytest
from action_msgs.msg import GoalStatus
from programs import Process, Simulator, find_program, start_node
from robot_fixtures import make_ready, send_after_stop
from ros_client import Client
from support import FEW_PLUGINS, HOME, wait_for

from ur_ros_rtde_msgs.action import DashboardCommand, MoveJ, Stop
from ur_ros_rtde_msgs.msg import ErrorCode

NODES = ["robot_state_receiver", "command_server", "dashboard_server", "driver"]
FAR_TARGET = [2.5, *HOME[1:]]
ROOT = pathlib.Path(__file__).resolve().parents[3]


@pytest.mark.parametrize("name", NODES)
def test_a_missing_address_is_reported_with_an_example(name):
    process = start_node(name, "''")
    assert process.wait(15.0) == 2
    assert "robot_ip" in process.output() and "--ros-args -p robot_ip:=" in process.output()


@pytest.mark.parametrize("name, parameter, what", [
    ("robot_state_receiver", "rtde_frequency:=501.0", "rtde_frequency"),
    ("robot_state_receiver", "rtde_frequency:=0.5", "rtde_frequency"),
    ("robot_state_receiver", "qos:=fast", "reliable"),
    ("robot_state_receiver", "tf_prefix:='left arm'", "tf_prefix"),
    ("command_server", "on_busy:=wait", "preempt"),
    ("command_server", "ur_type:=ur99", "ur99"),
    ("command_server", "register_range:=middle", "upper"),
    ("command_server", "urcap_port:=70000", "urcap_port"),
    ("command_server", "watchdog_frequency:=true", "watchdog_frequency"),
    ("command_server", "watchdog_frequency:=60.0", "50"),
    ("command_server", "watchdog_frequency:=0.5", "from 1 to 50 Hz, or 0 for no watchdog"),
    ("command_server", "realtime_priority:=100", "99"),
    ("robot_state_receiver", "realtime_priority:=-1", "realtime_priority"),
])
def test_an_invalid_parameter_is_reported_with_its_limits(name, parameter, what):
    process = start_node(name, "127.0.0.1", parameter)
    assert process.wait(15.0) == 2
    assert what in process.output()


@pytest.mark.parametrize("name, address, parameter, message", [
    ("driver", "127.0.0.1", "on_busi:=preempt", "there is no parameter on_busi; did you mean on_busy?"),
    ("driver", "127.0.0.1", "watchdog_frequncy:=50.0", "there is no parameter watchdog_frequncy; did you mean watchdog_frequency?"),
    ("robot_state_receiver", "127.0.0.1", "rtde_frequenzy:=125.0", "did you mean rtde_frequency?"),
    ("driver", "''", "robotip:=127.0.0.1", "parameter robot_ip is not set, but robotip is, which does not exist"),
])
def test_a_misspelled_parameter_prevents_the_start(name, address, parameter, message):
    process = start_node(name, address, parameter)
    assert process.wait(15.0) == 2
    assert message in process.output()


def test_a_misspelled_parameter_is_named_beside_a_robot_that_sends_its_state(addresses, processes):
    simulator = processes(Simulator(addresses[1]))
    for _ in range(5):  # the connection is being made, or has been
        process = start_node("driver", simulator.address, "watchdog_frequncy:=50.0")
        assert process.wait(15.0) == 2
        assert "did you mean watchdog_frequency?" in process.output()


def test_a_driver_whose_log_nobody_reads_any_more_goes_on(addresses, processes):
    simulator = processes(Simulator(addresses[1]))
    driver = subprocess.Popen([find_program("ur_ros_rtde", "driver"), "--ros-args", "-p", f"robot_ip:={simulator.address}",
                               "-p", FEW_PLUGINS, "-r", "__ns:=/unread"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    client = Client("unread")
    try:
        make_ready(client)
        driver.stdout.close()
        client.send(MoveJ, "move_j", joint_positions=[0.1, *HOME[1:]]).succeeded()
        driver.terminate()
        assert driver.wait(15.0) == 0
    finally:
        driver.kill()
        driver.wait()
        client.close()


@pytest.mark.parametrize("name", NODES)
def test_help_shows_how_to_set_parameters(name):
    process = Process([find_program("ur_ros_rtde", name), "--help"])
    assert process.wait(15.0) == 0
    assert f"usage: {name} --ros-args -p robot_ip:=ADDRESS" in process.output() and "driver.yaml" in process.output()


def test_nodes_and_simulator_tell_their_version():
    version = re.search(r"<version>(.*)</version>", (ROOT / "ur_ros_rtde" / "package.xml").read_text())[1]
    for package, name, text in (("ur_ros_rtde", "driver", f"ur_ros_rtde {version}"),
                                ("ur_simulator", "ur_simulator", f"ur_simulator {version}")):
        process = Process([find_program(package, name), "--version"])
        assert process.wait(15.0) == 0
        assert process.output().strip() == text


def test_an_argument_that_does_not_exist_is_reported():
    process = Process([find_program("ur_ros_rtde", "driver"), "robot_ip:=127.0.0.1"])
    assert process.wait(15.0) == 2
    assert 'there is no argument "robot_ip:=127.0.0.1": parameters follow --ros-args -p. driver --help shows how' in process.output()


def test_a_parameter_that_no_node_has_is_a_warning(simulator, processes):
    process = processes(start_node("driver", simulator.address, FEW_PLUGINS, "colour:=blue"))
    process.wait_for_output("parameter colour is set, but no node of this process has it")
    process.wait_for_output("the robot is ready")


def threads_with_priority(pid, priority):
    found = []
    for thread in map(int, os.listdir(f"/proc/{pid}/task")):
        with contextlib.suppress(ProcessLookupError):  # other threads may end in the meantime
            if (os.sched_getparam(thread).sched_priority == priority
                    and os.sched_getscheduler(thread) & ~os.SCHED_RESET_ON_FORK == os.SCHED_FIFO):
                found.append(thread)
    return found


@pytest.mark.parametrize("name", ["robot_state_receiver", "command_server"])
def test_applies_the_realtime_priority_to_the_receive_threads_or_reports_missing_permission(name, simulator, processes):
    process = processes(start_node(name, simulator.address, "realtime_priority:=20"))
    process.wait_for_output("connected to")
    if "realtime_priority 20 is not permitted" in process.output():
        assert not threads_with_priority(process.pid, 20)
    else:
        # The receive thread of the node and the thread of ur_rtde that it starts; the thread that stops the arm.
        count = 3 if name == "command_server" else 2
        wait_for(lambda: len(threads_with_priority(process.pid, 20)) == count, 15.0, f"{count} threads of that priority")


@pytest.mark.parametrize("name", NODES)
def test_ctrl_c_stops_the_node_without_a_robot(name, addresses):
    process = start_node(name, addresses[3])
    process.wait_for_output(addresses[3])
    process.interrupt()
    assert process.wait(8.0) == 0, process.output()


@pytest.mark.parametrize("delay", [0.0, 0.05, 0.1, 0.2, 0.4])
def test_ctrl_c_stops_the_node_during_startup(delay, simulator):
    process = start_node("driver", simulator.address)
    time.sleep(delay)  # varies the phase of the startup
    process.interrupt()
    assert process.wait(15.0) in (0, -2), process.output()


@pytest.mark.parametrize("name", ["driver", "command_server"])
def test_a_missing_controller_is_reported_and_goals_are_rejected(name, addresses, processes):
    server = processes(start_node(name, addresses[3], FEW_PLUGINS, namespace="nobody"))
    client = Client("nobody")
    try:
        goal = client.send(MoveJ, "move_j", joint_positions=HOME)
        assert not goal.accepted
        assert client.rejection(goal).error_code in (ErrorCode.NOT_READY, ErrorCode.LINK_LOST)
        assert server.wait_for_output(addresses[3])
        wait_for(lambda: addresses[3] in client.rejection(client.send(MoveJ, "move_j", joint_positions=HOME)).message, 10.0,
                 "a rejection that names the address")
    finally:
        client.close()


class HttpServer:
    """Listens on the ports of a controller and responds like an HTTP server."""

    def __init__(self, address, ports=(29999, 30001, 30002, 30003, 30004)):
        self._sockets = []
        for port in ports:
            listener = socket.create_server((address, port))
            self._sockets.append(listener)
            threading.Thread(target=self._serve, args=(listener,), daemon=True).start()

    @staticmethod
    def _serve(listener):
        while True:
            try:
                connection, _ = listener.accept()
                connection.sendall(b"HTTP/1.1 400 Bad Request\r\nContent-Length: 0\r\n\r\n")
            except OSError:
                return

    def close(self):
        for listener in self._sockets:
            listener.shutdown(socket.SHUT_RDWR)
            listener.close()


def test_another_server_at_the_address_does_not_crash_the_driver(addresses, processes):
    other = HttpServer(addresses[2])
    try:
        server = processes(start_node("driver", addresses[2], FEW_PLUGINS, namespace="other"))
        client = Client("other")
        try:
            server.wait_for_output(addresses[2])
            goal = client.send(MoveJ, "move_j", joint_positions=HOME)
            assert not goal.accepted and client.rejection(goal).message
            assert server.running(), server.output()
            server.interrupt()
            assert server.wait(15.0) == 0
        finally:
            client.close()
    finally:
        other.close()


def test_ctrl_c_during_a_motion_decelerates_and_sends_the_result(simulator, client, processes):
    driver = processes(start_node("driver", simulator.address, FEW_PLUGINS, "ur_type:=ur10e"))
    make_ready(client)
    goal = client.send(MoveJ, "move_j", joint_positions=FAR_TARGET, speed=0.3, acceleration=2.0)
    wait_for(lambda: abs(simulator.state()["actual"]["velocity"][0]) > 0.2, 10.0, "the arm to move")
    driver.interrupt()
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == ErrorCode.SHUTDOWN, result.message
    assert driver.wait(8.0) == 0, driver.output()
    state = simulator.state()
    assert max(map(abs, state["actual"]["velocity"])) < 0.01
    assert state["actual"]["position"][0] < 2.0
    assert state["safety_mode"] == "NORMAL"


def test_the_controller_stops_the_arm_when_the_driver_is_killed(simulator, processes):
    driver = processes(start_node("driver", simulator.address, FEW_PLUGINS, "ur_type:=ur10e", namespace="killed"))
    client = Client("killed")
    try:
        make_ready(client)
        client.send(MoveJ, "move_j", joint_positions=FAR_TARGET, speed=0.3, acceleration=2.0)
        wait_for(lambda: abs(simulator.state()["actual"]["velocity"][0]) > 0.2, 10.0, "the arm to move")
        driver.kill()
        wait_for(lambda: max(map(abs, simulator.state()["actual"]["velocity"])) < 0.01, 10.0, "standstill")
        assert simulator.state()["actual"]["position"][0] < 2.3
    finally:
        client.close()


def test_loss_of_the_controller_aborts_the_motion_and_the_driver_reconnects(addresses, processes):
    simulator = processes(Simulator(addresses[1]))
    driver = processes(start_node("driver", addresses[1], FEW_PLUGINS, namespace="restarted"))
    client = Client("restarted")
    try:
        make_ready(client)
        goal = client.send(MoveJ, "move_j", joint_positions=FAR_TARGET, speed=0.5)
        wait_for(lambda: goal.feedback and goal.feedback[-1].motion.progress > 0.05, 10.0, "the motion")
        simulator.kill()
        status, result = goal.wait_for_result(10.0)
        assert status == GoalStatus.STATUS_ABORTED and result.error_code == ErrorCode.LINK_LOST, result.message
        rejected = client.send(MoveJ, "move_j", joint_positions=HOME)
        assert not rejected.accepted and client.rejection(rejected).message
        simulator.start()
        make_ready(client)
        assert driver.running()
    finally:
        client.close()


def test_the_driver_serves_dashboard_and_commands_in_one_process(simulator, client, processes):
    processes(start_node("driver", simulator.address))
    make_ready(client)
    wait_for(lambda: client.send(DashboardCommand, "dashboard/close_popup").accepted, 10.0, "the dashboard server")


def test_a_stop_sends_feedback_until_the_arm_is_at_rest(simulator, client, processes):
    processes(start_node("driver", simulator.address, FEW_PLUGINS))
    make_ready(client)
    goal = client.send(MoveJ, "move_j", joint_positions=FAR_TARGET, speed=2.0, acceleration=10.0)
    wait_for(lambda: simulator.state()["actual"]["velocity"][0] > 1.9, 10.0, "the speed from which the arm stops in 1 s")
    stop = client.send(Stop, "stop")
    result = stop.succeeded()
    assert len(stop.feedback) >= int(10.0 * result.time_to_standstill)  # 20 Hz
    assert goal.wait_for_result()[1].error_code == ErrorCode.PREEMPTED
    send_after_stop(client, MoveJ, "move_j", joint_positions=HOME, speed=2.0).succeeded()  # not rejected as busy


def test_a_silent_controller_aborts_the_motion_within_silence_limit(addresses, processes):
    simulator = processes(Simulator(addresses[1]))
    processes(start_node("driver", addresses[1], FEW_PLUGINS, "silence_limit:=0.3", namespace="silent"))
    client = Client("silent")
    try:
        make_ready(client)
        goal = client.send(MoveJ, "move_j", joint_positions=FAR_TARGET, speed=0.5)
        wait_for(lambda: goal.feedback and goal.feedback[-1].motion.progress > 0.05, 10.0, "the motion")
        simulator.process.pause()
        try:
            status, result = goal.wait_for_result(10.0)
            assert status == GoalStatus.STATUS_ABORTED and result.error_code == ErrorCode.LINK_LOST, result.message
        finally:
            simulator.process.resume()
        make_ready(client)
    finally:
        client.close()
