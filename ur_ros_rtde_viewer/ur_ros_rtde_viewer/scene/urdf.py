"""Reads what is drawn from a URDF: links with their shapes, and the joints between them."""

import math
import xml.etree.ElementTree as xml
from dataclasses import dataclass
from typing import List, Optional, Tuple, Union

import numpy as np
from ur_ros_rtde_description.errors import DescriptionError
from ur_ros_rtde_description.kinematics import Origin
from ur_ros_rtde_description.tree import joined_links, origin_of

Color = Tuple[int, int, int]
GRAY = (190, 190, 190)


@dataclass(frozen=True)
class Cylinder:
    """Along z."""

    radius: float
    length: float


@dataclass(frozen=True)
class Sphere:
    radius: float


@dataclass(frozen=True)
class Box:
    size: Tuple[float, float, float]


@dataclass(frozen=True)
class Shape:
    geometry: Union[Cylinder, Sphere, Box]
    position: np.ndarray  # m, in the link
    wxyz: np.ndarray
    color: Color


@dataclass(frozen=True)
class Link:
    name: str
    shapes: Tuple[Shape, ...]


@dataclass(frozen=True)
class Joint:
    """A joint that turns about its z axis, or a fixed joint."""

    name: str
    parent: str
    child: str
    position: np.ndarray  # m, of the child in the parent at joint position 0
    wxyz: np.ndarray
    is_fixed: bool


@dataclass(frozen=True)
class Description:
    root: str
    links: Tuple[Link, ...]
    joints: Tuple[Joint, ...]  # from the root outwards


def quaternion(origin: Origin) -> np.ndarray:
    """Returns the orientation of an origin as wxyz."""
    roll, pitch, yaw = (0.5 * angle for angle in origin.rpy)
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(half), math.sin(half)) for half in (roll, pitch, yaw))
    return np.array((cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy,
                     cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy))


def read_description(text: str) -> Description:
    """Reads a URDF of ur_ros_rtde_description. Meshes of tools are left out. Raises DescriptionError if a shape or a joint of a tool is
    invalid."""
    robot = xml.fromstring(text)
    links = tuple(Link(link.get("name", ""), tuple(_shapes(link))) for link in robot.findall("link"))
    joints = [_joint(element) for element in robot.findall("joint")]
    children = {joint.child for joint in joints}
    root = next(link.name for link in links if link.name not in children)
    return Description(root, links, tuple(_from_root(root, joints)))


def _shapes(link: xml.Element) -> List[Shape]:
    found = []
    for visual in link.findall("visual"):
        try:
            geometry, origin, color = _geometry(visual.find("geometry")), origin_of(visual), _color(visual)
        except ValueError:
            raise DescriptionError(f"link {link.get('name')}: a visual element has a value that is missing or no number") from None
        if geometry is not None:
            found.append(Shape(geometry, np.array(origin.xyz), quaternion(origin), color))
    return found


def _geometry(element: Optional[xml.Element]) -> Union[Cylinder, Sphere, Box, None]:
    for shape in element if element is not None else ():
        if shape.tag == "cylinder":
            return Cylinder(float(shape.get("radius", "")), float(shape.get("length", "")))
        if shape.tag == "sphere":
            return Sphere(float(shape.get("radius", "")))
        if shape.tag == "box":
            x, y, z = map(float, shape.get("size", "").split())
            return Box((x, y, z))
    return None


def _color(visual: xml.Element) -> Color:
    color = visual.find("material/color")
    if color is None:
        return GRAY
    red, green, blue = (round(255 * float(part)) for part in color.get("rgba", "").split()[:3])
    return red, green, blue


def _joint(element: xml.Element) -> Joint:
    name = element.get("name", "")
    try:
        origin = origin_of(element)
    except ValueError:
        raise DescriptionError(f"joint {name}: its origin has a value that is missing or no number") from None
    parent, child = joined_links(element)
    return Joint(name, parent, child, np.array(origin.xyz), quaternion(origin), element.get("type") == "fixed")


def _from_root(root: str, joints: List[Joint]) -> List[Joint]:
    ordered: List[Joint] = []
    reached = {root}
    while len(ordered) < len(joints):
        step = [joint for joint in joints if joint.parent in reached and joint.child not in reached]
        if not step:
            lost = next(joint for joint in joints if not any(joint is other for other in ordered))
            raise DescriptionError(f"joint {lost.name}: {lost.parent} is not connected to {root}, or {lost.child} has two parents")
        ordered += step
        reached |= {joint.child for joint in step}
    return ordered
