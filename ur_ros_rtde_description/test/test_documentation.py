"""The commands and names in docs/use/description.md are valid."""

import argparse
import pathlib
import re
import shlex

from helpers import calibration, write_calibration
from ur_ros_rtde_description.arguments import add_arguments
from ur_ros_rtde_description.kinematics import nominal_origins
from ur_ros_rtde_description.launch_arguments import check_names
from ur_ros_rtde_description.models import find_model
from ur_ros_rtde_description.program import describe
from ur_ros_rtde_description.urdf import FIXED_JOINTS, FRAMES

BACKGROUND = True
PAGE = (pathlib.Path(__file__).resolve().parents[2] / "docs" / "use" / "description.md").read_text()
COMMANDS = re.findall(r"^(?:ur|ros2 run ur_ros_rtde_description) urdf (.*)$", PAGE, re.M) + re.findall(r"`ur urdf ([^`]+)`", PAGE)


def parser():
    result = argparse.ArgumentParser()
    add_arguments(result)
    return result


def test_the_commands_print_a_description(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    commands = [command for command in COMMANDS if command != "--help"]
    assert len(commands) >= 5
    for command in commands:
        options = parser().parse_args(shlex.split(command.split(">")[0]))
        file = write_calibration(tmp_path, calibration(nominal_origins(find_model(options.model))))
        pathlib.Path(file).rename("my_robot.yaml")
        assert describe(options).startswith("<?xml"), command


def test_the_options_exist():
    known = parser().format_help()
    options = set(re.findall(r"`(--[a-z-]+)", PAGE)) - {"--help"}
    assert len(options) >= 9 and all(option in known for option in options)


def test_every_frame_and_fixed_joint_is_described():
    section = PAGE.split("## Frames")[1].split("\n## ")[0]
    assert set(FRAMES) - set(re.findall(r"^\| `(\w+)`", section, re.M)) == set()
    assert [name for name in FIXED_JOINTS if f"`{name}`" not in section] == []


def test_the_launch_arguments_exist():
    section = PAGE.split("## View the arm")[1].split("\n## ")[0]
    used = re.findall(r"(\w+):=", re.sub(r"ros2 launch ur_ros_rtde driver.*", "", section))
    assert {"ur_type", "meshes", "launch_rviz"} <= set(used)
    check_names(used)


def test_the_python_example_runs():
    example = re.search(r"```python\n(.*?)```", PAGE, re.S).group(1)
    names = {}
    exec(example, names)
    assert 'name="left_tool0"' in names["robot_description"]
