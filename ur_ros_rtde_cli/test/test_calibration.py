"""`ur calibration` reads the calibration of a simulated arm, and the description follows it."""

import pathlib
import re
import shlex

import numpy as np
import pytest
import yaml
from programs import Simulator
from support import own_address, wait_for
from ur_ros_rtde_cli.main import main
from ur_ros_rtde_cli.robot_check.checks import Options, RobotCheck
from ur_ros_rtde_cli.robot_check.finding import State
from ur_ros_rtde_description.calibration import read_calibration
from ur_ros_rtde_description.kinematics import flange_pose, nominal_origins
from ur_ros_rtde_description.models import find_model

ADDRESS = own_address()
PAGE = (pathlib.Path(__file__).resolve().parents[2] / "docs" / "use" / "description.md").read_text()
POSITIONS = ([0.3, -1.2, 1.1, -0.4, 0.9, 2.0], [-1.0, -2.0, -1.5, 0.7, -1.2, -0.5], [2.2, -0.4, 0.3, -1.9, 1.6, 0.1])


@pytest.fixture(scope="module")
def simulator():
    started = Simulator(ADDRESS, "--calibration-seed", "7", model="ur5e")
    try:
        yield started
    finally:
        started.stop()


@pytest.fixture
def file(simulator, tmp_path):
    path = tmp_path / "my_robot.yaml"
    assert main(["calibration", "--robot", ADDRESS, "--output", str(path)]) == 0
    return path


def controllers_flange(simulator, joints):
    """Moves the arm and returns position and rotation matrix of the flange, as the controller reports them."""
    simulator.control("set_joints", joints=joints)
    state = wait_for(lambda: (now := simulator.state())["at_rest"] and np.allclose(now["target"]["position"], joints, atol=1e-12) and now,
                     10.0, "the arm")
    x, y, z, *vector = state["target_tcp_pose"]
    angle = np.linalg.norm(vector)
    cross = np.cross(np.eye(3), np.array(vector) / angle)
    rotation = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
    return np.array([x, y, z]), rotation


def test_the_description_with_the_calibration_agrees_with_the_controller(simulator, file):
    model = find_model("ur5e")
    origins = read_calibration(file, model)
    nominal_distances = []
    for joints in POSITIONS:
        position, rotation = controllers_flange(simulator, joints)
        pose = flange_pose(origins, joints)
        assert pose[:3, 3] == pytest.approx(position, abs=1e-9)
        assert pose[:3, :3] == pytest.approx(rotation, abs=1e-9)
        nominal_distances.append(np.linalg.norm(flange_pose(nominal_origins(model), joints)[:3, 3] - position))
    assert max(nominal_distances) > 2e-4


def test_the_file_has_the_fields_of_ur_description(file):
    content = yaml.safe_load(file.read_text())
    assert set(content) == {"kinematics"}
    assert set(content["kinematics"]) == {"shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3", "hash"}
    assert re.fullmatch(r"calib_\d{1,20}", content["kinematics"]["hash"])
    assert file.read_text().startswith(f"# Calibration of the UR5e at {ADDRESS}, PolyScope 5.25.1")


def test_two_calibrations_are_compared(simulator, file, capsys):
    assert main(["calibration", "--robot", ADDRESS, "--compare", str(file)]) == 0
    assert "the flange deviates by up to 0.000 mm and 0.000000 rad" in capsys.readouterr().out
    content = yaml.safe_load(file.read_text())
    content["kinematics"]["forearm"]["x"] += 0.0005
    file.write_text(yaml.safe_dump(content))
    assert main(["calibration", "--robot", ADDRESS, "--compare", str(file)]) == 1
    assert "by up to 0.500 mm" in capsys.readouterr().out


def finding(**options):
    checks = RobotCheck(Options(ADDRESS, **options))
    return next(found for found in checks.findings() if found.subject == "calibration")


def test_the_doctor_warns_of_nominal_kinematics(simulator, file):
    found = finding()
    assert found.state is State.WARNING and "from the nominal kinematics of a ur5e" in found.text and "ur calibration" in found.remedy
    assert finding(kinematics_params_file=str(file)).state is State.OK


def test_the_doctor_rejects_the_calibration_of_another_model(simulator, tmp_path):
    first, second, third, last = ADDRESS.split(".")
    other = Simulator(".".join([first, str(int(second) + 1), third, last]), model="ur10e")
    try:
        assert main(["calibration", "--robot", other.address, "--output", str(tmp_path / "other.yaml")]) == 0
    finally:
        other.stop()
    found = finding(kinematics_params_file=str(tmp_path / "other.yaml"))
    assert found.state is State.FAULT and "does not belong to the model ur5e" in found.text and "It fits ur10e" in found.text


@pytest.mark.parametrize("arguments, code, mentions", [
    (["--ur-type", "ur6"], 2, 'model is "ur6"'), (["--ur-type", "ur10e"], 2, "does not belong to the model ur10e"),
    (["--compare", "/none"], 2, 'kinematics_params_file is "/none"'), (["--output", "/"], 2, 'output is "/"')])
def test_wrong_arguments_are_rejected(simulator, arguments, code, mentions, capsys):
    assert main(["calibration", "--robot", ADDRESS, *arguments]) == code
    assert mentions in capsys.readouterr().err


def test_a_robot_that_does_not_answer_is_reported(simulator, capsys):
    simulator.control("refuse_connections", which="primary")
    try:
        assert main(["calibration", "--robot", ADDRESS]) == 1
    finally:
        simulator.control("accept_connections")
    assert f"port 30001: Connection refused; `ur doctor --robot {ADDRESS}` finds the cause" in capsys.readouterr().err


def test_a_text_that_is_no_address_is_reported(capsys):
    assert main(["calibration", "--robot", "192.168.56..101"]) == 1
    assert "192.168.56..101 is no address" in capsys.readouterr().err


def test_the_commands_in_the_documentation_work(simulator, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    commands = re.findall(r"^ur (calibration .*)$", PAGE, re.M)
    assert len(commands) >= 2
    for command in commands:
        assert main([ADDRESS if word == "192.168.56.101" else word for word in shlex.split(command)]) == 0, capsys.readouterr()
