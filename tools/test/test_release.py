"""What the release of each package as a package of a distribution needs: bloom releases each without the rest of the repository."""

import re

import pytest
from catkin_pkg.package import parse_package
from ur_tools.layout import ROOT

BACKGROUND = True
CHANGELOG = r"\^+\nChangelog for package (\S+)\n\^+\n\n(.+?)\n-+\n(.*)"
FOLDERS = sorted(path.parent for path in ROOT.glob("*/package.xml"))


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_each_package_has_its_license_and_changes(folder):
    package = parse_package(str(folder / "package.xml"))
    assert package.licenses[0].file == "LICENSE" and (folder / "LICENSE").read_text() == (ROOT / "LICENSE").read_text()
    title, newest, changes = re.fullmatch(CHANGELOG, (folder / "CHANGELOG.rst").read_text(), re.S).groups()
    assert title == package.name and newest.split()[0] in ("Forthcoming", package.version) and changes.startswith("* ")


def test_the_packages_are_released_together():
    assert len({parse_package(str(folder / "package.xml")).version for folder in FOLDERS}) == 1
