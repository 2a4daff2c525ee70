"""Elements of a URDF."""

import math
import xml.etree.ElementTree as xml

import numpy as np

from .kinematics import Origin
from .shapes import Cylinder, Shape, Shapes

COLORS = {"ur_housing": "0.74 0.75 0.77 1", "ur_lid": "0.32 0.45 0.56 1", "ur_tool": "0.25 0.27 0.30 1"}
AXIS_RPY = {"x": (0.0, math.pi / 2, 0.0), "y": (-math.pi / 2, 0.0, 0.0), "z": (0.0, 0.0, 0.0)}  # turns z to the axis
INERTIA = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}


def number(value: float) -> str:
    """Returns a number with full round-trip precision."""
    return repr(float(value)) if value else "0"


def add_origin(element: xml.Element, origin: Origin) -> None:
    xml.SubElement(element, "origin", xyz=" ".join(map(number, origin.xyz)), rpy=" ".join(map(number, origin.rpy)))


def add_joint(robot: xml.Element, name: str, kind: str, parent: str, child: str) -> xml.Element:
    joint = xml.SubElement(robot, "joint", name=name, type=kind)
    xml.SubElement(joint, "parent", link=parent)
    xml.SubElement(joint, "child", link=child)
    return joint


def add_fixed_joint(robot: xml.Element, name: str, parent: str, child: str, origin: Origin) -> None:
    add_origin(add_joint(robot, name, "fixed", parent, child), origin)


def add_shapes(link: xml.Element, shapes: Shapes, color: str) -> None:
    """Adds the visual and the collision geometry. Lids of joints are only visible."""
    for shape in shapes:
        visual = xml.SubElement(link, "visual")
        _add_geometry(visual, shape)
        name = "ur_lid" if _is_lid(shape) else color
        xml.SubElement(xml.SubElement(visual, "material", name=name), "color", rgba=COLORS[name])
    for shape in shapes:
        if not _is_lid(shape):
            _add_geometry(xml.SubElement(link, "collision"), shape)


def _is_lid(shape: Shape) -> bool:
    return isinstance(shape, Cylinder) and shape.is_lid


def _add_geometry(element: xml.Element, shape: Shape) -> None:
    geometry = xml.SubElement(element, "geometry")
    if isinstance(shape, Cylinder):
        add_origin(element, Origin(shape.center, AXIS_RPY[shape.axis]))
        xml.SubElement(geometry, "cylinder", radius=number(shape.radius), length=number(shape.length))
    else:
        add_origin(element, Origin(shape.center))
        xml.SubElement(geometry, "sphere", radius=number(shape.radius))


def add_inertial(link: xml.Element, mass: float, inertia: np.ndarray, origin: Origin) -> None:
    """Adds mass and inertia. `origin` is the center of mass with the axes of `inertia` (3x3, kg m^2)."""
    inertial = xml.SubElement(link, "inertial")
    xml.SubElement(inertial, "mass", value=number(mass))
    add_origin(inertial, origin)
    xml.SubElement(inertial, "inertia", {name: number(inertia[index]) for name, index in INERTIA.items()})


def cylinder_inertia(mass: float, radius: float, length: float) -> np.ndarray:
    """Returns the inertia in kg m^2 of a solid cylinder along z about its center."""
    transverse = mass * (3.0 * radius**2 + length**2) / 12.0
    return np.diag([transverse, transverse, mass * radius**2 / 2.0])
