"""Ament prefixes with plugin packages."""

import os
import shutil


def create_plugin_prefix(prefix, package, description, libraries=()):
    """Creates an ament prefix with one plugin package: its plugin description and libraries. Returns the prefix."""
    index = prefix / "share" / "ament_index" / "resource_index"
    for kind, content in (("ur_ros_rtde__pluginlib__plugin", f"share/{package}/plugins.xml\n"), ("packages", "")):
        (index / kind).mkdir(parents=True, exist_ok=True)
        (index / kind / package).write_text(content)
    (prefix / "share" / package).mkdir(parents=True)
    (prefix / "share" / package / "plugins.xml").write_text(description)
    (prefix / "lib").mkdir(exist_ok=True)
    for library in libraries:
        shutil.copy(library, prefix / "lib")
    return prefix


def prepend_path(variable, folder):
    """Returns {variable: value} with the folder in front of the current value of a path variable."""
    return {variable: os.pathsep.join([str(folder), os.environ.get(variable, "")])}
