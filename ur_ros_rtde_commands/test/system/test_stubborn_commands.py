"""Commands that do what they must not do do not keep the arm moving. The commands are those of test/plugins."""

import pytest
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import Vector3, Wrench
from plugin_prefix import environment_of_test_commands
from programs import Simulator, start_node
from robot_fixtures import make_ready
from ros_client import Client
from support import HOME, TIMEOUT_FACTOR, wait_for

from ur_ros_rtde_msgs.action import DashboardCommand, DashboardQuery, ForceMode, MoveJ, SendScript, SpeedJ, Stop, Trigger
from ur_ros_rtde_msgs.msg import ErrorCode

STOPS = ("stop", "stand_down", "trigger_protective_stop", "dashboard/stop", "dashboard/pause", "dashboard/power_off",
         "dashboard/shutdown")
PLUGINS = ("plugins:=[move_j,turns_as_mode,turns_and_hangs,slow_to_check,very_slow_to_check,turns_as_output,force_mode_start,"
           f"starts_speed_l,starts_force_mode,blocks_callbacks,fails,send_script,dashboard/hangs,dashboard/slow_to_check,{','.join(STOPS)}]")
STOPPING_TIME = 1.5  # s, with a reserve: 0.5 rad/s at 2 rad/s^2 take 0.25 s
DOCUMENTED_STOPPING_TIME = 0.6  # s, of a cancel and of a stop: docs/use/safety.md
ACTING_TIME = 0.5  # s, from the request of a stop to its effect


@pytest.fixture
def cell(addresses, tmp_path, processes, request):
    """A simulator, a driver with the commands of test/plugins, and a client. The parameter of the fixture are those of the driver."""
    environment = environment_of_test_commands(tmp_path / "prefix")
    assert environment, "the test commands have not been built"
    simulator = Simulator(addresses[1])
    parameters = ("ur_type:=ur10e", PLUGINS, *getattr(request, "param", ()))
    driver = processes(start_node("driver", addresses[1], *parameters, namespace="stubborn", env=environment))
    client = Client("stubborn")
    make_ready(client)
    yield simulator, driver, client
    client.close()
    driver.stop()
    simulator.stop()


def time_to_rest(simulator, begin):
    wait_for(simulator.is_at_rest, 15.0, "standstill")
    return simulator.state()["timestamp"] - begin


def ends_with_the_arm_at_rest(simulator, driver):
    begin = simulator.state()["timestamp"]
    driver.interrupt()
    assert time_to_rest(simulator, begin) < STOPPING_TIME
    assert driver.wait(15.0) == 0


def test_ctrl_c_stops_the_arm_while_a_dashboard_command_hangs(cell):
    simulator, driver, client = cell
    assert client.send(DashboardQuery, "dashboard/hangs").accepted
    assert client.send(MoveJ, "move_j", joint_positions=[3.0, *HOME[1:]], speed=0.5, acceleration=2.0).accepted
    wait_for(lambda: not simulator.is_at_rest(), 10.0, "a motion")
    ends_with_the_arm_at_rest(simulator, driver)


def test_ctrl_c_ends_a_mode_without_a_goal_while_a_dashboard_command_hangs(cell):
    simulator, driver, client = cell
    client.send(ForceMode, "force_mode_start", compliant=[False, False, True, False, False, False],
                wrench=Wrench(force=Vector3(z=-5.0)), limits=[0.1, 0.1, 0.02, 0.5, 0.5, 0.5]).succeeded()
    wait_for(lambda: not simulator.is_at_rest(), 10.0, "a motion")
    assert client.send(DashboardQuery, "dashboard/hangs").accepted
    ends_with_the_arm_at_rest(simulator, driver)


def test_a_cancel_stops_what_a_hanging_command_of_a_mode_has_started_and_it_switches_no_output_later(cell):
    simulator, driver, client = cell
    goal = client.send(SpeedJ, "turns_and_hangs", joint_velocities=[0.5, 0.0, 0.0, 0.0, 0.0, 0.0], acceleration=2.0, time=4.0)
    wait_for(lambda: not simulator.is_at_rest(), 10.0, "a motion")
    begin = simulator.state()["timestamp"]
    goal.cancel()
    assert time_to_rest(simulator, begin) < STOPPING_TIME
    status, result = goal.wait_for_result()
    assert status == GoalStatus.STATUS_CANCELED and "did not return" in result.message, result.message
    wait_for(lambda: "its command has returned after its result was sent" in driver.output(), 15.0, "the end of the command")
    simulator.wait(0.1, 15.0)
    assert simulator.state()["io"]["digital_outputs"] == 0


def test_a_command_without_a_resource_that_moves_the_arm_cannot_move_it(cell):
    simulator, _driver, client = cell
    fields = {"joint_velocities": [0.5, 0.0, 0.0, 0.0, 0.0, 0.0], "acceleration": 2.0}
    result = client.send(SpeedJ, "turns_as_output", **fields).result()
    assert result.error_code == ErrorCode.EXCEPTION and "have to name Resource::motion" in result.message, result.message
    assert simulator.is_at_rest() and simulator.state()["actual"]["position"][0] == pytest.approx(HOME[0], abs=0.01)


