"""Names, frames, mounting pose, prefix, calibration, tools and the xacro macro."""

import math
import pathlib
import re
import xml.etree.ElementTree as xml

import numpy as np
import pytest
from helpers import calibration, poses, urdf, write_calibration
from ur_ros_rtde_description.kinematics import Origin, flange_pose, nominal_origins, rotation
from ur_ros_rtde_description.models import JOINTS, LINKS, find_model, models
from ur_ros_rtde_description.options import read_options
from ur_ros_rtde_description.tree import root_link
from ur_ros_rtde_description.urdf import make_urdf, make_xacro

BACKGROUND = True
# The links, and parent and child of the joints, of ur_description.
LINK_NAMES = {"world", "base_link", "base_link_inertia", "base", *LINKS, "flange", "tool0", "ft_frame"}
JOINT_NAMES = {"base_joint": ("world", "base_link"), "base_link-base_link_inertia": ("base_link", "base_link_inertia"),
               "base_link-base_fixed_joint": ("base_link", "base"), "wrist_3-flange": ("wrist_3_link", "flange"),
               "flange-tool0": ("flange", "tool0"), "wrist_3_link-ft_frame": ("wrist_3_link", "ft_frame"),
               **dict(zip(JOINTS, zip(("base_link_inertia", *LINKS), LINKS)))}
EFFORTS = {"ur3": (56, 56, 28, 12, 12, 12), "ur3e": (54, 54, 28, 9, 9, 9), "ur5": (150, 150, 150, 28, 28, 28),
           "ur5e": (150, 150, 150, 28, 28, 28), "ur10": (330, 330, 150, 56, 56, 56), "ur10e": (330, 330, 150, 54, 54, 54),
           "ur16e": (330, 330, 150, 54, 54, 54), "ur20": (738, 738, 433, 107, 107, 107), "ur30": (738, 738, 433, 107, 107, 107)}
JOINTS_AT = (0.3, -1.2, 1.4, -0.8, 1.1, 0.6)
TOOL = """<robot name="gripper">
  <link name="palm"><inertial><mass value="0.9"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
  <link name="finger"/><link name="thumb"/>
  <joint name="grip" type="prismatic"><parent link="palm"/><child link="finger"/><origin xyz="0 0 0.1"/></joint>
  <joint name="thumb_joint" type="prismatic"><parent link="palm"/><child link="thumb"/><mimic joint="grip"/></joint>
  <transmission name="drive"><joint name="grip"/><actuator name="motor"/></transmission>
  <ros2_control name="gripper" type="system">
    <hardware><param name="port">grip</param></hardware>
    <joint name="thumb_joint"><param name="mimic">grip</param></joint><sensor name="force"/><gpio name="light"/>
  </ros2_control>
  <gazebo reference="finger"><sensor name="camera" type="camera"/></gazebo><gazebo><plugin name="world"/></gazebo>
</robot>"""


def connections(robot):
    return {joint.get("name"): (joint.find("parent").get("link"), joint.find("child").get("link")) for joint in robot.findall("joint")}


def canonical(element):
    return xml.canonicalize(xml.tostring(element), strip_text=True)


@pytest.mark.parametrize("model", models())
def test_links_and_joints_are_those_of_ur_description(model):
    robot = urdf(model)
    assert robot.get("name") == model
    assert sorted(link.get("name") for link in robot.findall("link")) == sorted(LINK_NAMES)
    assert connections(robot) == JOINT_NAMES
    assert root_link(robot) == "world"


def test_the_frames_have_the_orientations_of_rep_103():
    frames = poses(urdf("ur5e"), [0.0] * 6)
    np.testing.assert_allclose(frames["base_link"], np.eye(4), atol=1e-12)
    assert frames["tool0"][0, 3] == pytest.approx(0.425 + 0.3922)  # base_link: the stretched arm points along x
    np.testing.assert_allclose(frames["base"][:3, :3], rotation(2, math.pi), atol=1e-12)
    np.testing.assert_allclose(frames["tool0"], frames["wrist_3_link"], atol=1e-12)
    np.testing.assert_allclose(frames["flange"][:3, 0], frames["tool0"][:3, 2], atol=1e-12)  # x of flange leads out of the arm
    np.testing.assert_allclose(frames["ft_frame"], frames["wrist_3_link"] @ Origin(rpy=(math.pi, 0.0, 0.0)).transform(), atol=1e-12)


