#!/usr/bin/env python3
"""Checks that rosdep resolves every dependency in our package.xml files, for each ROS 2 distribution and its Ubuntu version.

    git clone --depth 1 https://github.com/ros/rosdistro
    tools/ros_checks/rosdep_keys.py rosdistro
"""

import pathlib
import sys
import xml.etree.ElementTree as xml

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
DISTRIBUTIONS = ("humble", "jazzy", "kilted", "lyrical", "rolling")


def our_packages():
    return {xml.parse(file).findtext("name"): file for file in sorted(ROOT.glob("*/package.xml"))}


def dependencies(file, distribution):
    for node in xml.parse(file).getroot():
        condition = node.get("condition", "").replace("$ROS_DISTRO != ", "")
        if node.tag.endswith("depend") and condition != distribution:
            yield (node.text or "").strip()


def rosdep_keys(rosdistro):
    keys = {}
    for name in ("base", "python"):
        keys.update(yaml.safe_load((rosdistro / "rosdep" / f"{name}.yaml").read_text()))
    return keys


def ros_packages(distribution):
    return {package for name, repository in distribution["repositories"].items()
            for package in repository.get("release", {}).get("packages", [name])}


def ubuntu_package(rule, codename):
    """Returns the Debian package of a rosdep rule for an Ubuntu version; None if there is none."""
    found = (rule or {}).get("ubuntu")
    if isinstance(found, dict):
        found = found.get(codename, found.get("*"))
    return found


def main():
    if len(sys.argv) != 2 or not (pathlib.Path(sys.argv[1]) / "rosdep" / "base.yaml").is_file():
        sys.exit(__doc__)
    rosdistro = pathlib.Path(sys.argv[1])
    ours, keys, missing = our_packages(), rosdep_keys(rosdistro), 0
    for name in DISTRIBUTIONS:
        distribution = yaml.safe_load((rosdistro / name / "distribution.yaml").read_text())
        codename = distribution["release_platforms"]["ubuntu"][0]
        wanted = {key for file in ours.values() for key in dependencies(file, name)}
        for key in sorted(wanted - ros_packages(distribution) - set(ours)):
            package = ubuntu_package(keys.get(key), codename)
            print(f"{name:8} {codename:9} {key:22} {package or 'MISSING'}")
            missing += not package
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
