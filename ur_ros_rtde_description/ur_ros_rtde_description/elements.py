"""Elements of a URDF."""

import math
import xml.etree.ElementTree as xml

import numpy as np

from .kinematics import Origin
from .shapes import Cylinder, Part, Shape, Shapes

COLORS = {Part.HOUSING: "0.80 0.81 0.83 1", Part.TUBE: "0.69 0.71 0.74 1", Part.LID: "0.47 0.64 0.78 1", Part.RING: "0.17 0.18 0.20 1",
          Part.FLANGE: "0.42 0.44 0.47 1", Part.TOOL: "0.25 0.27 0.30 1"}
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


def add_shapes(link: xml.Element, shapes: Shapes) -> None:
    """Adds the visual and the collision geometry."""
    for shape in shapes:
        visual = xml.SubElement(link, "visual")
        _add_geometry(visual, shape)
        xml.SubElement(xml.SubElement(visual, "material", name=shape.part.value), "color", rgba=COLORS[shape.part])
    for shape in shapes:
        if not shape.part.is_only_visible:
            _add_geometry(xml.SubElement(link, "collision"), shape)


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
