"""Fixtures for tests with a simulated robot: the simulator, a driver connected to it, and a client."""

import contextlib
import time

import pytest
from programs import Simulator, start_node
from ros_client import Client
from support import HOME, REAL_TIME_FACTOR, RECOVERY_TIME_FACTOR, own_address, wait_for

from ur_ros_rtde_msgs.action import MoveJ
from ur_ros_rtde_msgs.msg import ErrorCode

RETRY_INTERVAL = 0.05  # s
SLOWNESS = 10.0  # s of the host for each s of a slow robot
# Error codes of rejections while the control program starts.
STARTING = (ErrorCode.NOT_READY, ErrorCode.PROGRAM_STOPPED, ErrorCode.LINK_LOST)


@pytest.fixture(scope="session")
def addresses():
    return [own_address(number) for number in range(4)]


@pytest.fixture(scope="module")
def simulator(addresses, request):
    """Simulates recoveries at the speed that the test module sets: RECOVERY_TIME_FACTOR = 1.0 for real durations.

    The test module may set further SIMULATOR_ARGUMENTS."""
    simulator = Simulator(addresses[0], *getattr(request.module, "SIMULATOR_ARGUMENTS", ()),
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
def driver(simulator, request):
    """A driver with the plugins that the test module sets: PLUGINS = FEW_PLUGINS. The module may set further DRIVER_PARAMETERS."""
    chosen = [request.module.PLUGINS] if hasattr(request.module, "PLUGINS") else []
    driver = start_node("driver", simulator.address, "ur_type:=ur10e", *chosen, *getattr(request.module, "DRIVER_PARAMETERS", ()))
    yield driver
    driver.stop()
    print(driver.output())


@pytest.fixture
def processes():
    """Returns a function that registers a process. Registered processes are stopped in reverse order after the test."""
    kept = []
    yield lambda process: kept.append(process) or process
    for process in reversed(kept):
        process.stop()
        print(getattr(process, "process", process).output())


def make_ready(client, limit=30.0, joint_positions=HOME):
    """Waits until the driver accepts a motion to these joint positions and the motion succeeds."""

    def is_at_target():
        goal = client.send(MoveJ, "move_j", joint_positions=joint_positions, speed=3.0, acceleration=15.0)
        if goal.accepted and goal.result().success:
            return True
        reasons.append(client.rejection(goal).message if not goal.accepted else goal.result().message)
        time.sleep(RETRY_INTERVAL)
        return False

    reasons = []
    try:
        wait_for(is_at_target, limit, "the driver to accept a motion")
    except AssertionError as error:
        raise AssertionError(f"{error}; last message: {reasons[-1:]}") from None


def send_after_stop(client, action, name, **fields):
    """Sends a goal after a stop. If the host was late, the stop has ended the control program, which starts again: sends it until it is
    accepted. Fails if it is rejected for another reason."""

    def accepted():
        goal = client.send(action, name, **fields)
        if goal.accepted:
            return goal
        rejection = client.rejection(goal)
        assert rejection.error_code in STARTING, rejection.message
        return None

    return wait_for(accepted, 20.0, "the control program")


@pytest.fixture
def start_slow_robot(addresses, processes):
    """Returns a function that starts a robot of its own and returns client, driver and simulator.

    The robot is slow, so that delays of a busy host are short in its time: a stop ends the control program if that does not take its
    command within some control cycles."""
    clients = []

    def start(*plugins):
        simulator = processes(Simulator(addresses[1], real_time_factor=REAL_TIME_FACTOR / SLOWNESS))
        driver = processes(start_node("driver", simulator.address, "ur_type:=ur10e", f"plugins:=[{','.join(('move_j', 'stop', *plugins))}]",
                                      namespace="slow"))
        clients.append(Client("slow"))
        make_ready(clients[-1], 60.0)
        return clients[-1], driver, simulator

    yield start
    for client in clients:
        client.close()


@pytest.fixture
def robot(simulator, driver, client):
    """A client of a driver that is ready, with the arm at home and no obstacles. A protective stop of the test before is unlocked."""
    assert driver.running(), driver.output()
    if simulator.state()["safety_mode"] == "PROTECTIVE_STOP":
        wait_for(simulator.unlock_protective_stop, 15.0, "the protective stop to be unlocked")
    simulator.control("clear_surfaces")
    simulator.control("clear_boxes")
    simulator.control("clear_pushes")
    simulator.control("speed_slider", fraction=1.0)
    make_ready(client)
    return client


@contextlib.contextmanager
def simulated_robot(*parameters, model="ur10e", env=None):
    """Yields a simulator whose driver, with these parameters, accepts motions."""
    simulator = Simulator(own_address(), model=model)
    driver = start_node("driver", simulator.address, *parameters, env=env)
    client = Client()
    try:
        wait_for(lambda: client.send(MoveJ, "move_j", joint_positions=HOME).accepted, 30.0, "the driver to accept a motion")
        yield simulator
    finally:
        client.close()
        driver.stop()
        simulator.stop()
