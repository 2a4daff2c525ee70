"""Checks that `ur` imports only the message types that it uses."""

import subprocess
import sys

import pytest

FIND_ALL = """
import re
from ament_index_python import get_resource
from ur_ros_rtde_cli import lazy_imports
lazy_imports.enable()
import ur_ros_rtde_msgs.action
import ur_ros_rtde_msgs.msg
for kind, name in set(re.findall(r"^(action|msg)/(\\w+)\\.idl$", get_resource("rosidl_interfaces", "ur_ros_rtde_msgs")[0], re.M)):
    found = getattr(getattr(ur_ros_rtde_msgs, kind), name)
    assert found.__name__ == name, (found, name)
    if kind == "action":
        found.Goal(), found.Result(), found.Feedback()
try:
    from ur_ros_rtde_msgs.action import MoveX
except ImportError:
    print("all found")
"""
IMPORTED = """
import sys
from ur_ros_rtde_cli.main import main
try:
    main(["call", "move_j", "--wait", "0.1"])
finally:
    print(*sys.modules)
"""


def run(code):
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert result.returncode == 0, result.stderr
    return result.stdout


def test_finds_every_type():
    assert run(FIND_ALL).strip() == "all found"


@pytest.fixture(scope="module")
def modules():
    return set(run(IMPORTED).split())


def test_a_call_imports_its_own_action(modules):
    assert "ur_ros_rtde_msgs.action._move_j" in modules


@pytest.mark.parametrize("module", [
    "ur_ros_rtde_msgs.action._move_l", "ur_ros_rtde_msgs.msg._robot_state", "sensor_msgs.msg", "lark", "em"])
def test_a_call_does_not_import_unused_modules(modules, module):
    assert module not in modules
