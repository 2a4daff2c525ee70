"""Lists the plugins that are installed: name, package, what they do."""

import argparse
import pathlib
import xml.etree.ElementTree as xml
from typing import Iterator, Tuple

from ament_index_python import get_resource, get_resources

RESOURCE = "ur_ros_rtde__pluginlib__plugin"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("pattern", nargs="?", default="", help="only those whose name contains this")


def installed() -> Iterator[Tuple[str, str, str]]:
    """Name, package and description."""
    for package in get_resources(RESOURCE):
        content, prefix = get_resource(RESOURCE, package)
        for file in filter(None, map(str.strip, content.splitlines())):
            try:
                tree = xml.parse(pathlib.Path(prefix, file)).getroot()
            except (OSError, xml.ParseError) as error:
                yield "?", package, f"{file} cannot be read: {error}"
                continue
            for entry in tree.iter("class"):
                yield entry.get("name") or entry.get("type", "?"), package, (entry.findtext("description") or "").strip()


def run(options: argparse.Namespace) -> int:
    found = sorted(entry for entry in installed() if options.pattern in entry[0])
    width = max((len(name) for name, _, _ in found), default=0)
    origin = max((len(package) for _, package, _ in found), default=0)
    for name, package, description in found:
        print(f"{name:{width}}  {package:{origin}}  {description}")
    return 0 if found else 1
