"""Each command has a section with a valid example, and each field of the actions has a comment."""

import re

import action_files
import documentation
import messages
import plugins
import pytest
import rclpy.action
import ur_rtde_headers
from own_domain import Domain
from programs import start_node
from ros_client import Client
from support import wait_for

PLUGINS = plugins.find()
UNIT = re.compile(r"\d|[A-Z]{3,} or |\b(rad|m|s|N|Nm|Hz|kg|V|A)\b|see |index|whole|by rows")


def action_file_paths():
    """Returns the .action files of ur_ros_rtde_msgs and of all packages with plugins."""
    packages = {"ur_ros_rtde_msgs", *(plugin.package for plugin in PLUGINS.values())}
    return action_files.paths(packages)


@pytest.fixture(scope="module")
def types():
    """Types of the actions that the driver serves. The driver does not need a robot for this."""
    domain = Domain()
    driver = start_node("driver", "127.0.0.1", env={"ROS_DOMAIN_ID": str(domain.number)})
    client = Client(domain=domain.number)
    try:
        def served():
            return {name.lstrip("/"): kinds[0] for name, kinds in rclpy.action.get_action_names_and_types(client.node)}

        wait_for(lambda: set(PLUGINS) <= set(served()), 20.0, f"all actions; {driver.output()}")
        yield served()
    finally:
        client.close()
        driver.stop()
        domain.close()


def test_each_command_has_one_section_with_an_example_of_its_type(types):
    sections = documentation.sections()
    assert PLUGINS and sorted(section.name for section in sections) == sorted(PLUGINS)
    for section in sections:
        example = section.example()
        assert example.type == types[section.name], section.name
        messages.fill(messages.load(example.type).Goal(), example.goal)


def test_each_action_file_describes_the_action_and_its_fields():
    for file in action_file_paths():
        assert file.read_text().startswith("# "), f"{file} must begin with a description of the action"
        goal, result, feedback = action_files.parse(file)
        for field in goal:
            assert field.comment or field.type == "bool", f"{file}: {field.name} has no comment"
            assert not field.numeric or UNIT.search(field.comment), f"{file}: {field.name}: '{field.comment}' has no unit and no range"
        assert [field.name for field in result[:3]] == ["success", "error_code", "message"], file
        has_unit_field = {"unit", "text"} & {field.name for field in result}  # describes the number
        for field in [*result, *feedback]:
            if field.numeric and not has_unit_field:
                assert field.comment or field.name == "value", f"{file}: {field.name} has no comment"


def test_each_function_of_ur_rtde_is_an_action_or_excluded_with_a_reason():
    for interface in ur_rtde_headers.HEADERS:
        functions = ur_rtde_headers.functions(interface)
        assert len(functions) > 5
        missing = ur_rtde_headers.uncovered(functions, set(PLUGINS), documentation.INDEX.read_text())
        assert not missing, f"{len(missing)} of {len(functions)} functions of {interface} are neither an action nor excluded: " \
            + ", ".join(missing)


def test_converts_function_names_to_action_names():
    names = {"moveJ_IK": "move_j_ik", "getTCPOffset": "get_tcp_offset", "setTcp": "set_tcp", "powerOn": "power_on",
             "PolyscopeVersion": "polyscope_version", "robotmode": "robotmode"}
    assert {name: ur_rtde_headers.snake_case(name) for name in names} == names


def test_reads_covered_and_excluded_functions_from_the_index():
    index = "| action | ur_rtde | |\n|---|---|---|\n| `stop_l` | `stopL` | x |\n| `disconnect` | the driver's |\n| `reconnect` | |\n"
    assert ur_rtde_headers.uncovered(["stopL", "moveJ", "disconnect", "reconnect", "jogStart"], {"stop_l", "move_j"}, index) == [
        "reconnect", "jogStart"]
