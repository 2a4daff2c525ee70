"""Finds all installed plugins in the ament index, as the driver does."""

import os
import pathlib
import xml.etree.ElementTree as xml
from dataclasses import dataclass

RESOURCE = pathlib.Path("share", "ament_index", "resource_index", "ur_ros_rtde__pluginlib__plugin")


@dataclass(frozen=True)
class Plugin:
    name: str  # name of the action, for example "dashboard/power_on"
    package: str
    dashboard: bool


def _parse_description(prefix, description, package):
    # A file with several <library> elements has no single root element.
    text = (prefix / description).read_text()
    for entry in xml.fromstring(f"<all>{text}</all>").iter("class"):
        yield Plugin(entry.get("name"), package, entry.get("base_class_type").endswith("DashboardPlugin"))


def find():
    """Returns {name: Plugin}. A package in an earlier prefix hides the same package in a later prefix."""
    found, packages = {}, set()
    for prefix in map(pathlib.Path, os.environ["AMENT_PREFIX_PATH"].split(os.pathsep)):
        for resource in sorted((prefix / RESOURCE).glob("*")):
            if resource.name in packages:
                continue
            packages.add(resource.name)
            for description in resource.read_text().split():
                for plugin in _parse_description(prefix, description, resource.name):
                    found[plugin.name] = plugin
    return dict(sorted(found.items()))
