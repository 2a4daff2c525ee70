"""Checks that `ur call` and `ros2 action send_goal` in docs/use/commands send the same goal, and that it fits the action."""

import importlib.util
import pathlib
import re
import shlex

import pytest
import yaml
from ur_ros_rtde_cli import fields

BACKGROUND = True
FOLDER = pathlib.Path(__file__).resolve().parents[2] / "docs" / "use" / "commands"


def examples():
    """Yields the commands of each code block with a ros2 command."""
    for file in sorted(FOLDER.glob("*.md")):
        for block in re.findall(r"^```bash\n(.*?)^```", file.read_text(), re.S | re.M):
            if "send_goal" in block:
                yield [shlex.split(command) for command in re.split(r"\n(?=ur |ros2 )", block.replace("\\\n", " ").strip())]


def test_ur_call_and_ros2_send_the_same_goal():
    found, not_installed = list(examples()), set()
    assert len(found) > 100
    for (_, call, name, *goal), (_, _, _, *ros2) in found:
        full_name, kind, ros2_goal = (word for word in ros2 if word != "--feedback")
        assert call == "call" and full_name == f"/{name}" and len(goal) <= 1
        assert yaml.safe_load(goal[0] if goal else "{}") == yaml.safe_load(ros2_goal), name
        package, _, short = kind.split("/")
        if importlib.util.find_spec(package) is None:
            not_installed.add(package)
            continue
        action = getattr(importlib.import_module(f"{package}.action"), short)
        fields.Document(goal[0] if goal else "{}").fill(action.Goal())
    if not_installed:
        pytest.skip(f"not installed: {', '.join(sorted(not_installed))}")
