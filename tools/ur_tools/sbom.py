"""./ur sbom: writes a software bill of materials in the format CycloneDX, from package.xml, wheels/*.txt and the page with the licences."""

import argparse
import json
import pathlib
import re
import xml.etree.ElementTree as xml
from typing import Any, Dict, List, Set

from . import console, pins
from .layout import ROOT

PAGE = ROOT / "docs" / "internals" / "dependencies.md"
UNKNOWN = "NOASSERTION"
UR_RTDE = pins.FOLDER / "ur_rtde.txt"  # the sources that ur_rtde_vendor builds
_ROW = re.compile(r"^\| (.+) \| (`.+`) \|$", re.M)

Json = Dict[str, Any]


def licences(page: pathlib.Path = PAGE) -> Dict[str, str]:
    """Returns the SPDX expression of each software on the page, by its name there."""
    return {name: licence for licence, names in _ROW.findall(page.read_text()) for name in re.findall(r"`([^`]+)`", names)}


def name_on_page(name: str) -> str:
    """Returns the name of a wheel, a rosdep key or a ROS package on the page."""
    if name.startswith("ros-"):
        return name[len("ros-"):].replace("-", "_")
    if name.startswith("python3-"):
        name = name[len("python3-"):]
    return {"yaml": "pyyaml"}.get(name, name)


def _licence(known: Dict[str, str], name: str) -> str:
    found = known.get(name_on_page(name))
    if found is None:
        raise console.Failure(f"{PAGE.relative_to(ROOT)} has no licence of {name_on_page(name)}: add it to a table there.")
    return found


def _component(name: str, licence: str, **more: Any) -> Json:
    found: Json = {"type": "library", "bom-ref": name, "name": name, **more}
    if licence != UNKNOWN:
        found["licenses"] = [{"expression": licence}]
    return found


def _property(name: str, value: str) -> Json:
    return {"name": f"ur_ros_rtde:{name}", "value": value}


def manifests(root: pathlib.Path = ROOT) -> List[xml.Element]:
    return [xml.parse(file).getroot() for file in sorted(root.glob("*/package.xml"))]


def dependencies(manifest: xml.Element) -> Dict[str, Set[str]]:
    """Returns the dependencies of a package and how each is declared: depend, test_depend."""
    found: Dict[str, Set[str]] = {}
    for node in manifest:
        if node.tag.endswith("depend"):
            found.setdefault((node.text or "").strip(), set()).add(node.tag)
    return found


def _our_packages() -> List[Json]:
    return [_component(manifest.findtext("name") or "", " AND ".join(node.text or "" for node in manifest.findall("license")),
                       version=manifest.findtext("version")) for manifest in manifests()]


def _declared(known: Dict[str, str]) -> List[Json]:
    """The software in package.xml. Its versions are those of the distribution."""
    ours = {manifest.findtext("name") for manifest in manifests()}
    kinds: Dict[str, Set[str]] = {}
    for manifest in manifests():
        for name, tags in dependencies(manifest).items():
            kinds.setdefault(name, set()).update(tags)
    return [_component(name, _licence(known, name), properties=[_property("declared as", tag) for tag in sorted(tags)])
            for name, tags in sorted(kinds.items()) if name not in ours]


def _purl(pin: pins.Pin) -> str:
    return f"pkg:pypi/{pins.normalized(pin.name)}@{pin.version}"


def _pinned(known: Dict[str, str]) -> List[Json]:
    found: Dict[str, Json] = {}
    for file in sorted(pins.FOLDER.glob("*.txt")):
        for pin in pins.read(file):
            name = pins.normalized(pin.name)
            purl = _purl(pin)
            component = found.setdefault(purl, _component(name, _licence(known, name), version=pin.version, purl=purl, hashes=[],
                                                          properties=[]))
            component["bom-ref"] = purl
            component["hashes"] += [{"alg": "SHA-256", "content": digest} for digest in pin.hashes
                                    if digest not in {entry["content"] for entry in component["hashes"]}]
            component["properties"].append(_property("pinned in", f"wheels/{file.name}"))
            if file == UR_RTDE:
                component["pedigree"] = {"patches": _patches()}
    return [found[purl] for purl in sorted(found)]


def _patches() -> List[Json]:
    return [{"type": "unofficial", "diff": {"url": str(patch.relative_to(ROOT))}}
            for patch in sorted((ROOT / "ur_rtde_vendor" / "patches").glob("*.patch"))]


def _uses(manifest: xml.Element) -> Json:
    name = manifest.findtext("name")
    built = [_purl(pin) for pin in pins.read(UR_RTDE)] if name == "ur_rtde_vendor" else []
    return {"ref": name, "dependsOn": sorted([*dependencies(manifest), *built])}


def bill_of_materials() -> Json:
    known = licences()
    version = next(manifest.findtext("version") for manifest in manifests() if manifest.findtext("name") == "ur_ros_rtde")
    return {
        "bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1,
        "metadata": {"component": {"type": "application", "bom-ref": "project", "name": "ur_ros_rtde", "version": version,
                                   "licenses": [{"expression": "Apache-2.0"}]}},
        "components": [*_our_packages(), *_declared(known), *_pinned(known)],
        "dependencies": [_uses(manifest) for manifest in manifests()]}


def run(options: argparse.Namespace) -> int:
    text = json.dumps(bill_of_materials(), indent=2) + "\n"
    if options.output is None:
        print(text, end="")
        return 0
    options.output.write_text(text)
    console.line(f"{options.output} has the bill of materials.")
    return 0
