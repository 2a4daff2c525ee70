"""Two robots at once, each in its namespace with its prefix."""

import pytest
from sensor_msgs.msg import JointState
from support import HOME, JOINTS, Client, Simulator, node, wait_for

from conftest import make_ready
from ur_ros_rtde_msgs.action import MoveJ


def test_two_robots_move_at_once_and_apart(addresses, processes):
    clients = {}
    try:
        for side, address in zip(("left", "right"), addresses):
            processes(Simulator(address))
            processes(node("driver", address, f"tf_prefix:={side}_", namespace=side))
            clients[side] = Client(side)
        states = {side: client.listen(JointState, "joint_states") for side, client in clients.items()}
        for client in clients.values():
            make_ready(client)
        goals = {side: client.send(MoveJ, "move_j", joint_positions=[angle, *HOME[1:]], speed=1.0)
                 for (side, client), angle in zip(clients.items(), (0.5, -0.5))}
        for goal in goals.values():
            goal.succeeded()
        for side, angle in (("left", 0.5), ("right", -0.5)):
            wait_for(lambda s=side: states[s], 10.0, "joint states")
            number = len(states[side])
            wait_for(lambda s=side, n=number: len(states[s]) > n, 10.0, "the next joint state")
            assert list(states[side][-1].name) == [f"{side}_{name}" for name in JOINTS]
            assert states[side][-1].position[0] == pytest.approx(angle, abs=0.01)
    finally:
        for client in clients.values():
            client.close()
