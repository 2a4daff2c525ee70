"""The stubs name every installed command with its types."""

import ast
import re

import pytest
from plugin_prefix import create_plugin_prefix, prepend_path
from ros_client import Client
from support import wait_for
from ur_ros_rtde import stubs
from ur_ros_rtde.commands import names
from ur_ros_rtde_cli import actions


def classes(file):
    tree = ast.parse(file.read_text())
    return {item.name: item for item in tree.body if isinstance(item, ast.ClassDef)}


def methods(definition):
    return {item.name: item for item in definition.body if isinstance(item, ast.FunctionDef)}


@pytest.fixture
def written(tmp_path):
    """Returns a function that writes the stubs and returns their classes."""

    def write():
        assert stubs.main(["--output", str(tmp_path / "commands.pyi")]) == 0
        return classes(tmp_path / "commands.pyi")

    return write


def test_the_stubs_have_every_command(written, capsys):
    found = written()
    commands = [name for name in names() if "/" not in name]
    dashboard = [name.partition("/")[2] for name in names() if name.startswith("dashboard/")]
    assert len(commands) > 80 and len(dashboard) > 30
    for group in ("Commands", "StartedCommands"):
        assert set(methods(found[group])) == {"__init__", *commands}
        assert set(methods(found[f"_{group}Dashboard"])) == set(dashboard)
    assert not capsys.readouterr().err


def test_a_method_has_types_and_documentation(written):
    found = written()
    move_j = methods(found["Commands"])["move_j"]
    assert {argument.arg: ast.unparse(argument.annotation) for argument in move_j.args.args[1:]} == {
        "joint_positions": "Numbers", "speed": "float", "acceleration": "float"}
    assert {argument.arg for argument in move_j.args.kwonlyargs} == {"on_progress", "result_timeout"}
    assert ast.unparse(move_j.returns) == "MoveJResult" and "Unit: rad/s." in ast.get_docstring(move_j)
    assert ast.unparse(methods(found["StartedCommands"])["move_j"].returns) == "Goal"


def test_every_type_is_defined(written):
    found = written()
    known = {*found, "Any", "Callable", "Connection", "Goal", "Mapping", "Message", "NDArray", "None", "Numbers", "Plugin", "Sequence",
             "bool", "dict", "float", "floating", "int", "object", "set", "str"}
    for definition in found.values():
        annotations = [item.annotation for item in ast.walk(definition) if isinstance(item, (ast.AnnAssign, ast.arg)) and item.annotation]
        annotations += [item.returns for item in ast.walk(definition) if isinstance(item, ast.FunctionDef)]
        for annotation in annotations:
            assert set(re.findall(r"[A-Za-z_]\w*", ast.unparse(annotation))) <= known, (definition.name, ast.unparse(annotation))


@pytest.fixture
def own_plugin(tmp_path, monkeypatch):
    """Returns a function that installs a plugin of a user in a prefix of its own."""

    def install(attributes):
        prefix = create_plugin_prefix(tmp_path / "prefix", "my_commands",
                                      f'<library path="x"><class name="wag" type="x::Wag" {attributes}/></library>')
        index = prefix / "share" / "ament_index" / "resource_index" / "rosidl_interfaces"
        index.mkdir(parents=True)
        (index / "my_commands").write_text("action/Wag.action\n")
        (prefix / "share" / "my_commands" / "action").mkdir(parents=True)
        (prefix / "share" / "my_commands" / "action" / "Wag.action").write_text(
            "# Wags.\n\n# Angle. Unit: rad.\nfloat64 angle 0.2\nmy_commands/Other other\n---\nbool success\n---\n")
        for name, value in prepend_path("AMENT_PREFIX_PATH", prefix).items():
            monkeypatch.setenv(name, value)

    return install


def test_an_own_command_is_in_the_stubs(own_plugin, written):
    own_plugin("")
    wag = methods(written()["Commands"])["wag"]
    assert ast.unparse(wag.args.args[1]) == "angle: float" and "Angle. Unit: rad." in ast.get_docstring(wag)


def test_the_type_of_a_command_is_that_in_plugins_xml(own_plugin, written):
    own_plugin('action="ur_ros_rtde_msgs/action/DashboardText"')
    assert ast.unparse(methods(written()["Commands"])["wag"].args.args[1]) == "text: str"


def test_a_command_of_unknown_type_is_reported(own_plugin, written, capsys):
    own_plugin('action="nobody_msgs/action/Wag"')
    assert "wag" not in methods(written()["Commands"])
    assert "without types, because plugins.xml does not name their action: wag" in capsys.readouterr().err


def test_a_folder_that_cannot_be_written_is_reported(tmp_path, capsys):
    assert stubs.main(["--output", str(tmp_path / "missing" / "commands.pyi")]) == 1
    assert "--output" in capsys.readouterr().err


def test_the_types_in_plugins_xml_are_those_of_the_driver(driver):
    """`driver` has all plugins: this module chooses none."""
    client = Client()
    try:
        expected = {f"/{name}": actions.type_of_plugin(name) for name in names()}
        wait_for(lambda: set(expected) <= set(actions.served(client.node)), 30.0, "all actions")
        assert actions.served(client.node) == expected
    finally:
        client.close()


