"""The fixtures of the tests on a simulated robot: the simulator, a driver that is linked to it, and a client."""

import os
import time

import pytest
from support import HOME, RECOVERY_TIME_FACTOR, Client, Simulator, start_node, wait_for

from ur_ros_rtde_msgs.action import MoveJ

RETRY = 0.05  # s


def _address(number):
    """Loopback addresses of this run's own: ./ur test gives each test file one."""
    given = os.environ.get("UR_TEST_ADDRESS", "127.0.1.200").split(".")
    return ".".join([given[0], str(int(given[1]) + number), given[2], given[3]])


@pytest.fixture(scope="session")
def addresses():
    return [_address(number) for number in range(4)]


@pytest.fixture(scope="module")
def simulator(addresses, request):
    """A module that tests recoveries may ask for their real durations: RECOVERY_TIME_FACTOR = 1.0."""
    simulator = Simulator(addresses[0],
                          recovery_time_factor=getattr(request.module, "RECOVERY_TIME_FACTOR", RECOVERY_TIME_FACTOR))
    yield simulator
    simulator.stop()


@pytest.fixture(scope="module")
def client():
    client = Client()
    yield client
    client.close()


@pytest.fixture(autouse=True)
def destroy_subscriptions_after_test(request):
    yield
    if "client" in request.fixturenames:
        request.getfixturevalue("client").destroy_subscriptions()


@pytest.fixture(scope="module")
def driver(simulator):
    driver = start_node("driver", simulator.address, "ur_type:=ur10e")
    yield driver
    driver.stop()
    print(driver.output())


@pytest.fixture
def processes():
    """Keeps a test's processes; ends them in the opposite order."""
    kept = []
    yield lambda process: kept.append(process) or process
    for process in reversed(kept):
        process.stop()
        print(getattr(process, "process", process).output())


def make_ready(client, limit=30.0, joint_positions=HOME):
    """Waits until the driver accepts a motion to these joint positions and the motion has succeeded."""

    def arrived():
        goal = client.send(MoveJ, "move_j", joint_positions=joint_positions, speed=3.0, acceleration=15.0)
        if goal.accepted and goal.result().success:
            return True
        reasons.append(client.refusal(goal).message if not goal.accepted else goal.result().message)
        time.sleep(RETRY)
        return False

    reasons = []
    try:
        wait_for(arrived, limit, "the driver to take a motion")
    except AssertionError as error:
        raise AssertionError(f"{error}; the last reason: {reasons[-1:]}") from None


@pytest.fixture
def robot(simulator, driver, client):
    """A driver that is ready, the arm at home, nothing in its way."""
    assert driver.running(), driver.output()
    simulator.control("clear_surfaces")
    simulator.control("clear_pushes")
    simulator.control("speed_slider", fraction=1.0)
    make_ready(client)
    return client
