"""Times from an event or a contact to the standstill of the arm, in simulated time: the figures of docs/use/safety.md.

The simulated robot is slow, so that delays of a busy host are short in its time. The limits of driver and robot have their default values,
in the robot's time.
"""

import pathlib
import re
import threading

import pytest
from geometry_msgs.msg import Twist, Vector3
from programs import Simulator, start_node
from robot_fixtures import make_ready
from ros_client import Client
from support import HOME, wait_for
from ur_ros_rtde_cli.robot_check.rtde import Rtde

from ur_ros_rtde_msgs.action import MoveJ, MoveUntilForce, Stop

SLOWNESS = 5.0  # s of the host for each s of the robot
SPEED = 0.5  # rad/s, of joint 0
AT_REST = 0.01  # rad/s
TABLE = 0.6  # m, height; the TCP is at 0.677 m at home
PAGE = pathlib.Path(__file__).resolve().parents[3] / "docs" / "use" / "safety.md"


class Recorder(threading.Thread):
    """Receives the speeds of the joints in each control cycle."""

    def __init__(self, address):
        super().__init__(daemon=True)
        self._rtde = Rtde(address, 30.0)
        self._rtde.set_outputs(["timestamp", "actual_qd"], 500.0)
        self._stopping = threading.Event()
        self.cycles = []
        self._rtde.start()
        self.start()

    def run(self):
        while not self._stopping.is_set():
            values = self._rtde.values()
            self.cycles.append((values["timestamp"], max(map(abs, values["actual_qd"]))))

    def close(self):
        self._stopping.set()
        self.join(30.0)
        self._rtde.__exit__()

    def time(self):
        return self.cycles[-1][0]

    def speed(self):
        return self.cycles[-1][1]

    def wait_for_standstill(self, event):
        """Returns the time between the event and the first cycle of a standstill of 0.2 s."""
        wait_for(lambda: self.time() > event + 0.2 and all(speed < AT_REST for time, speed in self._last(0.2)), 60.0, "standstill")
        moving = [time for time, speed in self.cycles if speed >= AT_REST]
        assert moving[-1] > event, "the arm had stopped before the event"
        return moving[-1] - event

    def _last(self, duration):
        return [cycle for cycle in self.cycles if cycle[0] >= self.cycles[-1][0] - duration]


@pytest.fixture(scope="module")
def simulator(addresses):
    started = Simulator(addresses[0], real_time_factor=1.0 / SLOWNESS)
    yield started
    started.stop()


@pytest.fixture
def fresh_client():
    """A client that has never seen another driver: a killed one stays discovered for some seconds."""
    created = Client()
    yield created
    created.close()


@pytest.fixture
def driver(simulator):
    # The robot measures the period of its watchdog, the driver the silence, each in its own time.
    started = start_node("driver", simulator.address, "ur_type:=ur10e", "watchdog_frequency:=10.0", f"silence_limit:={0.1 * SLOWNESS}")
    yield started
    started.stop()
    recover(simulator)


@pytest.fixture
def moving(driver, simulator, fresh_client):
    """A driver whose robot turns joint 0, a recorder, and the goal."""
    recorder = Recorder(simulator.address)
    try:
        make_ready(fresh_client, 60.0)
        goal = fresh_client.send(MoveJ, "move_j", joint_positions=[3.0, *HOME[1:]], speed=SPEED, acceleration=2.0)
        wait_for(lambda: recorder.speed() > 0.98 * SPEED, 60.0, f"motion; {driver.output()}")
        yield driver, recorder, goal
    finally:
        recorder.close()


def recover(simulator):
    simulator.control("stall_links", stalled=False)
    mode = simulator.state()["safety_mode"]
    if mode.endswith("EMERGENCY_STOP"):
        simulator.control("emergency_stop", pressed=False)
    elif mode == "SAFEGUARD_STOP":
        simulator.control("safeguard", open=False)
    elif mode == "PROTECTIVE_STOP":
        wait_for(simulator.unlock_protective_stop, 60.0, "the protective stop to be unlocked")
    wait_for(lambda: simulator.state()["safety_mode"] == "NORMAL", 60.0, "a normal safety mode")
    simulator.control("stop_program")
    simulator.control("power", to="running")


EVENTS = {"cancel": lambda driver, client, simulator, goal: goal.cancel(),
          "stop": lambda driver, client, simulator, goal: client.send(Stop, "stop").accepted,
          "driver killed": lambda driver, client, simulator, goal: driver.kill(),
          "driver suspended": lambda driver, client, simulator, goal: driver.pause(),
          "connections closed": lambda driver, client, simulator, goal: simulator.control("drop_links", clients="control"),
          "connections silent": lambda driver, client, simulator, goal: simulator.control("stall_links", clients="control"),
          "program stopped on the pendant": lambda driver, client, simulator, goal: simulator.control("stop_program"),
          "protective stop": lambda driver, client, simulator, goal: simulator.control("protective_stop", reason="test"),
          "safeguard stop": lambda driver, client, simulator, goal: simulator.control("safeguard"),
          "emergency stop": lambda driver, client, simulator, goal: simulator.control("emergency_stop")}


def limits():
    """Returns the limit of each event in docs/use/safety.md, s."""
    return {name: float(limit) for name, limit in re.findall(r"^\| ([\w ]+) \| [\d.]+ s \| ([\d.]+) s \|", PAGE.read_text(), re.M)}


@pytest.mark.parametrize("event", EVENTS)
def test_the_arm_stands_within_the_documented_time(event, moving, fresh_client, simulator):
    driver, recorder, goal = moving
    begin = recorder.time()
    EVENTS[event](driver, fresh_client, simulator, goal)
    duration = recorder.wait_for_standstill(begin)
    driver.resume()
    print(f"{event}: {duration:.3f} s")
    assert duration <= limits()[event]


def test_move_until_force_stops_within_a_few_cycles_of_the_contact(driver, fresh_client, simulator):
    make_ready(fresh_client, 60.0)
    simulator.control("place_surface", z=TABLE)
    try:
        goal = fresh_client.send(MoveUntilForce, "move_until_force", twist=Twist(linear=Vector3(z=-0.05)), threshold=20.0,
                                 deceleration=10.0, distance=0.3, timeout=15.0)
        result = goal.succeeded(60.0)
    finally:
        simulator.control("clear_surfaces")
    assert abs(result.measured.z) == pytest.approx(20.0, abs=15.0)
    # 20 N correspond to 1 mm at 20 kN/m. At 50 mm/s, three cycles add 0.3 mm and the deceleration 0.1 mm.
    assert TABLE - result.final_state.tcp_pose.position.z < 0.003
