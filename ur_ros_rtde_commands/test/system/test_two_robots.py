"""Two robots in separate namespaces with prefixes, and several state receivers on one robot."""

import time

import pytest
from programs import Simulator, start_node
from robot_fixtures import make_ready
from ros_client import Client
from sensor_msgs.msg import JointState
from support import FEW_PLUGINS, HOME, JOINTS, seconds, wait_for

from ur_ros_rtde_msgs.action import MoveJ

PLUGINS = FEW_PLUGINS
RECEIVERS = 10
LIMIT = 60.0  # s, allows for a busy machine


def test_two_robots_move_independently_at_the_same_time(addresses, processes):
    clients = {}
    try:
        for side, address in zip(("left", "right"), addresses):
            processes(Simulator(address))
            processes(start_node("driver", address, FEW_PLUGINS, f"tf_prefix:={side}_", namespace=side))
            clients[side] = Client(side)
        states = {side: client.subscribe(JointState, "joint_states") for side, client in clients.items()}
        for client in clients.values():
            make_ready(client)
        goals = {side: client.send(MoveJ, "move_j", joint_positions=[angle, *HOME[1:]], speed=1.0)
                 for (side, client), angle in zip(clients.items(), (0.5, -0.5))}
        for goal in goals.values():
            goal.succeeded()
        for side, angle in (("left", 0.5), ("right", -0.5)):
            wait_for(lambda s=side, a=angle: states[s] and states[s][-1].position[0] == pytest.approx(a, abs=0.01), LIMIT,
                     f"the {side} arm's state at {angle} rad")
            assert list(states[side][-1].name) == [f"{side}_{name}" for name in JOINTS]
    finally:
        for client in clients.values():
            client.close()


def connections(simulator):
    """Returns the permanent connections by port. The driver opens short connections to the dashboard as well."""
    return {port: number for port, number in simulator.state()["clients"].items() if port != "dashboard"}


def test_ten_state_receivers_on_one_robot_publish_the_same_motion(simulator, driver, client, processes):
    for number in range(RECEIVERS):
        processes(start_node("robot_state_receiver", simulator.address, "rtde_frequency:=20.0", namespace=f"watcher_{number}"))
    make_ready(client)
    states = [client.subscribe(JointState, f"/watcher_{number}/joint_states") for number in range(RECEIVERS)]
    wait_for(lambda: all(states), LIMIT, "joint states of all receivers")
    before = connections(simulator)
    client.send(MoveJ, "move_j", joint_positions=[0.5, *HOME[1:]], speed=1.0).succeeded()
    assert connections(simulator) == before, "a receiver lost its connection"
    end = time.time()
    wait_for(lambda: all(seconds(messages[-1].header.stamp) > end for messages in states),
             LIMIT, "a state after the motion from each receiver")
    for messages in states:
        assert messages[-1].position[0] == pytest.approx(0.5, abs=0.005)
        assert max(state.position[0] for state in list(messages)) > min(state.position[0] for state in list(messages)) + 0.4
