"""The driver compares the topic robot_description with the calibration of the arm."""

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from programs import start_node
from rclpy.qos import DurabilityPolicy, QoSProfile
from ros_client import Client
from std_msgs.msg import String
from support import FEW_PLUGINS, wait_for
from ur_ros_rtde_cli.robot_check.primary import read_arm_data
from ur_ros_rtde_description import controller_calibration
from ur_ros_rtde_description.models import find_model
from ur_ros_rtde_description.options import read_options
from ur_ros_rtde_description.urdf import make_urdf

SIMULATOR_ARGUMENTS = ("--calibration-seed", "3")
ENTRY = "/cell/command_server: description"
WARNING = "robot_description differs from the arm"


@pytest.fixture
def cell(simulator):
    """A driver with a tf_prefix, and a client with a publisher of robot_description in its namespace."""
    driver = start_node("driver", simulator.address, FEW_PLUGINS, "tf_prefix:=left_", namespace="cell")
    client = Client("cell")
    qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publisher = client.node.create_publisher(String, "robot_description", qos)
    yield driver, client, lambda urdf: publisher.publish(String(data=urdf))
    client.close()
    driver.stop()
    print(driver.output())


def urdf(model="ur10e", **options):
    return make_urdf(read_options(model, tf_prefix="left_", **options))


def warnings(driver):
    return [line for line in list(driver.lines) if WARNING in line]


def diagnoses(client):
    """Returns a function that returns the diagnoses with this name so far."""
    arrays = client.subscribe(DiagnosticArray, "/diagnostics")
    return lambda name=ENTRY: [status for array in list(arrays) for status in array.status if status.name == name]


def test_the_nominal_description_of_a_calibrated_arm_is_reported_once(cell, simulator):
    driver, client, publish = cell
    found = diagnoses(client)
    publish(urdf())
    wait_for(lambda: len(found()) >= 3, 30.0, "diagnoses of the description")
    status = found()[-1]
    assert status.level == DiagnosticStatus.WARN and WARNING in status.message
    line, = warnings(driver)
    assert "WARN" in line and f"ur calibration --robot {simulator.address}" in line and "kinematics_params_file" in line, line
    # The deviation is that of `ur doctor --robot`.
    expected = controller_calibration.deviation(read_arm_data(simulator.address, 5.0).kinematics, "ur10e", None)
    values = {pair.key: float(pair.value) for pair in status.values}
    assert values["deviation of the flange in mm"] == pytest.approx(1e3 * expected.distance, abs=1e-3)
    assert values["deviation of the flange in rad"] == pytest.approx(expected.angle, abs=1e-6)


def test_the_calibrated_description_agrees(cell, simulator, tmp_path):
    driver, client, publish = cell
    found = diagnoses(client)
    file = tmp_path / "arm.yaml"
    kinematics = read_arm_data(simulator.address, 5.0).kinematics
    file.write_text(controller_calibration.calibration_yaml(kinematics, find_model("ur10e")))
    publish(urdf(kinematics_params_file=str(file)))
    status = wait_for(found, 30.0, "the diagnosis of the description")[-1]
    assert status.level == DiagnosticStatus.OK and not warnings(driver), status.message
    publish(urdf("ur5e"))
    wait_for(lambda: found()[-1].level == DiagnosticStatus.WARN, 10.0, "the diagnosis of the new description")
    assert "another model" in found()[-1].message and len(warnings(driver)) == 1


@pytest.mark.parametrize("description", [make_urdf(read_options("ur10e", tf_prefix="right_")), "<robot"])
def test_a_description_without_this_arm_is_ignored(cell, description):
    driver, client, publish = cell
    found = diagnoses(client)
    publish(description)
    wait_for(lambda: [status for status in found("/cell/command_server: driver") if status.level == DiagnosticStatus.OK][2:], 30.0,
             "diagnoses of the connected driver")
    assert not found() and not warnings(driver)
