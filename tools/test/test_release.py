"""What the release of each package as a package of a distribution needs: bloom releases each without the rest of the repository."""

import re

from catkin_pkg.package import parse_package
from ur_tools.layout import ROOT

BACKGROUND = True
CHANGELOG = r"\^+\nChangelog for package (\S+)\n\^+\n\n(.+?)\n-+\n(.*)"
FOLDERS = sorted(path.parent for path in ROOT.glob("*/package.xml"))


def problem(folder):
    """Returns what a package lacks."""
    package = parse_package(str(folder / "package.xml"))
    if package.licenses[0].file != "LICENSE" or (folder / "LICENSE").read_text() != (ROOT / "LICENSE").read_text():
        return "LICENSE"
    changes = re.fullmatch(CHANGELOG, (folder / "CHANGELOG.rst").read_text(), re.S)
    if changes is None or changes[1] != package.name or changes[2].split()[0] not in ("Forthcoming", package.version):
        return "title of CHANGELOG.rst"
    return "" if changes[3].startswith("* ") else "changes in CHANGELOG.rst"


def test_each_package_has_its_license_and_changes():
    assert {folder.name: problem(folder) for folder in FOLDERS if problem(folder)} == {}


def test_the_packages_are_released_together():
    assert len({parse_package(str(folder / "package.xml")).version for folder in FOLDERS}) == 1
