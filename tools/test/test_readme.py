"""What the README names exists, and its commands are understood. The examples it runs are run by ur_ros_rtde_tutorials' tests."""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text()
LAUNCH = (ROOT / "ur_ros_rtde" / "launch" / "driver.launch.py").read_text()


def blocks():
    return re.findall(r"```bash\n(.*?)```", README, re.S)


def test_every_link_leads_to_a_file():
    for target in re.findall(r"\]\(([^)#]+)\)", README):
        assert (ROOT / target).exists(), target


def test_every_file_in_a_command_exists():
    for block in blocks():
        for path in re.findall(r"python3 (\S+)", block):
            assert (ROOT / path).is_file(), path


def test_every_command_of_ur_is_known():
    for command in set(re.findall(r"\./ur (\w+)", README)):
        result = subprocess.run([sys.executable, str(ROOT / "ur"), command, "--help"], capture_output=True, text=True,
                                timeout=60)
        assert result.returncode == 0, (command, result.stderr)


def test_the_launch_arguments_are_declared():
    line = next(line for block in blocks() for line in block.splitlines() if "ros2 launch" in line)
    for argument in re.findall(r"(\w+):=", line):
        assert re.search(rf"['\"]{argument}['\"]", LAUNCH), argument


def test_the_launch_file_knows_the_models_of_the_driver():
    table = (ROOT / "ur_ros_rtde" / "src" / "robot" / "arm_limits.cpp").read_text()
    models = re.search(r"^MODELS = \[(.*)\]", LAUNCH, re.M).group(1)
    assert re.findall(r'"(\w+)"', models) == re.findall(r'Model\{"(\w+)"', table)


def test_the_launch_file_starts_the_simulator_without_arguments_of_ros():
    assert not re.search(r'Node\(package="ur_simulator"', LAUNCH)
    assert 'ExecutableInPackage(package="ur_simulator", executable="ur_simulator")' in LAUNCH


def test_the_goal_sent_by_ros2_fits_its_action():
    line = next(line for block in blocks() for line in block.splitlines() if "send_goal" in line)
    name, fields = re.search(r"ur_ros_rtde_msgs/action/(\w+) \"\{(.*)\}\"", line).groups()
    goal = (ROOT / "ur_ros_rtde_msgs" / "action" / f"{name}.action").read_text().split("---")[0]
    for field in re.findall(r"(\w+):", fields):
        assert re.search(rf"^\S+ {field}\b", goal, re.M), field
