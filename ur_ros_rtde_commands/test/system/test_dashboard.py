"""dashboard_server: commands take effect, queries return the answer, and failures are reported."""

import socketserver
import threading

import pytest
from action_msgs.msg import GoalStatus
from programs import Simulator, start_node
from ros_client import Client
from support import wait_for

from ur_ros_rtde_msgs.action import DashboardCommand, DashboardQuery, DashboardText
from ur_ros_rtde_msgs.msg import ErrorCode

RECOVERY_TIME_FACTOR = 1.0  # real durations


@pytest.fixture(scope="module")
def server(simulator):
    server = start_node("dashboard_server", simulator.address)
    yield server
    server.stop()
    print(server.output())


@pytest.fixture
def dashboard(server, simulator, client):
    """A client of a connected dashboard server. The robot is in remote control and running."""
    simulator.control("remote_control", on=True)
    simulator.control("power", to="running")
    wait_for(lambda: _is_connected(client), 20.0, "the dashboard server to be connected")
    return client


def _is_connected(client):
    goal = client.send(DashboardQuery, "dashboard/robot_mode")
    return goal.accepted and goal.succeeded()


def command(client, name, **fields):
    return client.send(DashboardCommand, f"dashboard/{name}", **fields)


def query(client, name):
    return client.send(DashboardQuery, f"dashboard/{name}").succeeded().answer


def send_text(client, name, words):
    return client.send(DashboardText, f"dashboard/{name}", text=words)


WAIT_PROGRAM = "def wait():\n  while True:\n    sync()\n  end\nend\n"


@pytest.fixture
def program(dashboard, simulator):
    """Loads wait.urp, which runs until it is stopped. Returns its name."""
    simulator.control("store_program", name="wait.urp", script=WAIT_PROGRAM, load=True)
    command(dashboard, "stop").succeeded()
    return "wait.urp"


def test_queries_return_the_answer_without_its_label(dashboard):
    assert query(dashboard, "robot_mode") == "RUNNING"
    assert query(dashboard, "safety_mode") == "NORMAL"
    assert query(dashboard, "get_serial_number").isdigit()
    assert "5.25" in query(dashboard, "polyscope_version")
    assert query(dashboard, "program_state").startswith("STOPPED")


def test_powers_the_arm_off_and_on_and_releases_the_brakes(dashboard):
    command(dashboard, "power_off").succeeded()
    assert query(dashboard, "robot_mode") == "POWER_OFF"
    goal = command(dashboard, "power_on")
    assert goal.succeeded().answer.startswith("Powering on")
    # ROS does not order feedback and result.
    wait_for(lambda: goal.feedback and goal.feedback[-1].state == "IDLE", 15.0, "the feedback of the new robot mode")
    assert query(dashboard, "robot_mode") == "IDLE"
    command(dashboard, "brake_release").succeeded()
    assert query(dashboard, "robot_mode") == "RUNNING"


def test_a_command_that_has_no_effect_within_the_timeout_fails(dashboard):
    command(dashboard, "power_off").succeeded()
    status, result = command(dashboard, "brake_release", timeout=0.1).wait_for_result()
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == ErrorCode.TIMEOUT
    assert "RUNNING" in result.message and "0.1 s" in result.message


def test_cancel_ends_the_wait_for_the_effect(dashboard):
    command(dashboard, "power_off").succeeded()
    goal = command(dashboard, "brake_release")
    wait_for(lambda: goal.feedback, 10.0, "feedback")
    goal.cancel()
    status, result = goal.wait_for_result(5.0)
    assert status == GoalStatus.STATUS_CANCELED and result.error_code == ErrorCode.CANCELED


def test_unlocks_a_protective_stop_once_the_controller_allows_it(dashboard, simulator):
    simulator.control("protective_stop", reason="a test")
    wait_for(lambda: query(dashboard, "safety_mode") == "PROTECTIVE_STOP", 15.0, "the protective stop")
    early = command(dashboard, "unlock_protective_stop").result()
    assert early.error_code == ErrorCode.REJECTED_BY_ROBOT and early.answer in early.message
    wait_for(lambda: command(dashboard, "unlock_protective_stop").result().success, 10.0, "the protective stop to be unlocked")
    assert query(dashboard, "safety_mode") == "NORMAL"


def test_plays_pauses_resumes_and_stops_a_program(dashboard, program):
    command(dashboard, "play").succeeded()
    assert query(dashboard, "program_state") == f"PLAYING {program}"
    assert query(dashboard, "running") == "true"
    command(dashboard, "pause").succeeded()
    assert query(dashboard, "program_state") == f"PAUSED {program}"
    assert query(dashboard, "running") == "false"
    command(dashboard, "play").succeeded()
    assert query(dashboard, "running") == "true"
    command(dashboard, "stop").succeeded()
    assert query(dashboard, "program_state") == f"STOPPED {program}"


class TcpServer(socketserver.ThreadingTCPServer):
    allow_reuse_address = True
    daemon_threads = True


