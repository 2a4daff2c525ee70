#!/usr/bin/env python3
"""Draws the URDFs of ur_ros_rtde_description: docs/images/models.png. Run it with the Python of the build.

    .ur/jazzy/venv/bin/python tools/draw_models.py docs/images/models.png
"""

import argparse
import pathlib
import sys
import xml.etree.ElementTree as xml

import matplotlib
import numpy as np

matplotlib.use("Agg")  # before pyplot is imported
import matplotlib.pyplot as plt

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "ur_ros_rtde_description"))
from ur_ros_rtde_description.models import JOINTS, find_model
from ur_ros_rtde_description.options import read_options
from ur_ros_rtde_description.tree import link_poses, origin_of
from ur_ros_rtde_description.urdf import make_urdf

MODELS = ("ur3", "ur5", "ur3e", "ur5e", "ur10e", "ur16e", "ur18", "ur15", "ur20")
POSITION = (-0.25, -1.9, 2.0, -1.67, -1.57, 0.0)  # rad
HEIGHT, PIXEL = 1.4, 0.0025  # m, m
LIGHT = np.array([0.48, -0.48, 0.73])


def camera():
    """Returns the axes of the image (right, down, into the scene) as columns: seen from the front left, slightly from above."""
    into = np.array([-0.55, 0.8, -0.33])
    into /= np.linalg.norm(into)
    right = np.cross(into, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    return np.column_stack([right, np.cross(into, right), into])


def shapes(robot):
    """Yields pose, geometry element and color of each visual in the root frame."""
    poses = link_poses(robot, dict(zip(JOINTS, POSITION)))
    for link in robot.findall("link"):
        for visual in link.findall("visual"):
            color = np.array([float(value) for value in visual.find("material/color").get("rgba").split()[:3]])
            yield poses[link.get("name")] @ origin_of(visual).transform(), visual.find("geometry")[0], color


def hit_sphere(start, direction, radius):
    half = start @ direction
    root = np.sqrt(half**2 - (np.sum(start**2, axis=-1) - radius**2))
    depth = -half - root
    return depth, (start + depth[..., None] * direction) / radius


def hit_cylinder(start, direction, radius, length):
    """Returns depth (NaN without a hit) and normal of the first hit of each ray with a cylinder along z."""
    across = max(direction[0]**2 + direction[1]**2, 1e-12)
    half = (start[..., :2] @ direction[:2]) / across
    depth = -half - np.sqrt(half**2 - (np.sum(start[..., :2]**2, axis=-1) - radius**2) / across)
    point = start + depth[..., None] * direction
    normal = np.concatenate([point[..., :2] / radius, np.zeros_like(depth)[..., None]], axis=-1)
    depth[~(np.abs(point[..., 2]) <= length / 2)] = np.nan
    if abs(direction[2]) > 1e-9:
        side = -np.sign(direction[2])  # only the end that faces the camera is visible
        end = (side * length / 2 - start[..., 2]) / direction[2]
        inside = np.sum((start + end[..., None] * direction)[..., :2]**2, axis=-1) <= radius**2
        nearer = inside & ~(depth < end)
        depth[nearer], normal[nearer] = end[nearer], (0.0, 0.0, side)
    return depth, normal


def render(robot, width):
    """Returns an RGB image of the arm with parallel rays."""
    view = camera()
    right, down = np.meshgrid(np.arange(-0.3 * width, 0.7 * width, PIXEL), np.arange(-HEIGHT * 0.88, HEIGHT * 0.12, PIXEL))
    rays = right[..., None] * view[:, 0] + down[..., None] * view[:, 1] - 10.0 * view[:, 2]
    image, nearest = np.ones((*right.shape, 3)), np.full(right.shape, np.inf)
    for pose, geometry, color in shapes(robot):
        start, direction = (rays - pose[:3, 3]) @ pose[:3, :3], view[:, 2] @ pose[:3, :3]
        size = {name: float(value) for name, value in geometry.items()}
        with np.errstate(invalid="ignore"):
            depth, normal = (hit_sphere if geometry.tag == "sphere" else hit_cylinder)(start, direction, **size)
            nearer = depth < nearest
        nearest[nearer] = depth[nearer]
        brightness = 0.55 + 0.6 * np.clip(normal[nearer] @ pose[:3, :3].T @ LIGHT, 0.0, 1.0)
        image[nearer] = np.minimum(brightness[:, None] * color, 1.0)
    return image


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("output", type=pathlib.Path, help="PNG")
    parser.add_argument("--model", action="append", help=f"model to draw; may be repeated (default: {', '.join(MODELS)})")
    options = parser.parse_args()
    models = [find_model(name) for name in options.model or MODELS]
    widths = [0.3 - 0.6 * (model.a[1] + model.a[2]) for model in models]
    figure, all_axes = plt.subplots(1, len(models), figsize=(sum(widths) * 2.4, HEIGHT * 2.4), squeeze=False,
                                    gridspec_kw={"width_ratios": widths, "wspace": 0.0})
    for axes, model, width in zip(all_axes[0], models, widths):
        axes.imshow(render(xml.fromstring(make_urdf(read_options(model.name))), width), interpolation="antialiased")
        axes.set_title(model.display_name, y=-0.03, fontsize=10)
        axes.axis("off")
    figure.savefig(options.output, dpi=110, bbox_inches="tight", pad_inches=0.05)


if __name__ == "__main__":
    main()
