"""`ur call`, the Python module and a C++ compiler accept the examples of the generated reference."""

import pathlib
import re
import shlex
import shutil
import subprocess
import types

import pytest
import ur_ros_rtde
from ur_ros_rtde import commands as python_commands
from ur_ros_rtde_cli import actions, fields, interface_files
from ur_ros_rtde_cli.main import _parse_arguments
from ur_tools import docs_commands, docs_examples
from ur_tools.layout import ROOT

BACKGROUND = True
PAGES = sorted((ROOT / "docs" / "use" / "commands").glob("*.md"))
COMMANDS = [command for page in PAGES for command in docs_commands.of_page(page.read_text())]
# What an example needs of examples/cpp/goal_client.hpp, without rclcpp.
GOAL_CLIENT = """
#include <chrono>
#include <functional>
#include <memory>
#include <string>
namespace rclcpp { struct Node { explicit Node(const std::string &) {} }; }
namespace goal_client {
template <typename Action> struct Response { std::shared_ptr<typename Action::Result> result; };
template <typename Action> struct GoalClient {
  GoalClient(std::shared_ptr<rclcpp::Node>, const std::string &) {}
  Response<Action> send(const typename Action::Goal &, std::chrono::seconds) { return {}; }
};
template <typename R> int report(const R & response) { return response.result->success ? 0 : response.result->error_code; }
int run(int, char **, std::function<int()> example) { return example(); }
}
"""


class Recorded:
    """Takes the place of a Goal: keeps its message instead of sending it."""

    messages = []

    def __init__(self, _connection, name, message, _on_finished):
        self.messages.append((name, message))

    def send(self):
        return self

    def result(self, _timeout, _on_progress):
        return None


class Robot(python_commands.Commands):
    def __init__(self):
        super().__init__(types.SimpleNamespace(result_timeout=1.0), set())

    def __enter__(self):
        return self

    def __exit__(self, *_):
        return None


def goal_of_call(command):
    """Returns the goal that `ur call` would send."""
    program, name, *arguments = shlex.split(command.call.replace("\\\n", " "))
    options = _parse_arguments(name, arguments)
    assert (program, options.action) == ("ur", command.name)
    return fields.Document(options.goal or "{}").fill(actions.load(command.name, command.type).Goal())


def test_there_is_an_example_of_each_action():
    assert len(COMMANDS) > 130 and len({command.name for command in COMMANDS}) == len(COMMANDS)
    files = {f"{file.parent.parent.name}/action/{file.stem}" for file in ROOT.glob("*/action/*.action")}
    assert files - {command.type for command in COMMANDS} == set()


@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: command.name)
def test_the_example_in_python_sends_the_goal_of_ur_call(command, monkeypatch):
    monkeypatch.setattr(ur_ros_rtde, "Robot", Robot)
    monkeypatch.setattr(python_commands, "Goal", Recorded)
    monkeypatch.setattr(Recorded, "messages", [])
    exec(docs_examples.python(command), {})
    assert Recorded.messages == [(command.name, goal_of_call(command))]


def test_the_examples_in_cpp_compile(tmp_path):
    """As functions of one file: each header is read once."""
    compiler = shutil.which("g++") or pytest.skip("there is no g++")
    texts = [docs_examples.cpp(command, interface_files.header_name(command.type.rpartition("/")[2]),
                               not command.type.startswith("control_msgs")) for command in COMMANDS]
    includes = sorted({line for text in texts for line in text.splitlines() if line.startswith("#include")})
    bodies = [re.sub(r"^#include.*\n", "", text, flags=re.M).replace(" main(", f" main_{number}(") for number, text in enumerate(texts)]
    (tmp_path / "goal_client.hpp").write_text(GOAL_CLIENT)
    (tmp_path / "examples.cpp").write_text("\n".join([*includes, *bodies]))
    folders = [tmp_path, *(folder for prefix in interface_files.prefixes() for folder in pathlib.Path(prefix, "include").glob("*"))]
    result = subprocess.run([compiler, "-std=c++20", "-fsyntax-only", *(f"-I{folder}" for folder in folders),
                             str(tmp_path / "examples.cpp")], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr[-4000:]