@pytest.mark.parametrize("model", models())
def test_the_position_limits_are_those_of_ur_description(model):
    """The elbow is limited to half of what the controller allows."""
    turns = [2.0, 2.0, 1.0, 2.0, 2.0, None if model in ("ur3", "ur3e") else 2.0]
    for name, limit in zip(JOINTS, turns):
        found = urdf(model).find(f"joint[@name='{name}']/limit")
        expected = (None, None) if limit is None else (-limit * math.pi, limit * math.pi)
        assert tuple(value and float(value) for value in (found.get("lower"), found.get("upper"))) == expected, name


@pytest.mark.parametrize("model", EFFORTS)
def test_the_efforts_are_those_of_ur_description(model):
    """Of config/<model>/joint_limits.yaml. test_models.py compares those of all models with driver and simulator."""
    assert tuple(float(urdf(model).find(f"joint[@name='{name}']/limit").get("effort")) for name in JOINTS) == EFFORTS[model]


def test_the_prefix_is_part_of_every_name_but_the_parent():
    robot = urdf("ur3", tf_prefix="left_", parent="table", tool_length=0.1)
    plain = urdf("ur3", tool_length=0.1, parent="table")
    assert connections(robot) == {"left_" + name: tuple(link if link == "table" else "left_" + link for link in ends)
                                  for name, ends in connections(plain).items()}
    np.testing.assert_allclose(poses(robot, JOINTS_AT, "left_")["left_tool0"], poses(plain, JOINTS_AT)["tool0"])


def test_the_mounting_pose_is_that_of_base_link_in_the_parent():
    origin = Origin((0.1, -0.2, 0.8), (math.pi, 0.0, 0.5))
    robot = urdf("ur10e", parent="ceiling", xyz=origin.xyz, rpy=origin.rpy)
    np.testing.assert_allclose(poses(robot, JOINTS_AT)["base_link"], origin.transform(), atol=1e-12)


def test_without_a_parent_base_link_is_the_root():
    robot = urdf("ur10e", parent="")
    assert root_link(robot) == "base_link" and "base_joint" not in connections(robot)


@pytest.mark.parametrize("model", models())
def test_a_calibration_with_nominal_values_changes_nothing(model, tmp_path):
    file = write_calibration(tmp_path, calibration(nominal_origins(find_model(model))))
    np.testing.assert_allclose(poses(urdf(model, kinematics_params_file=file), JOINTS_AT)["tool0"],
                               poses(urdf(model), JOINTS_AT)["tool0"], atol=1e-12)


@pytest.mark.parametrize("model", models())
def test_a_calibration_moves_the_tool_by_its_deviations(model, tmp_path):
    random = np.random.default_rng(1)
    origins = [Origin(tuple(origin.xyz + random.normal(0.0, 5e-4, 3)), tuple(origin.rpy + random.normal(0.0, 1e-3, 3)))
               for origin in nominal_origins(find_model(model))]
    robot = urdf(model, kinematics_params_file=write_calibration(tmp_path, calibration(origins)))
    frames = poses(robot, JOINTS_AT)
    tool = np.linalg.inv(frames["base"]) @ frames["tool0"]
    np.testing.assert_allclose(tool, flange_pose(origins, JOINTS_AT), atol=1e-12)
    assert np.linalg.norm(tool - flange_pose(nominal_origins(find_model(model)), JOINTS_AT)) > 1e-4


