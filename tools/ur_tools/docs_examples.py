"""The example of a command in Python and in C++, from that for `ur call`."""

import json
from typing import Any, Dict, Iterator, List

from .docs_commands import Command

_WIDTH = 100
_POSE = [f"position.{axis}" for axis in "xyz"] + [f"orientation.{axis}" for axis in "xyzw"]
_CPP = """\
#include <{header}>

#include "goal_client.hpp"

int main(int argc, char ** argv)
{{
  return goal_client::run(argc, argv, [] {{
    using Action = {type};
    Action::Goal goal;
{assignments}\
    const auto node = std::make_shared<rclcpp::Node>("client");
    goal_client::GoalClient<Action> client(node, "{name}");
    const auto response = client.send(goal, std::chrono::seconds(60));
    return {status};
  }});
}}
"""


def _numbers(value: Dict[str, Any]) -> List[float]:
    """Returns the seven numbers of a pose. Empty for other values, and if one is missing."""
    parts = [(f"{part}.{axis}", number) for part, axes in value.items() if isinstance(axes, dict)
             for axis, number in axes.items()]
    return [number for _, number in parts] if [name for name, _ in parts] == _POSE else []


def _python_value(value: Any) -> str:
    if isinstance(value, dict) and _numbers(value):
        return str(_numbers(value))
    if isinstance(value, dict):
        return "{" + ", ".join(f'"{name}": {_python_value(item)}' for name, item in value.items()) + "}"
    if isinstance(value, list):
        separator = f",\n{' ' * 12}" if isinstance(value[0], dict) else ", "
        return "[" + separator.join(map(_python_value, value)) + "]"
    return json.dumps(value) if isinstance(value, str) else repr(value)


def python(command: Command) -> str:
    arguments = [f"{name}={_python_value(value)}" for name, value in command.goal.items()]
    call = f"    result = arm.{command.name.replace('/', '.')}"
    line = f"{call}({', '.join(arguments)})"
    if len(line) > _WIDTH:
        line = f"{call}(\n" + "".join(f"        {argument},\n" for argument in arguments) + "    )"
    return f"from ur_ros_rtde import Robot\n\nwith Robot() as arm:\n{line}\n"


def _assignments(target: str, value: Any) -> Iterator[str]:
    """Yields the statements that set a field of the goal."""
    if isinstance(value, dict):
        for name, item in value.items():
            yield from _assignments(f"{target}.{name}", item)
    elif isinstance(value, list) and isinstance(value[0], dict):
        yield f"{target}.resize({len(value)});"
        for index, item in enumerate(value):
            yield from _assignments(f"{target}[{index}]", item)
    else:
        values = json.dumps(value)  # as in C++, but for the brackets
        yield f"{target} = {'{' + values[1:-1] + '}' if isinstance(value, list) else values};"


def cpp(command: Command, header: str, has_success: bool) -> str:
    """`header`: of the interface, without folder and ending. `has_success`: the result has the fields that all commands of this project
    have."""
    package, folder, _ = command.type.split("/")
    return _CPP.format(
        header=f"{package}/{folder}/{header}.hpp", type=command.type.replace("/", "::"), name=command.name,
        assignments="".join(f"    {line}\n" for line in _assignments("goal", command.goal)),
        status="goal_client::report(response)" if has_success else "response.result->error_code")