def test_what_a_command_of_a_mode_leaves_turning_is_stopped(cell):
    simulator, _driver, client = cell
    begin = simulator.state()["timestamp"]
    client.send(SpeedJ, "turns_as_mode", joint_velocities=[0.5, 0.0, 0.0, 0.0, 0.0, 0.0], acceleration=2.0).succeeded()
    assert time_to_rest(simulator, begin) < STOPPING_TIME
    wait_for(lambda: simulator.state()["timestamp"] > begin + STOPPING_TIME, 15.0, "the time in which it would turn")
    assert simulator.is_at_rest() and abs(simulator.state()["actual"]["position"][0] - HOME[0]) < 0.5 * STOPPING_TIME / 2.0
    client.send(MoveJ, "move_j", joint_positions=HOME, speed=1.0).succeeded()


@pytest.mark.parametrize("cell", [("on_busy:=preempt",)], indirect=True)
def test_a_goal_that_has_preempted_a_script_fails_with_its_own_error(cell):
    simulator, _driver, client = cell
    client.send(SendScript, "send_script", script="q = get_actual_joint_positions()\nq[0] = q[0] + 1.5\nmovej(q, a=1, v=0.3)")
    wait_for(lambda: not simulator.is_at_rest(), 10.0, "a motion")
    _, result = client.send(SpeedJ, "fails", acceleration=1.0).wait_for_result()
    assert result.error_code == ErrorCode.EXCEPTION and "the gripper is broken" in result.message, result.message


def test_a_goal_whose_check_was_overtaken_by_a_stop_is_rejected(cell):
    simulator, _driver, client = cell
    client.send(Stop, "stop").succeeded()  # the server is known from now on
    goal = client.send(SpeedJ, "slow_to_check", joint_velocities=[0.5, 0.0, 0.0, 0.0, 0.0, 0.0], acceleration=2.0, time=4.0)
    client.send(Stop, "stop").succeeded()
    assert not goal.accepted and "the arm was stopped" in client.rejection(goal).message
    assert simulator.is_at_rest()


@pytest.mark.parametrize("name", ["starts_speed_l", "starts_force_mode"])
def test_what_a_command_that_ends_before_its_motion_has_started_is_stopped(cell, name):
    simulator, _driver, client = cell
    start = simulator.state()["actual"]["position"]
    client.send(SpeedJ, name, acceleration=0.5).succeeded()
    simulator.wait(STOPPING_TIME, 15.0)
    assert simulator.is_at_rest() and simulator.state()["actual"]["position"] == pytest.approx(start, abs=0.05)
    client.send(MoveJ, "move_j", joint_positions=HOME, speed=1.0).succeeded()


@pytest.mark.parametrize("end", ["cancel", "stop"])
def test_a_cancel_and_a_stop_do_not_wait_for_a_callback_of_a_plugin(cell, end):
    simulator, _driver, client = cell
    client.send(Stop, "stop").succeeded()  # the server is known from now on
    goal = client.send(SpeedJ, "blocks_callbacks", joint_velocities=[0.5, 0.0, 0.0, 0.0, 0.0, 0.0], acceleration=5.0, time=10.0)
    wait_for(lambda: simulator.state()["actual"]["velocity"][0] > 0.45, 10.0, "a motion")
    waiting = client.send(MoveJ, "move_j", speed=-1.0)
    begin = simulator.state()["timestamp"]
    if end == "cancel":
        goal.cancel()
    else:
        client.send(Stop, "stop")
    assert time_to_rest(simulator, begin) < DOCUMENTED_STOPPING_TIME * TIMEOUT_FACTOR
    status, _result = goal.wait_for_result()
    assert status == (GoalStatus.STATUS_CANCELED if end == "cancel" else GoalStatus.STATUS_ABORTED)
    assert not waiting.answered(), "the callback has ended before"
    assert not waiting.accepted


@pytest.mark.parametrize("stop, action, slow, slow_action, mode", [
    ("trigger_protective_stop", Trigger, "very_slow_to_check", SpeedJ, {"safety_mode": "PROTECTIVE_STOP"}),
    ("dashboard/power_off", DashboardCommand, "dashboard/slow_to_check", DashboardQuery, {"robot_mode": "POWER_OFF"}),
])
def test_a_command_that_stops_the_arm_does_not_wait_for_the_check_of_another(cell, stop, action, slow, slow_action, mode):
    simulator, _driver, client = cell
    slow_goals = [client.send(slow_action, slow) for _ in range(2)]  # the second one also outlasts the discovery of the stop
    client.send(action, stop)
    begin = simulator.state()["timestamp"]
    wait_for(lambda: mode.items() <= simulator.state().items(), 15.0, f"the effect of {stop}")
    assert simulator.state()["timestamp"] - begin < ACTING_TIME * TIMEOUT_FACTOR
    assert not slow_goals[-1].answered(), "its check has ended before"


def test_the_servers_of_the_commands_that_stop_the_arm_exist_before_their_first_client(cell):
    _simulator, _driver, client = cell
    servers = {f"/stubborn/{name}/_action/send_goal" for name in STOPS}

    def missing():
        return servers - dict(client.node.get_service_names_and_types()).keys()

    wait_for(lambda: not missing(), 10.0, f"servers, at first without {missing()}")
