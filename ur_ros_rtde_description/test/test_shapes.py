"""The geometry: sizes, and no contact of links that are not neighbors."""

import numpy as np
import pytest
from helpers import poses, urdf
from ur_ros_rtde_description.models import JOINTS, LINKS, find_model, models
from ur_ros_rtde_description.shapes import Cylinder, base_height, link_shapes
from ur_ros_rtde_description.tree import origin_of

BACKGROUND = True
BODIES = ("base_link_inertia", *LINKS)
POSITIONS = {"home": (0.0, -1.57, 1.57, -1.57, -1.57, 0.0), "upright": (0.0, -1.57, 0.0, -1.57, 0.0, 0.0), "stretched": (0.0,) * 6,
             "elbow down": (0.5, -0.5, -1.2, -1.2, 1.57, 1.0), "folded": (0.0, -1.57, 2.4, -0.8, 1.57, 0.0)}


def surface(geometry):
    """Returns points on the surface of a cylinder or sphere."""
    radius = float(geometry.get("radius"))
    angles = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
    if geometry.tag == "sphere":
        rows = [(radius * np.sin(polar), radius * np.cos(polar)) for polar in np.linspace(0.0, np.pi, 7)]
    else:
        half = float(geometry.get("length")) / 2.0
        rows = [(radius, z) for z in np.linspace(-half, half, 13)] + [(radius / 2.0, -half), (radius / 2.0, half)]
    return np.array([(across * np.cos(angle), across * np.sin(angle), z) for across, z in rows for angle in angles])


def contains(geometry, points):
    radius = float(geometry.get("radius"))
    if geometry.tag == "sphere":
        return np.linalg.norm(points, axis=1) < radius
    return (np.linalg.norm(points[:, :2], axis=1) < radius) & (np.abs(points[:, 2]) < float(geometry.get("length")) / 2.0)


def collision_shapes(robot, joints):
    """Returns pose in the world and geometry of the collision shapes of each link."""
    frames = poses(robot, joints)
    return {name: [(frames[name] @ origin_of(shape).transform(), shape.find("geometry")[0])
                   for shape in robot.find(f"link[@name='{name}']").findall("collision")] for name in BODIES}


@pytest.mark.parametrize("position", POSITIONS)
@pytest.mark.parametrize("model", models())
def test_links_that_are_not_neighbors_do_not_touch(model, position):
    shapes = collision_shapes(urdf(model), POSITIONS[position])
    for i, first in enumerate(BODIES):
        for second in BODIES[i + 2:]:
            for pose, geometry in shapes[first]:
                points = surface(geometry) @ pose[:3, :3].T + pose[:3, 3]
                for other_pose, other in shapes[second]:
                    inside = contains(other, (points - other_pose[:3, 3]) @ other_pose[:3, :3])
                    assert not inside.any(), (first, second)


@pytest.mark.parametrize("model", models())
def test_neighbors_meet_at_their_joint(model):
    """Surface points of neighbors are nearer to each other than the spacing of the points on the smaller joint."""
    robot = urdf(model)
    shapes = collision_shapes(robot, POSITIONS["home"])
    points = {name: np.concatenate([surface(g) @ p[:3, :3].T + p[:3, 3] for p, g in shapes[name]]) for name in BODIES}
    for first, second in zip(BODIES, BODIES[1:]):
        nearest = np.linalg.norm(points[first][:, None] - points[second][None], axis=2).min()
        assert nearest < 0.25 * min(find_model(model).joint_radius), (first, second)


@pytest.mark.parametrize("model", models())
def test_all_sizes_are_positive(model):
    found = find_model(model)
    assert base_height(found) > 0.01 and found.base_radius > found.joint_radius[0]
    for shapes in link_shapes(found).values():
        for shape in shapes:
            assert shape.radius > 0.01 and (not isinstance(shape, Cylinder) or shape.length > 0.002), shape


@pytest.mark.parametrize("model", models())
def test_the_center_of_mass_of_each_link_is_near_its_shapes(model):
    robot = urdf(model)
    shapes = collision_shapes(robot, (0.0,) * len(JOINTS))
    frames = poses(robot, (0.0,) * len(JOINTS))
    for name in LINKS:
        center = (frames[name] @ origin_of(robot.find(f"link[@name='{name}']/inertial")).transform())[:3, 3]
        points = np.concatenate([surface(g) @ p[:3, :3].T + p[:3, 3] for p, g in shapes[name]])
        assert np.all(center > points.min(axis=0) - 0.03) and np.all(center < points.max(axis=0) + 0.03), name
