"""URDF, driver and simulator agree on kinematics, limits and masses of every model."""

import json
import math
import os
import pathlib
import subprocess

import numpy as np
import pytest
from helpers import poses, urdf
from ur_ros_rtde_description.models import JOINTS, LINKS, find_model, models
from ur_ros_rtde_description.tree import origin_of

BACKGROUND = True
TOLERANCE = 1e-9  # m, and entries of rotation matrices and inertia tensors


def published_models():
    """Returns what the program published_models prints: the numbers of simulator and driver."""
    for prefix in os.environ["AMENT_PREFIX_PATH"].split(os.pathsep):
        program = pathlib.Path(prefix, "lib", "ur_ros_rtde_description", "published_models")
        if program.is_file():
            return json.loads(subprocess.run([str(program)], check=True, capture_output=True, text=True, timeout=60).stdout)
    raise FileNotFoundError("published_models is in no prefix of AMENT_PREFIX_PATH")


@pytest.fixture(scope="module")
def published():
    return published_models()


def in_base(frames, link):
    """Returns the pose of a link in the frame `base` of the controller."""
    return np.linalg.inv(frames["base"]) @ frames[link]


def test_there_is_a_urdf_of_every_model(published):
    assert set(models()) == set(published)
    assert all(find_model(name).display_name == values["display_name"] for name, values in published.items())


@pytest.mark.parametrize("name", models())
def test_the_forward_kinematics_are_those_of_driver_and_simulator(published, name):
    robot = urdf(name, xyz=(0.3, -0.2, 0.7), rpy=(0.1, 0.2, 0.3))
    assert len(published[name]["samples"]) >= 50
    for sample in published[name]["samples"]:
        flange = in_base(poses(robot, sample["joints"]), "tool0")
        for source in ("driver", "simulator"):
            np.testing.assert_allclose(flange, np.reshape(sample[source], (4, 4)), rtol=0.0, atol=TOLERANCE, err_msg=source)


@pytest.mark.parametrize("name", models())
def test_masses_are_those_of_the_simulator(published, name):
    robot = urdf(name)
    inertials = {link.get("name"): link.find("inertial") for link in robot.findall("link")}
    for sample in published[name]["samples"][:10]:
        frames = poses(robot, sample["joints"])
        for link, expected in zip(LINKS, sample["masses"]):
            inertial = inertials[link]
            pose = in_base(frames, link) @ origin_of(inertial).transform()
            values = {name: float(text) for name, text in inertial.find("inertia").items()}
            tensor = np.array([[values["i" + "".join(sorted(i + j))] for j in "xyz"] for i in "xyz"])
            assert float(inertial.find("mass").get("value")) == expected["mass"]
            np.testing.assert_allclose(pose[:3, 3], expected["center"], rtol=0.0, atol=TOLERANCE, err_msg=link)
            np.testing.assert_allclose(pose[:3, :3] @ tensor @ pose[:3, :3].T, np.reshape(expected["inertia"], (3, 3)), rtol=0.0,
                                       atol=TOLERANCE, err_msg=link)


def collision_cylinders(robot, frames, link):
    """Returns the ends of the axis (unordered) and the radius of the cylinders of a link in the frame `base`."""
    for shape in robot.find(f"link[@name='{link}']").findall("collision"):
        geometry = shape.find("geometry")[0]
        if geometry.tag == "cylinder":
            pose = in_base(frames, link) @ origin_of(shape).transform()
            half = 0.5 * float(geometry.get("length")) * pose[:3, 2]
            yield pose[:3, 3] - half, pose[:3, 3] + half, float(geometry.get("radius"))


def same_cylinder(first, second):
    begin, end, radius = second
    return abs(first[2] - radius) < TOLERANCE and any(
        np.allclose(first[0], a, rtol=0.0, atol=TOLERANCE) and np.allclose(first[1], b, rtol=0.0, atol=TOLERANCE)
        for a, b in ((begin, end), (end, begin)))


@pytest.mark.parametrize("name", models())
def test_the_simulator_detects_collisions_of_the_same_cylinders(published, name):
    """All but the foot of the base, which does not move."""
    robot = urdf(name)
    foot = find_model(name).base_radius
    for sample in published[name]["samples"][:5]:
        frames = poses(robot, sample["joints"])
        for body, link in enumerate(("base_link_inertia", *LINKS)):
            expected = [shape for shape in collision_cylinders(robot, frames, link) if body or shape[2] != foot]
            found = [(c["begin"], c["end"], c["radius"]) for c in sample["cylinders"] if c["body"] == body]
            assert len(found) == len(expected), link
            assert all(any(same_cylinder(shape, other) for other in found) for shape in expected), link


@pytest.mark.parametrize("name", models())
def test_limits_are_those_of_driver_and_simulator(published, name):
    expected = published[name]
    joints = {joint.get("name"): joint for joint in urdf(name).findall("joint")}
    for i, joint in enumerate(JOINTS):
        limit = joints[joint].find("limit")
        assert float(limit.get("effort")) == expected["torque_max"][i] == expected["driver_limits"]["torque"][i]
        velocity = float(limit.get("velocity"))
        assert velocity == pytest.approx(expected["velocity_max"][i], abs=1e-12)
        assert velocity == pytest.approx(expected["driver_limits"]["velocity"][i], abs=1e-12)
        if expected["position_max"][i] is None:  # continuous; the driver limits targets to two turns
            assert joints[joint].get("type") == "continuous" and limit.get("lower") is limit.get("upper") is None
            continue
        assert joints[joint].get("type") == "revolute"
        assert expected["position_max"][i] == expected["driver_limits"]["position"][i] == 2.0 * math.pi
        if joint != "elbow_joint":  # narrower, for planners: test_urdf.py
            assert float(limit.get("upper")) == -float(limit.get("lower")) == expected["position_max"][i]
