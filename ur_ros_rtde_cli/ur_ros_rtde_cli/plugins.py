"""Lists the installed plugins with name, package and description.

The description of a plugin is the <description> in its plugins.xml. If there is none, it is the first sentence of its .action
file. If the plugin has no action of its own, it is the description of its package.
"""

import argparse
import pathlib
import re
import xml.etree.ElementTree as xml
from typing import Iterator, List, NamedTuple, Optional, Tuple

RESOURCE = "ur_ros_rtde__pluginlib__plugin"


class Plugin(NamedTuple):
    """A <class> element in plugins.xml."""

    name: str
    package: str
    description: str
    action: str  # type of its action if that does not have the name of the plugin: "ur_ros_rtde_msgs/action/Trigger"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("pattern", nargs="?", default="", help="list only plugins whose name contains this text")


def installed() -> Iterator[Plugin]:
    from ament_index_python import get_resource, get_resources  # imported here because --help does not need ROS
    for package in get_resources(RESOURCE):
        content, prefix = get_resource(RESOURCE, package)
        for file in filter(None, map(str.strip, content.splitlines())):
            try:
                tree = xml.parse(pathlib.Path(prefix, file)).getroot()
            except (OSError, xml.ParseError) as error:
                yield Plugin("?", package, f"{file} cannot be read: {error}", "")
                continue
            for entry in tree.iter("class"):
                yield Plugin(entry.get("name", "") or entry.get("type", "?"), package, (entry.findtext("description") or "").strip(),
                             entry.get("action", ""))


def action_type(name: str, package: str) -> Optional[Tuple[str, str]]:
    """Returns package and name of the action type with the name of the plugin, in its package or the matching _msgs package.

    For example, ("ur_ros_rtde_msgs", "MoveJ") for the plugin "move_j" of ur_ros_rtde_commands. Returns None for a plugin that shares
    its action type with others.
    """
    wanted = re.sub("[_/]", "", name).lower()
    for candidate in (package, f"{package}_msgs", package.replace("_commands", "_msgs")):
        found = [action for action in _actions(candidate) if action.lower() == wanted]
        if len(found) == 1:
            return candidate, found[0]
    return None


def _actions(package: str) -> List[str]:
    from ament_index_python import get_resource
    try:
        content, _ = get_resource("rosidl_interfaces", package)
    except LookupError:
        return []
    return sorted(set(re.findall(r"^action/(\w+)\.(?:action|idl)$", content, re.M)))


def _description(name: str, package: str) -> str:
    """Returns the description of a plugin without one in plugins.xml."""
    from ament_index_python import get_package_share_directory
    action = action_type(name, package)
    try:
        if action is not None:
            text = pathlib.Path(get_package_share_directory(action[0]), "action", f"{action[1]}.action").read_text()
            comment = re.match(r"(?:#.*\n)+", text)
            if comment is not None:
                joined = " ".join(line.strip("# ") for line in comment.group().splitlines())
                return re.split(r"(?<=\.)\s", joined)[0].rstrip(".")
        manifest = xml.parse(pathlib.Path(get_package_share_directory(package), "package.xml")).getroot()
        return (manifest.findtext("description") or "").strip().rstrip(".")
    except (OSError, xml.ParseError):
        return ""


def run(options: argparse.Namespace) -> int:
    found = sorted((plugin.name, plugin.package, plugin.description or _description(plugin.name, plugin.package))
                   for plugin in installed() if options.pattern in plugin.name)
    width = max((len(name) for name, _, _ in found), default=0)
    package_width = max((len(package) for _, package, _ in found), default=0)
    for name, package, description in found:
        print(f"{name:{width}}  {package:{package_width}}  {description}")
    return 0 if found else 1
