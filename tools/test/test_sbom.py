"""The page with the licences names all dependencies and agrees with their metadata; `./ur sbom` contains them."""

import importlib.metadata
import json
import pathlib
import sys
import xml.etree.ElementTree as xml

import pytest
from ur_tools import console, packages, pins, sbom
from ur_tools.layout import ROOT, Layout

BACKGROUND = True
KNOWN = sbom.licences()
BILL = sbom.bill_of_materials()
COMPONENTS = {component["bom-ref"]: component for component in BILL["components"]}
# How package.xml and classifiers of Python packages state licences, and what the SPDX expression then contains.
STATED = {"Apache": "Apache-2.0", "BSD": "BSD", "MIT": "MIT", "Mozilla": "MPL-2.0", "Python Software Foundation": "PSF-2.0", "zlib": "Zlib"}
EXCEPTIONS = {"matplotlib": "LicenseRef-matplotlib"}


def pinned():
    return {pin for file in pins.FOLDER.glob("*.txt") for pin in pins.read(file)}


def declared():
    ours = packages.discover(ROOT)
    return {name for manifest in sbom.manifests() for name in sbom.dependencies(manifest)} - set(ours)


def agrees(licence, stated):
    return all(spdx in licence for text, spdx in STATED.items() if text.lower() in stated.lower())


def test_the_page_names_exactly_the_dependencies():
    used = {sbom.name_on_page(pins.normalized(pin.name)) for pin in pinned()} | {sbom.name_on_page(name) for name in declared()}
    assert used == set(KNOWN)


def installed_packages():
    for name in sorted({pins.normalized(pin.name) for pin in pinned() if not pin.name.startswith("ros-")}):
        try:
            yield name, importlib.metadata.metadata(name)
        except importlib.metadata.PackageNotFoundError:
            continue  # of another environment


def test_the_licences_of_installed_python_packages_are_those_of_their_metadata():
    found = list(installed_packages())
    assert len(found) > 20
    for name, metadata in found:
        expression = metadata.get("License-Expression")
        classifiers = " ".join(text for text in metadata.get_all("Classifier") or [] if text.startswith("License"))
        assert KNOWN[name] == (expression or KNOWN[name]), name
        assert name in EXCEPTIONS or agrees(KNOWN[name], classifiers), f"{name}: {classifiers}"


@pytest.mark.skipif(Layout.of_environment().is_installed, reason="compares the wheels")
def test_the_licences_of_the_ros_wheels_are_those_of_their_manifests():
    manifests = {name: pathlib.Path(sys.prefix, "share", name, "package.xml") for name in KNOWN}
    found = {name: xml.parse(file).getroot() for name, file in manifests.items() if file.is_file()}
    assert len(found) > 50
    for name, manifest in found.items():
        for node in manifest.findall("license"):
            assert agrees(KNOWN[name], node.text), f"{name}: {node.text}"


def test_the_bill_contains_every_dependency_with_its_hashes():
    for pin in pinned():
        component = COMPONENTS[f"pkg:pypi/{pins.normalized(pin.name)}@{pin.version}"]
        assert set(pin.hashes) <= {entry["content"] for entry in component["hashes"]}, pin.requirement
    assert declared() <= set(COMPONENTS) and set(packages.discover(ROOT)) <= set(COMPONENTS)


def test_references_exist_once():
    assert len(COMPONENTS) == len(BILL["components"])
    for entry in BILL["dependencies"]:
        assert {entry["ref"], *entry["dependsOn"]} <= set(COMPONENTS)


def test_the_bill_names_the_patches_of_ur_rtde():
    uses, = (entry["dependsOn"] for entry in BILL["dependencies"] if entry["ref"] == "ur_rtde_vendor")
    ur_rtde, = (name for name in uses if name.startswith("pkg:pypi/ur-rtde@"))
    patches = COMPONENTS[ur_rtde]["pedigree"]["patches"]
    assert len(patches) == len(list((ROOT / "ur_rtde_vendor" / "patches").glob("*.patch"))) > 0


def test_a_dependency_without_a_licence_is_named(monkeypatch):
    monkeypatch.setattr(sbom, "licences", lambda: {name: licence for name, licence in KNOWN.items() if name != "numpy"})
    with pytest.raises(console.Failure, match="no licence of numpy: add it"):
        sbom.bill_of_materials()


def test_it_is_written_to_the_output_or_a_file(run_without_build, tmp_path):
    status, printed = run_without_build("sbom")
    assert status == 0 and json.loads(printed) == BILL
    assert run_without_build("sbom", "--output", tmp_path / "bom.json")[0] == 0
    assert json.loads((tmp_path / "bom.json").read_text()) == BILL
