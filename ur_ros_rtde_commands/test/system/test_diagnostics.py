"""/diagnostics: once a second, what a monitor and a person before it want to know."""

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from support import HOME, Simulator, seconds, start_node, wait_for

from ur_ros_rtde_msgs.action import MoveJ

NAMES = ["link", "packages", "robot"]


def entry(arrays, name, condition=lambda status: True, what=None, limit=20.0):
    """The newest entry of that name, once it is as it should be."""

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


def of(name):
    return f"/cell/left/robot_state_receiver: {name}"


def test_entries_come_once_a_second_and_are_named_after_the_node(receiver, simulator, arrays):
    entry(arrays, of("robot"))
    own = []

    def collect():
        own[:] = [array for array in list(arrays) if any(status.name == of("link") for status in array.status)]
        return len(own) >= 4

    wait_for(collect, 15.0, "four arrays")
    assert [status.name for status in own[-1].status] == [of(name) for name in NAMES]
    assert {status.hardware_id for status in own[-1].status} == {simulator.address}
    stamps = [seconds(array.header.stamp) for array in own]
    assert (stamps[-1] - stamps[0]) / (len(stamps) - 1) == pytest.approx(1.0, abs=0.2)


def test_a_link_that_stands_is_ok_with_address_and_version(receiver, simulator, arrays):
    link = entry(arrays, of("link"), lambda s: s.level == DiagnosticStatus.OK)
    assert values(link)["address"] == simulator.address and values(link)["PolyScope"].startswith("5.25")


def test_the_rate_and_the_intervals_of_the_packages_are_told(receiver, arrays):
    packages = entry(arrays, of("packages"), lambda s: float(values(s).get("rate", "0").split()[0]) > 100.0)
    told = values(packages)
    rate, mean = float(told["rate"].split()[0]), float(told["interval, mean"].split()[0])
    assert told["agreed rate"] == "500.0 Hz"
    assert mean == pytest.approx(1000.0 / rate, rel=0.2)
    assert mean <= float(told["interval, 99 %"].split()[0]) <= float(told["interval, longest"].split()[0])
    assert int(told["received"]) > 100 and int(told["lost"]) >= int(told["lost in the last second"]) >= 0


def test_lost_packages_are_counted_and_a_bad_rate_is_an_error(receiver, simulator, arrays):
    before = int(values(entry(arrays, of("packages")))["lost"])
    receiver.pause()
    try:
        number = len(arrays)
        stamp = simulator.state()["timestamp"]
        wait_for(lambda: simulator.state()["timestamp"] > stamp + 1.0, 20.0, "a second to go by")
        assert len(arrays) <= number + 1, "it is paused"
    finally:
        receiver.resume()
    packages = entry(arrays, of("packages"), lambda s: int(values(s)["lost"]) > before, "the loss")
    assert packages.level in (DiagnosticStatus.WARN, DiagnosticStatus.ERROR), packages.message


def test_the_robot_tells_what_keeps_it_from_moving(receiver, simulator, arrays):
    simulator.control("power", to="running")
    robot = entry(arrays, of("robot"), lambda s: s.level == DiagnosticStatus.OK)
    told = values(robot)
    assert (told["safety mode"], told["robot mode"]) == ("NORMAL", "RUNNING")
    assert 0.0 <= float(told["speed scaling"]) <= 1.0 and 10.0 < float(told["hottest joint"].split()[0]) < 75.0
    simulator.control("protective_stop", reason="a test")
    entry(arrays, of("robot"), lambda s: s.level == DiagnosticStatus.WARN and "PROTECTIVE_STOP" in s.message, "the protective stop")
    simulator.control("power", to="running")
    simulator.control("emergency_stop")
    entry(arrays, of("robot"), lambda s: s.level == DiagnosticStatus.ERROR and "EMERGENCY_STOP" in s.message, "the emergency stop")
    simulator.control("emergency_stop", pressed=False)
    simulator.control("power", to="running")
    entry(arrays, of("robot"), lambda s: s.level == DiagnosticStatus.OK, "that all is well")


def test_what_has_never_been_there_is_stale_and_what_is_gone_an_error(addresses, processes, client, arrays):
    processes(start_node("robot_state_receiver", addresses[1], namespace="early"))
    link, robot = "/early/robot_state_receiver: link", "/early/robot_state_receiver: robot"
    assert addresses[1] in entry(arrays, link, lambda s: s.level == DiagnosticStatus.STALE and addresses[1] in s.message).message
    simulator = Simulator(addresses[1])
    entry(arrays, link, lambda s: s.level == DiagnosticStatus.OK, "the link")
    entry(arrays, robot, lambda s: s.level == DiagnosticStatus.OK, "the robot")
    simulator.kill()
    entry(arrays, link, lambda s: s.level == DiagnosticStatus.ERROR, "the loss")
    assert values(entry(arrays, robot, lambda s: s.level == DiagnosticStatus.STALE, "that it is not known"))["robot mode"] == "RUNNING"


def test_the_driver_tells_its_state_and_whose_goal_has_the_arm(simulator, client, robot, arrays):
    name = "/command_server: driver"
    told = values(entry(arrays, name, lambda s: s.level == DiagnosticStatus.OK, "the driver to be ready"))
    assert (told["state"], told["cause"], told["motion goal"]) == ("READY", "none", "none")
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
