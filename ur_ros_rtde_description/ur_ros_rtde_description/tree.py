"""Evaluates a URDF."""

import xml.etree.ElementTree as xml
from typing import Dict, Mapping, Sequence

import numpy as np

from .errors import DescriptionError
from .kinematics import Origin, rotation


def origin_of(element: xml.Element) -> Origin:
    """Returns the origin of a joint, an inertia or a shape."""
    origin = element.find("origin")
    if origin is None:
        return Origin()
    xyz, rpy = (tuple(map(float, origin.get(name, "0 0 0").split())) for name in ("xyz", "rpy"))
    return Origin(xyz, rpy)


def root_link(robot: xml.Element) -> str:
    """Returns the link that is no child of a joint. Raises DescriptionError unless the joints connect all links into one tree."""
    links = [link.get("name", "") for link in robot.findall("link")]
    for link in links:
        if links.count(link) > 1:
            raise DescriptionError(f"there are {links.count(link)} links with the name \"{link}\"")
    parents = _parents(robot, links)
    roots = [link for link in links if link not in parents]
    if len(roots) != 1:
        raise DescriptionError(f"{len(roots)} links have no parent ({', '.join(roots)}), exactly one must have none")
    for link in links:
        ancestor = link
        for _ in links:
            ancestor = parents.get(ancestor, ancestor)
        if ancestor != roots[0]:
            raise DescriptionError(f"the link {link} is part of a loop")
    return roots[0]


def _parents(robot: xml.Element, links: Sequence[str]) -> Dict[str, str]:
    """Returns the parent of each link that has one."""
    parents: Dict[str, str] = {}
    for joint in robot.findall("joint"):
        ends = [joint.find(end) for end in ("parent", "child")]
        parent, child = ("" if end is None else end.get("link", "") for end in ends)
        for link in (parent, child):
            if link not in links:
                raise DescriptionError(f"joint {joint.get('name')} connects the link \"{link}\", which does not exist")
        if child in parents:
            raise DescriptionError(f"the link {child} has two parents")
        parents[child] = parent
    return parents


def link_poses(robot: xml.Element, positions: Mapping[str, float]) -> Dict[str, np.ndarray]:
    """Returns the poses of all links in the root link as 4x4 matrices. Joints without a position are at 0."""
    poses = {root_link(robot): np.eye(4)}
    waiting = list(robot.findall("joint"))
    while waiting:
        joint = next(joint for joint in waiting if joint.find("parent").get("link") in poses)
        waiting.remove(joint)
        pose = poses[joint.find("parent").get("link")] @ origin_of(joint).transform()
        if joint.get("type") != "fixed":  # all movable joints of the arms turn about z
            pose[:3, :3] = pose[:3, :3] @ rotation(2, positions.get(joint.get("name"), 0.0))
        poses[joint.find("child").get("link")] = pose
    return poses