class RestartingController(socketserver.StreamRequestHandler):
    """A dashboard server whose program has been started again, whenever it is asked after a stop."""

    ANSWERS = {"stop": "Stopped", "programState": "PLAYING wait.urp", "PolyscopeVersion": "URSoftware 5.25.0.0 (Jan 01 2026)",
               "is in remote control": "true"}

    def handle(self):
        self.wfile.write(b"Connected: Universal Robots Dashboard Server\n")
        for line in self.rfile:
            answer = self.ANSWERS.get(line.decode().strip(), "Robotmode: RUNNING")
            self.wfile.write(f"{answer}\n".encode())


def test_a_program_that_runs_again_at_once_was_stopped(addresses, processes):
    """A late host sees only the program after it."""
    with TcpServer((addresses[1], 29999), RestartingController) as controller:
        threading.Thread(target=controller.serve_forever, daemon=True).start()
        processes(start_node("dashboard_server", addresses[1], namespace="again"))
        client = Client("again")
        try:
            wait_for(lambda: _is_connected(client), 20.0, "the dashboard server to be connected")
            result = command(client, "stop").succeeded(limit=10.0)
            assert result.message == "Stopped; programState is PLAYING wait.urp now"
        finally:
            client.close()
            controller.shutdown()


def test_loads_a_program_by_name(dashboard, simulator, program):
    simulator.control("store_program", name="other.urp", script=WAIT_PROGRAM)
    assert send_text(dashboard, "load", "other.urp").succeeded().answer == "Loading program: other.urp"
    assert query(dashboard, "program_state") == "STOPPED other.urp"
    assert query(dashboard, "get_loaded_program") == "/programs/other.urp"
    assert query(dashboard, "is_program_saved").lower() == "true other.urp"


@pytest.mark.parametrize("name", ["load", "load_installation"])
def test_loading_a_file_that_does_not_exist_fails(dashboard, program, name):
    result = send_text(dashboard, name, "nowhere.urp").result()
    assert result.error_code == ErrorCode.REJECTED_BY_ROBOT and result.answer == "File not found: nowhere.urp"
    assert query(dashboard, "get_loaded_program") == f"/programs/{program}"


def test_loads_an_installation(dashboard):
    assert send_text(dashboard, "load_installation", "default.installation").succeeded().answer.startswith("Loading installation: ")


def test_restarts_the_safety_system_after_a_fault(dashboard, simulator):
    simulator.control("fault", reason="a test")
    wait_for(lambda: query(dashboard, "safety_mode") == "FAULT", 15.0, "the fault")
    assert query(dashboard, "safety_status") == "FAULT"
    command(dashboard, "close_safety_popup").succeeded()
    command(dashboard, "restart_safety").succeeded()
    assert query(dashboard, "robot_mode") == "POWER_OFF" and query(dashboard, "safety_mode") == "NORMAL"


def test_sets_and_clears_the_operational_mode(dashboard):
    send_text(dashboard, "set_operational_mode", "automatic").succeeded()
    assert query(dashboard, "get_operational_mode") == "AUTOMATIC"
    assert command(dashboard, "clear_operational_mode").succeeded().answer.startswith("No longer controlling")
    assert query(dashboard, "get_operational_mode") == "NONE"


def test_writes_a_line_to_the_log_of_the_controller(dashboard, simulator):
    send_text(dashboard, "add_to_log", "a line of the test").succeeded()
    assert any(entry["text"] == "a line of the test" for entry in simulator.control("log")["entries"])


def test_queries_model_version_and_remote_control(dashboard):
    assert query(dashboard, "get_robot_model") == "UR10"
    assert query(dashboard, "version").startswith("5.25")
    assert query(dashboard, "is_in_remote_control") == "true"


@pytest.mark.parametrize("name, words", [("set_operational_mode", "manual, automatic"),
                                         ("generate_flight_report", "controller, software, system")])
def test_an_argument_unknown_to_the_controller_is_rejected(dashboard, name, words):
    goal = send_text(dashboard, name, "nonsense")
    assert not goal.accepted
    rejection = dashboard.rejection(goal)
    assert rejection.error_code == ErrorCode.INVALID_GOAL and "nonsense" in rejection.message and words in rejection.message


def test_queries_are_answered_while_a_report_is_generated(dashboard):
    goal = send_text(dashboard, "generate_flight_report", "controller")
    assert query(dashboard, "robot_mode") == "RUNNING"
    assert not goal.is_finished()
    second = send_text(dashboard, "generate_flight_report", "system").result()
    assert second.error_code == ErrorCode.REJECTED_BY_ROBOT and "Another report" in second.message
    assert goal.succeeded().answer.startswith("Flight Report generated with id")


def test_cancel_ends_the_wait_for_a_report(dashboard):
    goal = send_text(dashboard, "generate_flight_report", "software")
    wait_for(goal.answered, 10.0, "the goal to be accepted")
    goal.cancel()
    status, result = goal.wait_for_result(5.0)
    assert status == GoalStatus.STATUS_CANCELED and result.error_code == ErrorCode.CANCELED
    # The controller continues to generate it and accepts another report only afterwards.
    wait_for(lambda: send_text(dashboard, "generate_support_file", "/programs").result().success, 30.0, "the support file")
    command(dashboard, "save_log").succeeded()


