"""Builds the URDF of an arm."""

import math
import xml.etree.ElementTree as xml
from dataclasses import dataclass, field
from typing import Optional, Sequence

from .elements import add_fixed_joint, add_inertial, add_joint, add_origin, add_shapes, cylinder_inertia, number
from .kinematics import Origin, mass_frame, nominal_origins
from .models import JOINTS, LINKS, Model
from .shapes import base_height, link_shapes
from .tool import Tool

FRAMES = ("base_link", "base", "flange", "tool0", "ft_frame")  # links without geometry
ARM_LINKS = (*FRAMES, "base_link_inertia", *LINKS)
FIXED_JOINTS = ("base_joint", "base_link-base_link_inertia", "base_link-base_fixed_joint", "wrist_3-flange", "flange-tool0",
                "wrist_3_link-ft_frame")
POSITION_LIMIT = 2.0 * math.pi  # rad, of all joints that are not continuous, except the elbow
# As in ur_description. The controller allows 2 pi, but the arm itself blocks the elbow at about pi: planners would search for paths between
# parts of the space that are not connected (ros-industrial/universal_robot#265).
ELBOW_LIMIT = math.pi  # rad
XACRO = "http://www.ros.org/wiki/xacro"


@dataclass(frozen=True)
class Options:
    model: Model
    tf_prefix: str = ""
    origins: Optional[Sequence[Origin]] = None  # of the joints, from a calibration; None: nominal
    parent: str = "world"  # link on which the arm is mounted; empty: base_link is the root
    mount: Origin = field(default_factory=Origin)  # pose of base_link in `parent`
    tool: Optional[Tool] = None


def make_urdf(options: Options) -> str:
    """Returns the URDF as text."""
    robot = xml.Element("robot", name=options.model.name)
    if options.parent:
        xml.SubElement(robot, "link", name=options.parent)
        add_fixed_joint(robot, options.tf_prefix + "base_joint", options.parent, options.tf_prefix + "base_link", options.mount)
    _add_arm(robot, options)
    return _text(robot)


def make_xacro(options: Options) -> str:
    """Returns a xacro file with a macro that mounts the arm on a link of a cell.

    The macro has the name of the model, the parameters `parent` and `tf_prefix` and a block `origin`, which replace those of `options`.
    """
    robot = xml.Element("robot", {"xmlns:xacro": XACRO})
    macro = xml.SubElement(robot, "xacro:macro", name=options.model.name, params="parent tf_prefix:='' *origin")
    prefix = "${tf_prefix}"
    mount = add_joint(macro, prefix + "base_joint", "fixed", "${parent}", prefix + "base_link")
    xml.SubElement(mount, "xacro:insert_block", name="origin")
    _add_arm(macro, Options(options.model, prefix, options.origins, tool=options.tool))
    return _text(robot)


def _text(robot: xml.Element) -> str:
    xml.indent(robot)
    return '<?xml version="1.0"?>\n' + xml.tostring(robot, encoding="unicode") + "\n"


def _add_arm(robot: xml.Element, options: Options) -> None:
    _add_links(robot, options)
    _add_frames(robot, options.tf_prefix)
    _add_joints(robot, options)
    if options.tool is not None:
        options.tool.add_to(robot, options.tf_prefix)


def _add_links(robot: xml.Element, options: Options) -> None:
    model = options.model
    for name, shapes in link_shapes(model).items():
        link = xml.SubElement(robot, "link", name=options.tf_prefix + name)
        add_shapes(link, shapes)
        if name in LINKS:
            index = LINKS.index(name)
            add_inertial(link, model.links[index].mass, model.links[index].inertia, mass_frame(model, index))
        else:
            inertia = cylinder_inertia(model.base_mass, model.base_radius, base_height(model))
            add_inertial(link, model.base_mass, inertia, Origin((0.0, 0.0, base_height(model) / 2.0)))


def _add_frames(robot: xml.Element, prefix: str) -> None:
    for name in FRAMES:
        xml.SubElement(robot, "link", name=prefix + name)

    def fix(name: str, parent: str, child: str, roll: float, pitch: float, yaw: float) -> None:
        add_fixed_joint(robot, prefix + name, prefix + parent, prefix + child, Origin(rpy=(roll, pitch, yaw)))

    quarter = math.pi / 2.0
    # base_link follows REP 103: x points forward. The x axis of the controller's frame points backward.
    fix("base_link-base_link_inertia", "base_link", "base_link_inertia", 0.0, 0.0, math.pi)
    fix("base_link-base_fixed_joint", "base_link", "base", 0.0, 0.0, math.pi)
    fix("wrist_3-flange", "wrist_3_link", "flange", 0.0, -quarter, -quarter)
    fix("flange-tool0", "flange", "tool0", quarter, 0.0, quarter)
    fix("wrist_3_link-ft_frame", "wrist_3_link", "ft_frame", math.pi, 0.0, 0.0)


def _add_joints(robot: xml.Element, options: Options) -> None:
    model, prefix = options.model, options.tf_prefix
    parents = ("base_link_inertia", *LINKS)
    for index, (name, origin) in enumerate(zip(JOINTS, options.origins or nominal_origins(model))):
        continuous = model.continuous_wrist_3 and index == 5
        joint = add_joint(robot, prefix + name, "continuous" if continuous else "revolute", prefix + parents[index],
                          prefix + LINKS[index])
        add_origin(joint, origin)
        xml.SubElement(joint, "axis", xyz="0 0 1")
        limit = xml.SubElement(joint, "limit", effort=number(model.max_torque[index]), velocity=number(model.max_velocity[index]))
        if not continuous:
            largest = ELBOW_LIMIT if name == "elbow_joint" else POSITION_LIMIT
            limit.set("lower", number(-largest))
            limit.set("upper", number(largest))
