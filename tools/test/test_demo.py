"""./ur demo without the build step: pushes are ignored, contact stops the arm, and both files are written."""

import csv
import os
import re
import subprocess
import sys

from ur_tools import packages
from ur_tools.demo import packages as packages_of_demo
from ur_tools.demo import parse
from ur_tools.environment import program, workspace_environment
from ur_tools.layout import ROOT, Layout

for folder in ("demo", "ur_ros_rtde_commands/test/system"):
    sys.path.insert(0, str(ROOT / folder))

from control_port import ControlPort  # noqa: E402
from programs import Process  # noqa: E402

MEASURES_TIME = True
PNG = b"\x89PNG\r\n\x1a\n"
COMMAND = [sys.executable, "-u", "-m", "ur_tools.demo"]


def environment():
    return {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT / "tools"), os.environ.get("PYTHONPATH", "")])}


def demo(*arguments):
    return subprocess.run([*COMMAND, *arguments], env=environment(), capture_output=True, text=True, timeout=120)


def robot_log(address):
    with ControlPort(address) as control:
        entries = control.request("log")["entries"]
    return "\n".join(f"{entry['timestamp']:.3f} {entry['source']}: {entry['text']}" for entry in entries[-40:])


def first_motions():
    section = (ROOT / "README.md").read_text().split("## First motions")[1]
    return [line.split("  #")[0].strip() for line in re.search(r"```bash\n(.*?)```", section, re.S)[1].splitlines()]


def test_ignores_two_pushes_and_stops_on_contact(tmp_path):
    folder = tmp_path / "new"
    result = demo("--address", os.environ.get("UR_TEST_ADDRESS", "127.0.1.201"), "--drop", "0.2", "--speed", "0.15",
                  "--output", str(folder))
    assert result.returncode == 0, result.stdout + result.stderr
    assert result.stdout.count("ignored: ") == 2
    assert "success (0)" in result.stdout and "while the arm decelerated" in result.stdout
    recorded, of_driver, of_result = (float(re.search(rf"{text} (-?[\d.]+) N", result.stdout)[1])
                                      for text in ("stop:      ", "the driver, .*, stopped at", "stopped by"))
    assert of_driver == of_result and min(abs(recorded), abs(of_driver)) >= 20.0
    assert (folder / "force_experiment.png").read_bytes().startswith(PNG)
    with (folder / "force_experiment.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["event"] for row in rows if row["event"]] == ["ignored x", "ignored y", "stop z"]
    assert max(abs(float(rows[-1][f"actual_qd_{joint}"])) for joint in range(6)) < 0.01


def test_the_first_motions_of_the_readme_work_while_the_demo_keeps_running(tmp_path):
    address = os.environ.get("UR_TEST_ADDRESS", "127.0.1.201")
    shell = {**os.environ, **workspace_environment(Layout.of_environment())}
    running = Process([*COMMAND, "--address", address, "--keep-running", "--output", tmp_path], environment())
    try:
        running.wait_for_output("run until Ctrl-C", 120.0)
        lines = first_motions()
        assert len(lines) == 6
        for line in lines:
            done = subprocess.run(["bash", "-c", line], cwd=ROOT, env=shell, capture_output=True, text=True, timeout=60)
            assert done.returncode == 0, f"{line}\n{done.stdout}{done.stderr}\n{robot_log(address)}"
    finally:
        running.interrupt()
        code = running.wait(30.0)
    assert code == 130


def test_another_simulator_on_the_address_is_not_used(tmp_path):
    address = os.environ.get("UR_TEST_ADDRESS", "127.0.1.201")
    simulator = Process([program(Layout.of_environment(), "ur_simulator", "ur_simulator"), "--address", address])
    try:
        simulator.wait_for_output("ready: ", 20.0)
        result = demo("--address", address, "--output", str(tmp_path))
        assert result.returncode == 1
        assert f"of {address}: in use by process" in result.stdout and "ur_simulator" in result.stdout
        assert "Starting" not in result.stdout and list(tmp_path.iterdir()) == []
    finally:
        simulator.interrupt()
        simulator.wait(20.0)


def test_beside_another_driver_in_the_same_network_it_says_how_to_separate_them(tmp_path):
    address = os.environ.get("UR_TEST_ADDRESS", "127.0.1.201")
    layout = Layout.of_environment()
    driver = Process([program(layout, "ur_ros_rtde", "robot_state_receiver"), "--ros-args", "-p", f"robot_ip:={address}"],
                     {**os.environ, **workspace_environment(layout)})
    try:
        driver.wait_for_output("robot_state_receiver", 20.0)
        result = demo("--address", address, "--output", str(tmp_path))
    finally:
        driver.interrupt()
        driver.wait(20.0)
    assert result.returncode == 1
    assert "/robot_state_receiver is already running" in result.stdout and "ROS_DOMAIN_ID" in result.stdout
    assert "Traceback" not in result.stdout + result.stderr


def test_the_packages_that_the_demo_imports_are_built():
    built = packages.with_dependencies(packages.discover(), packages_of_demo(parse([])))
    used = set()
    for file in (ROOT / "demo").glob("*.py"):
        used.update(re.findall(r"^from (\w+)\.(?:action|msg|srv) import", file.read_text(), re.M))
    assert "ur_ros_rtde_tutorials" in used
    assert used & set(packages.discover()) <= set(built)
    assert not {"ur_ros_rtde_gripper_commands", "ur_ros_rtde_commands"} & set(built)
    assert "ur_ros_rtde_commands" in packages_of_demo(parse(["--keep-running"]))


def test_only_a_demo_with_the_page_builds_the_viewer_and_it_keeps_running():
    assert "ur_ros_rtde_viewer" not in packages_of_demo(parse(["--keep-running"]))
    options = parse(["--view"])
    assert options.keep_running and {"ur_ros_rtde_viewer", "ur_ros_rtde_commands"} <= set(packages_of_demo(options))


