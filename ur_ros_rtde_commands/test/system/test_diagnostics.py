"""The content of /diagnostics, published once per second."""

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from programs import Simulator, start_node
from support import FEW_PLUGINS, HOME, seconds, wait_for

from ur_ros_rtde_msgs.action import MoveJ

PLUGINS = FEW_PLUGINS
NAMES = ["link", "packages", "robot"]


def entry(arrays, name, condition=lambda status: True, what=None, limit=20.0):
    """Waits until the newest entry of that name satisfies the condition, and returns it."""

    def newest():
        for array in reversed(list(arrays)):
            for status in array.status:
                if status.name == name:
                    return status if condition(status) else None
        return None

    return wait_for(newest, limit, what or name)


def values(status):
    return {pair.key: pair.value for pair in status.values}


@pytest.fixture
def arrays(client):
    return client.subscribe(DiagnosticArray, "/diagnostics")


@pytest.fixture(scope="module")
def receiver(simulator):
    receiver = start_node("robot_state_receiver", simulator.address, namespace="cell/left")
    yield receiver
    receiver.stop()
    print(receiver.output())


def full_name(name):
    return f"/cell/left/robot_state_receiver: {name}"


def test_entries_are_published_once_per_second_under_the_node_name(receiver, simulator, arrays):
    entry(arrays, full_name("robot"))
    own = []

    def collect():
        own[:] = [array for array in list(arrays) if any(status.name == full_name("link") for status in array.status)]
        return len(own) >= 4

    wait_for(collect, 15.0, "four arrays")
    assert [status.name for status in own[-1].status] == [full_name(name) for name in NAMES]
    assert {status.hardware_id for status in own[-1].status} == {simulator.address}
    stamps = [seconds(array.header.stamp) for array in own]
    assert (stamps[-1] - stamps[0]) / (len(stamps) - 1) == pytest.approx(1.0, abs=0.2)


def test_a_connected_link_is_ok_with_address_and_version(receiver, simulator, arrays):
    link = entry(arrays, full_name("link"), lambda s: s.level == DiagnosticStatus.OK)
    assert values(link)["address"] == simulator.address and values(link)["PolyScope"].startswith("5.25")


def test_reports_rate_and_intervals_of_the_packages(receiver, arrays):
    def number(status, name):
        return float(values(status).get(name, "0").split()[0])

    def is_whole_second(status):  # the connection began before it
        rate = number(status, "rate")
        return rate > 100.0 and number(status, "interval, mean") == pytest.approx(1000.0 / rate, rel=0.2)

    reported = values(entry(arrays, full_name("packages"), is_whole_second))
    mean = float(reported["interval, mean"].split()[0])
    assert reported["agreed rate"] == "500.0 Hz"
    assert mean <= float(reported["interval, 99 %"].split()[0]) <= float(reported["interval, longest"].split()[0])
    assert int(reported["received"]) > 100 and int(reported["lost"]) >= int(reported["lost in the last second"]) >= 0


def test_counts_lost_packages_and_reports_a_low_rate(receiver, simulator, arrays):
    before = int(values(entry(arrays, full_name("packages")))["lost"])
    receiver.pause()
    try:
        number = len(arrays)
        simulator.wait(1.0, 20.0)
        assert len(arrays) <= number + 1, "the receiver is paused"
    finally:
        receiver.resume()
    packages = entry(arrays, full_name("packages"), lambda s: int(values(s)["lost"]) > before, "the loss")
    assert packages.level in (DiagnosticStatus.WARN, DiagnosticStatus.ERROR), packages.message


def test_reports_what_prevents_motion(receiver, simulator, arrays):
    simulator.control("power", to="running")
    robot = entry(arrays, full_name("robot"), lambda s: s.level == DiagnosticStatus.OK)
    reported = values(robot)
    assert (reported["safety mode"], reported["robot mode"]) == ("NORMAL", "RUNNING")
    assert 0.0 <= float(reported["speed scaling"]) <= 1.0 and 10.0 < float(reported["hottest joint"].split()[0]) < 75.0
    simulator.control("protective_stop", reason="a test")
    entry(arrays, full_name("robot"), lambda s: s.level == DiagnosticStatus.WARN and "PROTECTIVE_STOP" in s.message,
          "the protective stop")
    simulator.control("power", to="running")
    simulator.control("emergency_stop")
    entry(arrays, full_name("robot"), lambda s: s.level == DiagnosticStatus.ERROR and "EMERGENCY_STOP" in s.message,
          "the emergency stop")
    simulator.control("emergency_stop", pressed=False)
    simulator.control("power", to="running")
    entry(arrays, full_name("robot"), lambda s: s.level == DiagnosticStatus.OK, "the robot to be OK")


def test_an_unreachable_controller_is_stale_and_a_lost_one_an_error(addresses, processes, client, arrays):
    processes(start_node("robot_state_receiver", addresses[1], namespace="early"))
    link, robot = "/early/robot_state_receiver: link", "/early/robot_state_receiver: robot"
    assert addresses[1] in entry(arrays, link, lambda s: s.level == DiagnosticStatus.STALE and addresses[1] in s.message).message
    simulator = Simulator(addresses[1])
    entry(arrays, link, lambda s: s.level == DiagnosticStatus.OK, "the link")
    entry(arrays, robot, lambda s: s.level == DiagnosticStatus.OK, "the robot")
    simulator.kill()
    entry(arrays, link, lambda s: s.level == DiagnosticStatus.ERROR, "the loss")
    assert values(entry(arrays, robot, lambda s: s.level == DiagnosticStatus.STALE, "the unknown state"))["robot mode"] == "RUNNING"


def test_reports_the_driver_state_and_the_active_motion_goal(simulator, client, robot, arrays):
    name = "/command_server: driver"
    reported = values(entry(arrays, name, lambda s: s.level == DiagnosticStatus.OK, "the driver to be ready"))
    assert (reported["state"], reported["cause"], reported["model"], reported["motion goal"]) == ("READY", "none", "ur10e", "none")
    goal = client.send(MoveJ, "move_j", joint_positions=[HOME[0] + 1.0, *HOME[1:]], speed=0.1, acceleration=1.0)
    assert goal.accepted
    busy = entry(arrays, name, lambda s: values(s)["motion goal"] != "none", "the goal")
    assert "move_j" in values(busy)["motion goal"] and values(busy)["control program"] == "runs"
    goal.cancel()
    goal.wait_for_result()
    simulator.control("protective_stop", reason="a test")
    stopped = entry(arrays, name, lambda s: values(s)["state"] == "STOPPED", "the stop")
    assert stopped.level == DiagnosticStatus.WARN and values(stopped)["cause"] == "protective_stop"
    simulator.control("power", to="running")
