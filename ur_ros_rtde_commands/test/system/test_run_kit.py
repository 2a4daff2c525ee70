"""What Run offers to plugins besides motions: RTDE outputs, frames of TF, settings that are put back. The commands are in test/plugins."""

import pytest
from action_msgs.msg import GoalStatus
from plugin_prefix import driver_of_test_commands
from robot_fixtures import make_ready
from support import HOME, wait_for

from ur_ros_rtde_msgs.action import SendScript
from ur_ros_rtde_msgs.msg import ErrorCode

OTHER_TOOL = pytest.approx((2.0, 0.1))  # kg, m; the controller's registers have 32 bits


@pytest.fixture(scope="module")
def driver(simulator, tmp_path_factory):
    with driver_of_test_commands(simulator, tmp_path_factory.mktemp("prefix"), "move_j", "stop", "tells_frame", "waits_for_output",
                                 "uses_another_tool", "fails_to_set_the_tool") as driver:
        yield driver


def test_an_output_that_no_sample_contains_can_be_waited_for(robot, simulator):
    simulator.control("set_analog_input", number=0, tool=True, value=1.5)
    goal = robot.send(SendScript, "waits_for_output", script="tool_analog_input0", timeout=20.0)
    wait_for(lambda: goal.accepted, 10.0, "the acceptance")
    simulator.control("set_analog_input", number=0, tool=True, value=4.5)
    assert [float(position) for position in goal.succeeded().output] == pytest.approx(HOME, abs=0.01)
    simulator.control("set_analog_input", number=0, tool=True, value=1.5)
    result = robot.send(SendScript, "waits_for_output", script="tool_analog_input0", timeout=0.2).result()
    assert result.error_code == ErrorCode.NOT_REACHED and result.message == "the value is too small", result.message


@pytest.mark.parametrize("name, code, text", [
    ("tool_analog_input9", ErrorCode.INVALID_GOAL, '"tool_analog_input9" is not an RTDE output'),
    ("timestamp", ErrorCode.INVALID_GOAL, '"timestamp" occurs twice'),
    ("target_q", ErrorCode.INVALID_GOAL, "the output target_q has 6 values: use vector()"),
])
def test_an_output_that_cannot_be_read_is_named(robot, name, code, text):
    result = robot.send(SendScript, "waits_for_output", script=name, timeout=5.0).result()
    assert result.error_code == code and text in result.message, result.message


def test_the_pose_of_a_frame_of_tf_is_told(robot, simulator):
    told = robot.send(SendScript, "tells_frame", script="tool0_controller", timeout=5.0).succeeded().output
    assert [float(value) for value in told[:3]] == pytest.approx(simulator.state()["actual_tcp_pose"][:3], abs=0.002)
    result = robot.send(SendScript, "tells_frame", script="nowhere", timeout=5.0).result()
    assert result.error_code == ErrorCode.INVALID_GOAL and 'TF has no frame "nowhere"' in result.message, result.message


def receiving_connections(simulator):
    return simulator.control("delay_links", which="rtde", clients="receive", ms=0)["connections"]


def test_a_lost_connection_ends_the_wait_for_an_output(robot, simulator):
    before = receiving_connections(simulator)
    goal = robot.send(SendScript, "waits_for_output", script="tool_analog_input0", timeout=20.0)
    wait_for(lambda: receiving_connections(simulator) > before, 10.0, "the connection of the outputs")
    simulator.control("drop_links", which="rtde", clients="receive")
    result = goal.result()
    assert result.error_code == ErrorCode.LINK_LOST, result.message
    make_ready(robot)


def settings(simulator):
    state = simulator.state()
    return state["payload"]["mass"], state["tcp_offset"][2]


@pytest.fixture
def other_tool(robot, simulator):
    """Returns a function that sends a goal, and waits until it has set its payload and TCP and moves."""

    def send(what="put back"):
        goal = robot.send(SendScript, "uses_another_tool", script=what, timeout=1.0)
        wait_for(lambda: settings(simulator) == OTHER_TOOL and not simulator.is_at_rest(), 15.0, "the settings and a motion")
        return goal

    return send


def test_payload_and_tcp_are_put_back_after_the_goal(simulator, other_tool):
    other_tool().succeeded()
    assert settings(simulator) == (0.0, 0.0)


def test_payload_and_tcp_are_put_back_at_rest_after_a_cancel(simulator, other_tool):
    goal = other_tool()
    goal.cancel()
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_CANCELED and "put back" not in result.message, result.message
    assert settings(simulator) == (0.0, 0.0) and simulator.is_at_rest()


def test_a_setting_that_is_not_confirmed_is_put_back(robot, simulator):
    result = robot.send(SendScript, "fails_to_set_the_tool", script="x").result()
    assert result.error_code == ErrorCode.REJECTED_BY_ROBOT and result.message == "not confirmed", result.message
    assert settings(simulator) == (0.0, 0.0)


def test_payload_and_tcp_can_be_kept(simulator, other_tool):
    other_tool("keep").succeeded()
    assert settings(simulator) == OTHER_TOOL