def test_raw_sends_any_line_unchanged(dashboard):
    assert send_text(dashboard, "raw", "robotmode").succeeded().answer == "Robotmode: RUNNING"
    assert send_text(dashboard, "raw", "make tea").succeeded().answer == "could not understand: 'make tea'"
    # Raw lines use a separate connection, so that only this one is closed.
    assert send_text(dashboard, "raw", "quit").succeeded().answer == "Disconnected"
    assert query(dashboard, "robot_mode") == "RUNNING"


@pytest.mark.parametrize("action, name, fields", [(DashboardQuery, "get_user_role", {}),
                                                  (DashboardText, "set_user_role", {"text": "operator"})])
def test_a_command_missing_in_this_polyscope_version_is_rejected_with_the_version(dashboard, action, name, fields):
    goal = dashboard.send(action, f"dashboard/{name}", **fields)
    assert not goal.accepted
    rejection = dashboard.rejection(goal)
    assert rejection.error_code == ErrorCode.NOT_SUPPORTED
    assert "PolyScope 5.25" in rejection.message and "a CB3 has it from PolyScope 3.1 on" in rejection.message


def test_a_cb3_has_user_roles_and_no_operational_modes(addresses, processes):
    processes(Simulator(addresses[2], model="ur10"))
    processes(start_node("dashboard_server", addresses[2], namespace="old"))
    client = Client("old")
    try:
        wait_for(lambda: _is_connected(client), 20.0, "the dashboard server to be connected")
        send_text(client, "set_user_role", "operator").succeeded()
        assert query(client, "get_user_role") == "OPERATOR"
        goal = command(client, "clear_operational_mode")
        assert not goal.accepted and client.rejection(goal).error_code == ErrorCode.NOT_SUPPORTED
    finally:
        client.close()


def test_shutdown_disconnects_the_server(addresses, processes):
    processes(Simulator(addresses[3]))
    processes(start_node("dashboard_server", addresses[3], namespace="going"))
    client = Client("going")
    try:
        wait_for(lambda: _is_connected(client), 20.0, "the dashboard server to be connected")
        assert command(client, "shutdown").succeeded().answer == "Shutting down"
        wait_for(lambda: _is_disconnected(client), 15.0, "the loss of the connection to be detected")
    finally:
        client.close()


def test_opens_and_closes_a_popup(dashboard):
    dashboard.send(DashboardText, "dashboard/popup", text="Please wait").succeeded()
    command(dashboard, "close_popup").succeeded()


@pytest.mark.parametrize("text, what", [("", "0 bytes"), ("two\nlines", "control character"), ("x" * 1001, "1001 bytes")])
def test_a_text_that_is_not_one_line_is_rejected(dashboard, text, what):
    goal = dashboard.send(DashboardText, "dashboard/popup", text=text)
    assert not goal.accepted
    rejection = dashboard.rejection(goal)
    assert rejection.error_code == ErrorCode.INVALID_GOAL and what in rejection.message


@pytest.mark.parametrize("timeout", [0.0, -1.0, float("nan"), 1e6])
def test_an_invalid_timeout_is_rejected(dashboard, timeout):
    goal = command(dashboard, "power_on", timeout=timeout)
    assert not goal.accepted
    assert "timeout" in dashboard.rejection(goal).message


def test_local_control_is_reported_as_the_reason(dashboard, simulator):
    simulator.control("remote_control", on=False)
    try:
        result = command(dashboard, "power_off").result()
        assert result.error_code == ErrorCode.REJECTED_BY_ROBOT and "local control" in result.message
        assert query(dashboard, "is_in_remote_control") == "false"
    finally:
        simulator.control("remote_control", on=True)
    # An e-Series controller applies the mode at the time of connection. The server must not be stuck in local control.
    command(dashboard, "power_off").succeeded()


def test_starts_without_the_controller_and_reconnects(addresses, processes):
    address = addresses[1]
    server = processes(start_node("dashboard_server", address, namespace="early"))
    client = Client("early")
    try:
        rejected = client.send(DashboardQuery, "dashboard/robot_mode")
        assert not rejected.accepted
        assert client.rejection(rejected).error_code == ErrorCode.LINK_LOST
        simulator = processes(Simulator(address))
        wait_for(lambda: _is_connected(client), 15.0, "the connection")
        simulator.kill()
        wait_for(lambda: _is_disconnected(client), 15.0, "the loss of the connection to be detected")
        simulator.start()
        wait_for(lambda: _is_connected(client), 15.0, "the reconnection")
        assert server.running()
    finally:
        client.close()


def _is_disconnected(client):
    goal = client.send(DashboardQuery, "dashboard/robot_mode")
    return not goal.accepted or not goal.result().success


def test_binary_data_between_answers_does_not_affect_queries(dashboard, simulator):
    """The data includes a zero byte and line ends. Each query uses a separate connection."""
    for size in (3, 40, 600):
        simulator.control("send_garbage", which="dashboard", bytes=size)
        assert query(dashboard, "safety_mode") == "NORMAL"