def test_the_numbers_of_a_calibration_may_have_any_spelling_of_yaml(tmp_path):
    text = write_calibration(tmp_path, calibration(nominal_origins(find_model("ur30"))))
    file = pathlib.Path(text)
    file.write_text(re.sub(r"(wrist_3:\n(?:    .*\n)*?    z:) .*", r"\1 -3e-11", file.read_text()))  # PyYAML reads -3e-11 as a string
    assert "-3e-11" in file.read_text()
    read_options("ur30", kinematics_params_file=text)


def test_a_cylinder_as_a_tool_has_a_frame_at_its_end():
    robot = urdf("ur5e", tool_length=0.2, tool_radius=0.04, tool_mass=1.5)
    frames = poses(robot, JOINTS_AT)
    np.testing.assert_allclose(np.linalg.inv(frames["tool0"]) @ frames["tool_tip"], Origin((0.0, 0.0, 0.2)).transform(), atol=1e-12)
    tool = robot.find("link[@name='tool']")
    assert tool.find("inertial/mass").get("value") == "1.5"
    assert tool.find("collision/geometry/cylinder").attrib == {"radius": "0.04", "length": "0.2"}
    assert urdf("ur5e", tool_length=0.2).find("link[@name='tool']/inertial") is None


def test_a_tool_from_a_file_is_attached_to_tool0(tmp_path):
    file = tmp_path / "gripper.urdf"
    file.write_text(TOOL)
    robot = urdf("ur5e", tf_prefix="left_", tool=str(file))
    found = connections(robot)
    assert found["left_tool0-palm"] == ("left_tool0", "left_palm") and found["left_grip"] == ("left_palm", "left_finger")
    assert robot.find("joint[@name='left_thumb_joint']/mimic").get("joint") == "left_grip"
    assert robot.find("link[@name='left_palm']/inertial/mass").get("value") == "0.9"
    assert root_link(robot) == "world"


def test_the_extensions_of_a_tool_name_the_links_and_joints_with_their_prefix(tmp_path):
    file = tmp_path / "gripper.urdf"
    file.write_text(TOOL)
    robot = urdf("ur5e", tf_prefix="left_", tool=str(file))

    def names(path):
        return [element.get("name") for element in robot.findall(path)]

    assert names("transmission") + names("transmission/*") == ["left_drive", "left_grip", "left_motor"]
    assert names("ros2_control") + names("ros2_control/*")[1:] == ["left_gripper", "left_thumb_joint", "left_force", "left_light"]
    assert robot.find("ros2_control/joint/param").text == "left_grip" and robot.find("ros2_control/hardware/param").text == "grip"
    assert [gazebo.attrib for gazebo in robot.findall("gazebo")] == [{"reference": "left_finger"}, {}]
    assert names("gazebo/*") == ["camera", "world"]


@pytest.mark.parametrize("model", models())
def test_the_xacro_macro_expands_to_the_urdf(model):
    """Replaces what xacro replaces: the parameters and the block."""
    macro = make_xacro(read_options(model, tool_length=0.1))
    text = macro.replace("${tf_prefix}", "left_").replace("${parent}", "table")
    text = text.replace('<xacro:insert_block name="origin" />', '<origin xyz="0.1 0.2 0.3" rpy="0 0 0.4" />')
    found = xml.fromstring(text).find("{http://www.ros.org/wiki/xacro}macro")
    assert found.get("name") == model and found.get("params") == "parent tf_prefix:='' *origin"
    robot = urdf(model, tf_prefix="left_", parent="table", xyz=(0.1, 0.2, 0.3), rpy=(0.0, 0.0, 0.4), tool_length=0.1)
    robot.remove(robot.find("link[@name='table']"))
    assert list(map(canonical, found)) == list(map(canonical, robot))


def test_the_macro_contains_no_other_expressions():
    assert set(re.findall(r"\$\{(.*?)\}", make_xacro(read_options("ur20")))) == {"tf_prefix", "parent"}


def test_numbers_have_full_precision():
    text = make_urdf(read_options("ur10", xyz=(1.0 / 3.0, 0.0, 0.0)))
    assert "0.3333333333333333 0 0" in text and "0.163941" in text
