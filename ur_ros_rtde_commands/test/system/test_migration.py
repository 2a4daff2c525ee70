"""Each name in the second columns of docs/use/migration.md exists in a running driver, as what its table says it is.

The goals of the actions are tried by test_good_goals.py, which sends the documented example of each one.
"""

import pathlib
import re

import pytest
import rclpy.action
from programs import start_node
from rcl_interfaces.srv import ListParameters
from support import wait_for
from ur_ros_rtde_launch.launch_arguments import DRIVER, MOVEIT

from ur_ros_rtde_msgs.action import ServoJ

PAGE = (pathlib.Path(__file__).resolve().parents[3] / "docs" / "use" / "migration.md").read_text()
NODES = ("command_server", "dashboard_server", "robot_state_receiver")
LAUNCH_FILES = pathlib.Path(__file__).resolve().parents[3] / "ur_ros_rtde" / "launch"
GOAL_FIELDS = {"gain", "lookahead_time"}  # "fields `gain` and `lookahead_time` of the goals"


def rows(system, table):
    """Returns the cells of the rows of a table: the names of both sides."""
    text = PAGE.split(f"\n## {system}\n")[1].split("\n## ")[0].split(f"\n### {table}\n")[1].split("\n###")[0]
    lines = [line.strip("|").split(" | ") for line in text.splitlines() if line.startswith("| ")]
    return [tuple(re.findall(r"`([^`]+)`", cell) for cell in cells[:2]) for cells in lines[1:]]


ACTIONS = rows("From the published ur_ros_rtde", "Actions")
PUBLISHED = rows("From the published ur_ros_rtde", "Topics, services and parameters")
LAUNCH = rows("From ur_robot_driver", "Launch arguments")
UR_ROBOT_DRIVER = rows("From ur_robot_driver", "Topics, services and actions")


@pytest.fixture(scope="module")
def interfaces(simulator, client):
    """The actions, topics, services and parameters of a running driver with all plugins."""
    driver = start_node("driver", simulator.address)
    try:
        def actions():
            return {name.lstrip("/") for name, _ in rclpy.action.get_action_names_and_types(client.node)}

        wanted = {name for names in ACTIONS for name in names[1]}
        wait_for(lambda: wanted <= actions(), 30.0, "the actions of the driver")
        wait_for(lambda: client.node.count_subscribers("/twist") > 0, 30.0, "the topics to which the driver listens")
        topics = {name.lstrip("/") for name, _ in client.node.get_topic_names_and_types()}
        services = {name.lstrip("/") for name, _ in client.node.get_service_names_and_types()}
        parameters = {name for node in NODES for name in client.call(ListParameters, f"{node}/list_parameters").result.names}
        yield {"actions": actions(), "topics": topics, "services": services, "parameters": parameters,
               "launch arguments": {argument.name for argument in (*DRIVER, *MOVEIT)},
               "launch files": {file.name for file in LAUNCH_FILES.glob("*.launch.py")}, "fields": GOAL_FIELDS}
    finally:
        driver.stop()
        print(driver.output())


def missing(interfaces, names, *kinds):
    known = set().union(*(interfaces[kind] for kind in kinds))
    return {name.split(":=")[0] for name in names} - known


def test_everything_of_the_published_package_has_its_counterpart(interfaces):
    assert len(ACTIONS) == 47 and len(PUBLISHED) > 10
    for old, new in ACTIONS:
        assert new and not missing(interfaces, new, "actions"), old
    for old, new in PUBLISHED:
        kinds = ("topics",) if old and old[0].startswith("/") else ("services", "parameters", "launch arguments", "fields")
        assert new and not missing(interfaces, new, *kinds), old


def test_the_counterparts_in_ur_robot_driver_exist(interfaces):
    assert len(LAUNCH) > 15 and len(UR_ROBOT_DRIVER) > 25
    for old, new in LAUNCH:
        assert old and not missing(interfaces, new, "launch arguments", "launch files", "actions"), old
    for old, new in UR_ROBOT_DRIVER:
        assert old and not missing(interfaces, new, "actions", "topics", "services"), old


def test_the_servo_gains_are_fields_of_the_goals():
    assert GOAL_FIELDS <= set(ServoJ.Goal.get_fields_and_field_types())
