"""Files and commands in README.md and CONTRIBUTING.md exist. The tests of ur_ros_rtde_tutorials run the examples."""

import pathlib
import re
import shlex
import subprocess
import sys

import pytest
from ur_ros_rtde.launch_arguments import DRIVER, MODELS, MOVEIT, TWO_ROBOTS, check_name, to_values
from ur_tools import main, packages, selection, simulation
from ur_tools.environment import program
from ur_tools.layout import Layout

BACKGROUND = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text()
CONTRIBUTING = (ROOT / "CONTRIBUTING.md").read_text()
LAUNCH_FILES = {"driver": DRIVER, "two_robots": (*TWO_ROBOTS, *DRIVER), "moveit": (*MOVEIT, *DRIVER)}


def blocks():
    return re.findall(r"```bash\n(.*?)```", README, re.S)


@pytest.mark.parametrize("text", [README, CONTRIBUTING], ids=["README", "CONTRIBUTING"])
def test_every_link_refers_to_an_existing_file(text):
    targets = re.findall(r"\]\(([^)#]+)\)", text)
    assert targets
    for target in targets:
        assert (ROOT / target).exists(), target


def test_every_file_in_a_command_exists():
    for block in blocks():
        for path in re.findall(r"python3 (\S+)", block):
            assert (ROOT / path).is_file(), path


@pytest.mark.parametrize("document", [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))], ids=lambda file: file.stem)
def test_every_command_of_ur_is_known(document):
    """Finds `./ur …` anywhere, and `ur …` at the beginning of a line or of code."""
    for command in set(re.findall(r"(?:\./ur |^ur |`ur )([a-z]+)\b", document.read_text(), re.M)):
        result = subprocess.run([sys.executable, str(ROOT / "ur"), command, "--help"], capture_output=True, text=True,
                                timeout=300)
        assert result.returncode == 0, (command, result.stderr)


def test_the_options_of_the_contributors_commands_are_known():
    lines = re.findall(r"^\./ur (.*?)(?: *#.*)?$", CONTRIBUTING, re.M)
    assert len(lines) >= 8
    for line in lines:
        main._parse(line.split())  # exits with an unknown one


def test_the_names_in_the_examples_of_ur_test_select_tests():
    found = packages.discover(ROOT)
    examples = re.findall(r"^\./ur test (\w[\w ]*?) *(?:#.*)?$", CONTRIBUTING, re.M)
    assert len(examples) >= 2
    for words in examples:
        selection.by_name(words.split(), found)  # raises an error for an unknown name


def test_contributing_lists_every_package_folder():
    for package in packages.discover(ROOT).values():
        assert f"`{package.folder.name}`" in CONTRIBUTING, package.name


def test_the_goal_of_each_ur_call_matches_its_action():
    calls = [shlex.split(line, comments=True) for block in blocks() for line in block.splitlines() if line.startswith("ur call")]
    assert calls
    for _, call, *arguments in calls:
        result = subprocess.run([str(program(Layout.of_environment(), "ur_ros_rtde_cli", "ur")), call, *arguments, "--show"],
                                capture_output=True, text=True, timeout=300)
        assert result.returncode == 0, (arguments, result.stderr)


def test_the_launch_arguments_are_declared():
    for document in (README, *(file.read_text() for file in sorted((ROOT / "docs").rglob("*.md")))):
        for launch_file, arguments in re.findall(r"ros2 launch ur_ros_rtde (\w+)\.launch\.py(.*)", document):
            assert (ROOT / "ur_ros_rtde" / "launch" / f"{launch_file}.launch.py").is_file(), launch_file
            for name, text in re.findall(r"(\w+):=(\S+)", arguments):
                if "<" not in text:
                    to_values(LAUNCH_FILES[launch_file], {name: text.strip("`,.;)")})
                check_name(name, [argument.name for argument in LAUNCH_FILES[launch_file]], f"{launch_file}.launch.py")


def test_launch_file_and_driver_have_the_same_models():
    table = (ROOT / "ur_ros_rtde_trajectory" / "src" / "kinematics" / "arm_limits.cpp").read_text()
    assert list(MODELS) == re.findall(r'Model\{"(\w+)"', table)
    assert MODELS == simulation.MODELS


def test_the_installation_with_ros_is_complete():
    """The steps must be in this order, because each one requires the previous ones."""
    block = next(block for block in blocks() if "colcon build" in block)
    steps = ["source /opt/ros/", "mkdir -p ~/ros2_ws/src && cd ~/ros2_ws", "git clone <this repository> src/",
             "rosdep install --from-paths src --ignore-src -y", "colcon build", "source install/setup.bash", "ros2 launch"]
    assert [step for step in steps if step in block] == steps
    assert sorted(steps, key=block.index) == steps


def test_every_program_that_ros2_run_starts_is_installed():
    for package, name in re.findall(r"ros2 run (\w+) ([\w.]+)", README):
        assert name in (ROOT / package / "CMakeLists.txt").read_text(), name


def test_the_goal_sent_by_ros2_matches_its_action():
    line = next(line for block in blocks() for line in block.splitlines() if "send_goal" in line)
    name, fields = re.search(r"ur_ros_rtde_msgs/action/(\w+) \"\{(.*)\}\"", line).groups()
    goal = (ROOT / "ur_ros_rtde_msgs" / "action" / f"{name}.action").read_text().split("---")[0]
    for field in re.findall(r"(\w+):", fields):
        assert re.search(rf"^\S+ {field}\b", goal, re.M), field
