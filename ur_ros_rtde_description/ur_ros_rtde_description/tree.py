"""Evaluates a URDF."""

import xml.etree.ElementTree as xml
from typing import Dict, Mapping, Sequence, Tuple

import numpy as np

from .errors import DescriptionError
from .kinematics import Origin, Vector3, rotation


def _vector(text: str) -> Vector3:
    x, y, z = map(float, text.split())
    return x, y, z


def origin_of(element: xml.Element) -> Origin:
    """Returns the origin of a joint, an inertia or a shape."""
    origin = element.find("origin")
    if origin is None:
        return Origin()
    return Origin(_vector(origin.get("xyz", "0 0 0")), _vector(origin.get("rpy", "0 0 0")))


def joined_links(joint: xml.Element) -> Tuple[str, str]:
    """Returns the names of the parent and the child of a joint; empty where there is none."""
    parent, child = joint.find("parent"), joint.find("child")
    return "" if parent is None else parent.get("link", ""), "" if child is None else child.get("link", "")


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
        parent, child = joined_links(joint)
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
        joint = next(joint for joint in waiting if joined_links(joint)[0] in poses)
        waiting.remove(joint)
        parent, child = joined_links(joint)
        pose = poses[parent] @ origin_of(joint).transform()
        if joint.get("type") != "fixed":  # all movable joints of the arms turn about z
            pose[:3, :3] = pose[:3, :3] @ rotation(2, positions.get(joint.get("name", ""), 0.0))
        poses[child] = pose
    return poses
