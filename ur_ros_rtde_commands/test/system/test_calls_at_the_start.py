"""Other commands may call a command as soon as the first action server exists. The commands are those of test/plugins."""

from plugin_prefix import driver_of_test_commands
from support import wait_for

from ur_ros_rtde_msgs.action import SendScript


def call(client):
    """Returns the goal if it was accepted."""
    goal = client.send(SendScript, "calls_one_that_starts_late", script="x")
    return goal if goal.accepted else None


def test_a_command_is_found_that_starts_after_its_caller(simulator, client, tmp_path):
    with driver_of_test_commands(simulator, tmp_path, "calls_one_that_starts_late", "starts_late"):
        wait_for(lambda: call(client), 20.0, "the driver to be connected").succeeded(20.0)
