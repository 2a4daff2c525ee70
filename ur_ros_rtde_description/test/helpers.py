"""Helpers of the tests."""

import xml.etree.ElementTree as xml

import yaml
from ur_ros_rtde_description.calibration import FIELDS, JOINT_KEYS
from ur_ros_rtde_description.models import JOINTS
from ur_ros_rtde_description.options import read_options
from ur_ros_rtde_description.tree import link_poses
from ur_ros_rtde_description.urdf import make_urdf


def urdf(model, **options):
    return xml.fromstring(make_urdf(read_options(model, **options)))


def poses(robot, joints, tf_prefix=""):
    return link_poses(robot, {tf_prefix + name: angle for name, angle in zip(JOINTS, joints)})


def calibration(origins):
    """Returns the content of a kinematics file of ur_description."""
    kinematics = {key: dict(zip(FIELDS, map(float, (*origin.xyz, *origin.rpy)))) for key, origin in zip(JOINT_KEYS, origins)}
    return {"kinematics": {**kinematics, "hash": "calib_1"}}


def write_calibration(folder, content):
    file = folder / "calibration.yaml"
    file.write_text(yaml.safe_dump(content))
    return str(file)
