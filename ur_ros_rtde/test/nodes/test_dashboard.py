"""dashboard_server: what it is told takes effect, what it is asked it answers, what cannot be is said."""

import pytest
from action_msgs.msg import GoalStatus
from support import Client, Simulator, node, wait_for

from ur_ros_rtde_msgs.action import DashboardCommand, DashboardQuery, DashboardText
from ur_ros_rtde_msgs.msg import ErrorCode


@pytest.fixture(scope="module")
def server(simulator):
    server = node("dashboard_server", simulator.address)
    yield server
    server.end()
    print(server.output())


@pytest.fixture
def dashboard(server, simulator, client):
    """Takes commands; the robot is running."""
    simulator.control("remote_control", on=True)
    simulator.control("power", to="running")
    wait_for(lambda: _accepted(client), 20.0, "the dashboard server to be connected")
    return client


def _accepted(client):
    goal = client.send(DashboardQuery, "dashboard/robot_mode")
    return goal.accepted and goal.succeeded()


def command(client, name, **fields):
    return client.send(DashboardCommand, f"dashboard/{name}", **fields)


def query(client, name):
    return client.send(DashboardQuery, f"dashboard/{name}").succeeded().answer


def test_queries_answer_without_their_label(dashboard):
    assert query(dashboard, "robot_mode") == "RUNNING"
    assert query(dashboard, "safety_mode") == "NORMAL"
    assert query(dashboard, "get_serial_number").isdigit()
    assert "5.25" in query(dashboard, "polyscope_version")
    assert query(dashboard, "program_state").startswith("STOPPED")


def test_the_arm_is_switched_off_and_on_and_its_brakes_released(dashboard):
    command(dashboard, "power_off").succeeded()
    assert query(dashboard, "robot_mode") == "POWER_OFF"
    goal = command(dashboard, "power_on")
    assert goal.succeeded().answer.startswith("Powering on")
    assert goal.feedback[-1].state == "IDLE"
    assert query(dashboard, "robot_mode") == "IDLE"
    command(dashboard, "brake_release").succeeded()
    assert query(dashboard, "robot_mode") == "RUNNING"


def test_what_does_not_take_effect_in_time_is_a_failure(dashboard):
    command(dashboard, "power_off").succeeded()
    status, result = command(dashboard, "brake_release", timeout=0.1).end()
    assert status == GoalStatus.STATUS_ABORTED and result.error_code == ErrorCode.TIMEOUT
    assert "RUNNING" in result.message and "0.1 s" in result.message


def test_a_wait_can_be_canceled(dashboard):
    command(dashboard, "power_off").succeeded()
    goal = command(dashboard, "brake_release")
    wait_for(lambda: goal.feedback, 10.0, "feedback")
    goal.cancel()
    status, result = goal.end(5.0)
    assert status == GoalStatus.STATUS_CANCELED and result.error_code == ErrorCode.CANCELED


def test_a_protective_stop_is_unlocked_once_the_robot_allows_it(dashboard, simulator):
    simulator.control("protective_stop", reason="a test")
    wait_for(lambda: query(dashboard, "safety_mode") == "PROTECTIVE_STOP", 5.0, "the protective stop")
    early = command(dashboard, "unlock_protective_stop").result()
    assert early.error_code == ErrorCode.REJECTED_BY_ROBOT and early.answer in early.message
    wait_for(lambda: command(dashboard, "unlock_protective_stop").result().success, 10.0, "the unlocking")
    assert query(dashboard, "safety_mode") == "NORMAL"


def test_a_program_is_played_and_stopped(dashboard, simulator):
    simulator.control("store_program", name="wait.urp", script="def wait():\n  while True:\n    sync()\n  end\nend\n", load=True)
    command(dashboard, "play").succeeded()
    assert query(dashboard, "program_state").startswith("PLAYING")
    command(dashboard, "stop").succeeded()
    assert query(dashboard, "program_state").startswith("STOPPED")


def test_popups_open_and_close(dashboard):
    dashboard.send(DashboardText, "dashboard/popup", text="Please wait").succeeded()
    command(dashboard, "close_popup").succeeded()


@pytest.mark.parametrize("text, what", [("", "0 bytes"), ("two\nlines", "control character"), ("x" * 1001, "1001 bytes")])
def test_a_text_that_is_not_one_line_is_refused(dashboard, text, what):
    goal = dashboard.send(DashboardText, "dashboard/popup", text=text)
    assert not goal.accepted
    refusal = dashboard.refusal(goal)
    assert refusal.error_code == ErrorCode.INVALID_GOAL and what in refusal.message


@pytest.mark.parametrize("timeout", [0.0, -1.0, float("nan"), 1e6])
def test_a_bad_timeout_is_refused(dashboard, timeout):
    goal = command(dashboard, "power_on", timeout=timeout)
    assert not goal.accepted
    assert "timeout" in dashboard.refusal(goal).message


def test_local_control_is_named_as_the_reason(dashboard, simulator):
    simulator.control("remote_control", on=False)
    try:
        result = wait_for(lambda: _local_refusal(dashboard), 10.0, "the reason")
        assert result.error_code == ErrorCode.REJECTED_BY_ROBOT
    finally:
        simulator.control("remote_control", on=True)


def _local_refusal(client):
    result = command(client, "power_off").result()
    return result if "local control" in result.message else None


def test_it_starts_before_the_robot_and_outlives_it(addresses, processes):
    address = addresses[1]
    server = processes(node("dashboard_server", address, namespace="early"))
    client = Client("early")
    try:
        refused = client.send(DashboardQuery, "dashboard/robot_mode")
        assert not refused.accepted
        assert client.refusal(refused).error_code == ErrorCode.LINK_LOST
        simulator = processes(Simulator(address))
        wait_for(lambda: _accepted(client), 15.0, "the connection")
        simulator.kill()
        wait_for(lambda: _not_connected(client), 15.0, "the loss to be noticed")
        simulator.start()
        wait_for(lambda: _accepted(client), 15.0, "the connection to be back")
        assert server.running()
    finally:
        client.close()


def _not_connected(client):
    goal = client.send(DashboardQuery, "dashboard/robot_mode")
    return not goal.accepted or not goal.result().success
