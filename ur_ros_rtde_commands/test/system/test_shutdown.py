"""Ctrl-C on a launch file reaches driver and simulator at the same time. Ctrl-C on the driver alone leaves the robot running."""

import re

import pytest
from action_msgs.msg import GoalStatus
from programs import Simulator, start_node
from robot_fixtures import make_ready
from ros_client import Client
from support import FEW_PLUGINS, HOME, wait_for

from ur_ros_rtde_msgs.action import MoveJ

LOG_LINE = re.compile(r"\[(?P<level>[A-Z]+)\] \[\d+\.\d+\] \[[\w.]+\]: ")
ONE_PROCESS = {"driver": [FEW_PLUGINS]}
THREE_PROCESSES = {"robot_state_receiver": [], "command_server": [FEW_PLUGINS], "dashboard_server": []}


class Cell:
    """A simulator, its nodes and a client in a separate namespace."""

    def __init__(self, address, parameters):
        """`parameters`: those of each node."""
        self.simulator = Simulator(address)
        self.nodes = [start_node(name, address, *values, namespace="quiet") for name, values in parameters.items()]
        self.client = Client("quiet")

    def interrupt(self, with_simulator):
        """Interrupts the nodes, waits until they exit, and returns what they printed in between."""
        counts = [len(process.lines) for process in self.nodes]
        for process in [self.simulator.process] * with_simulator + self.nodes:
            process.interrupt()
        for process in self.nodes:
            assert process.wait(15.0) == 0, process.output()
        return [line for process, count in zip(self.nodes, counts) for line in process.lines[count:]]

    def stop(self):
        self.client.close()
        for process in self.nodes:
            process.stop()
        self.simulator.stop()


@pytest.fixture(params=[ONE_PROCESS, THREE_PROCESSES], ids=["one process", "three processes"])
def cell(request, addresses):
    cell = Cell(addresses[1], request.param)
    yield cell
    cell.stop()
    print("\n".join(line for process in cell.nodes for line in process.lines))


def find_failures(lines):
    matches = [(LOG_LINE.match(line), line) for line in lines]
    return [line for match, line in matches if match is None or match["level"] not in ("DEBUG", "INFO")]


@pytest.mark.parametrize("with_simulator", [True, False], ids=["with the simulator", "alone"])
def test_ctrl_c_after_a_motion_prints_no_warnings_or_errors(cell, with_simulator):
    make_ready(cell.client)
    cell.client.send(MoveJ, "move_j", joint_positions=[0.2, *HOME[1:]], speed=1.0).succeeded()
    assert not find_failures(cell.interrupt(with_simulator))


def test_ctrl_c_during_a_motion_prints_no_warnings_or_errors(cell):
    make_ready(cell.client)
    goal = cell.client.send(MoveJ, "move_j", joint_positions=[2.5, *HOME[1:]], speed=0.5)
    wait_for(lambda: goal.feedback and goal.feedback[-1].motion.progress > 0.05, 10.0, "the motion")
    assert not goal.is_finished()  # requests the result while the server is available
    assert not find_failures(cell.interrupt(with_simulator=False))
    assert goal.wait_for_result()[0] == GoalStatus.STATUS_ABORTED
    assert cell.simulator.is_at_rest()


def test_ctrl_c_during_a_motion_warns_if_standstill_is_not_confirmed(cell):
    make_ready(cell.client)
    goal = cell.client.send(MoveJ, "move_j", joint_positions=[2.5, *HOME[1:]], speed=0.5)
    wait_for(lambda: goal.feedback and goal.feedback[-1].motion.progress > 0.05, 10.0, "the motion")
    failures = find_failures(cell.interrupt(with_simulator=True))
    assert all("[WARN]" in line for line in failures), failures
    assert any("standstill is not confirmed" in line for line in failures), failures
