"""Tools on the flange of the arm."""

import copy
import math
import pathlib
import xml.etree.ElementTree as xml
from dataclasses import dataclass
from typing import Protocol, Sequence

from .elements import add_fixed_joint, add_inertial, add_shapes, cylinder_inertia
from .errors import DescriptionError
from .kinematics import Origin
from .shapes import Part, along
from .tree import root_link


class Tool(Protocol):
    def link_names(self) -> Sequence[str]:
        """Returns the names of its links, without prefix."""

    def add_to(self, robot: xml.Element, tf_prefix: str) -> None:
        """Adds the tool to tool0."""


@dataclass(frozen=True)
class CylinderTool:
    """A cylinder from the flange along z of tool0. The frame tool_tip is at its end."""

    length: float  # m
    radius: float  # m
    mass: float  # kg

    def __post_init__(self) -> None:
        for name, unit in (("length", "m"), ("radius", "m")):
            value = getattr(self, name)
            if not (math.isfinite(value) and 0.0 < value <= 5.0):
                raise DescriptionError(f"tool_{name} is {value:g}, it must be above 0 and at most 5 {unit}")
        if not (math.isfinite(self.mass) and 0.0 <= self.mass <= 200.0):
            raise DescriptionError(f"tool_mass is {self.mass:g}, it must be from 0 to 200 kg")

    def link_names(self) -> Sequence[str]:
        return "tool", "tool_tip"

    def add_to(self, robot: xml.Element, tf_prefix: str) -> None:
        link = xml.SubElement(robot, "link", name=tf_prefix + "tool")
        add_shapes(link, [along("z", 0.0, self.length, self.radius, part=Part.TOOL)])
        if self.mass > 0.0:
            inertia = cylinder_inertia(self.mass, self.radius, self.length)
            add_inertial(link, self.mass, inertia, Origin((0.0, 0.0, self.length / 2.0)))
        xml.SubElement(robot, "link", name=tf_prefix + "tool_tip")
        add_fixed_joint(robot, tf_prefix + "tool0-tool", tf_prefix + "tool0", tf_prefix + "tool", Origin())
        add_fixed_joint(robot, tf_prefix + "tool-tool_tip", tf_prefix + "tool", tf_prefix + "tool_tip", Origin((0.0, 0.0, self.length)))


# The attributes of a tool that name its links, joints and other parts, by element. Those below <gazebo> belong to its plugins.
NAMES = {"link": "name", "joint": "name", "parent": "link", "child": "link", "mimic": "joint", "gazebo": "reference",
         "transmission": "name", "actuator": "name", "ros2_control": "name", "sensor": "name", "gpio": "name"}


@dataclass(frozen=True)
class UrdfTool:
    """A tool from a URDF file. Its root link is attached to tool0; the names of its parts receive the prefix of the arm."""

    robot: xml.Element
    root: str

    def link_names(self) -> Sequence[str]:
        return [link.get("name", "") for link in self.robot.findall("link")]

    def add_to(self, robot: xml.Element, tf_prefix: str) -> None:
        for element in self.robot:
            added = copy.deepcopy(element)
            for part in [added] if added.tag == "gazebo" else added.iter():
                attribute = NAMES.get(part.tag, "")
                if attribute in part.attrib:
                    part.set(attribute, tf_prefix + part.attrib[attribute])
                elif part.tag == "param" and part.get("name") == "mimic":  # of a joint of <ros2_control>, before Jazzy
                    part.text = tf_prefix + (part.text or "").strip()
            robot.append(added)
        add_fixed_joint(robot, f"{tf_prefix}tool0-{self.root}", tf_prefix + "tool0", tf_prefix + self.root, Origin())


def read_tool(file: pathlib.Path, names_of_arm: frozenset) -> UrdfTool:
    """Reads a tool. Raises DescriptionError if the file is not the URDF of a tree of links, or uses a name of the arm."""
    try:
        text = file.read_text()
        robot = xml.fromstring(text)
    except (OSError, UnicodeDecodeError) as error:
        raise DescriptionError(f"tool is \"{file}\": {getattr(error, 'strerror', None) or 'not a text file'}") from None
    except xml.ParseError as error:
        raise DescriptionError(f"{file}: not XML: {error}") from None
    if "www.ros.org/wiki/xacro" in text:
        raise DescriptionError(f"{file} is a xacro file; convert it first: xacro {file} > {file.with_suffix('').with_suffix('.urdf')}")
    if robot.tag != "robot":
        raise DescriptionError(f"{file}: the element is <{robot.tag}>, it must be <robot> with the links and joints of the tool")
    for element in robot:
        if element.tag in ("link", "joint") and element.get("name", "") in names_of_arm | {""}:
            raise DescriptionError(f"{file}: a {element.tag} has the name \"{element.get('name', '')}\", it must have a name that the "
                                   "arm does not use")
    try:
        return UrdfTool(robot, root_link(robot))
    except DescriptionError as error:
        raise DescriptionError(f"{file}: {error}") from None
