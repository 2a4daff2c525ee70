"""The packages of this checkout, and what changed in them."""

import hashlib
import os
import pathlib
import xml.etree.ElementTree as xml
from dataclasses import dataclass
from typing import Dict, FrozenSet, Iterable, List

from .layout import ROOT

SKIPPED = {"__pycache__", ".pytest_cache", ".git", ".ur", "build", "install", "log"}
DEPENDENCIES = {"depend", "build_depend", "buildtool_depend", "build_export_depend", "exec_depend", "test_depend"}


@dataclass(frozen=True)
class Package:
    name: str
    folder: pathlib.Path
    depends: FrozenSet[str]


def discover(root: pathlib.Path = ROOT) -> Dict[str, Package]:
    """Returns each folder of the root with a package.xml and a build file, in build order."""
    return _packages(sorted(root.glob("*/package.xml")))


def discover_with_interfaces(prefixes: Iterable[str] = (), root: pathlib.Path = ROOT) -> Dict[str, Package]:
    """Returns discover(root) and the interface packages that ROS, installed in these prefixes, does not contain, in build order. The
    wheels contain none of them."""
    def is_installed(name: str) -> bool:
        return any(pathlib.Path(prefix, "share", name, "package.xml").is_file() for prefix in prefixes if prefix)

    interfaces = [path for path in sorted(root.glob("wheels/interfaces/*/package.xml")) if not is_installed(path.parent.name)]
    return _packages([*sorted(root.glob("*/package.xml")), *interfaces])


def _packages(manifests: Iterable[pathlib.Path]) -> Dict[str, Package]:
    found: Dict[str, Package] = {}
    for manifest in manifests:
        folder = manifest.parent
        if not any((folder / name).exists() for name in ("CMakeLists.txt", "setup.py")):
            continue
        tree = xml.parse(manifest).getroot()
        depends = frozenset((node.text or "").strip() for node in tree if node.tag in DEPENDENCIES)
        name = (tree.findtext("name") or folder.name).strip()
        found[name] = Package(name, folder, depends)
    return _in_order(found)


def _in_order(found: Dict[str, Package]) -> Dict[str, Package]:
    ordered: Dict[str, Package] = {}

    def visit(name: str, path: List[str]) -> None:
        if name in ordered:
            return
        if name in path:
            raise ValueError("circular dependency between packages: " + " -> ".join(path + [name]))
        for dependency in sorted(found[name].depends & found.keys()):
            visit(dependency, path + [name])
        ordered[name] = found[name]

    for name in sorted(found):
        visit(name, [])
    return ordered


def with_dependencies(all_packages: Dict[str, Package], names: List[str]) -> Dict[str, Package]:
    """Returns the named packages and their dependencies in this repository, in build order."""
    wanted = set()

    def add(name: str) -> None:
        if name in wanted:
            return
        wanted.add(name)
        for dependency in all_packages[name].depends & all_packages.keys():
            add(dependency)

    for name in names:
        if name not in all_packages:
            raise KeyError(f"no package {name}; there are: {', '.join(all_packages)}")
        add(name)
    return {name: package for name, package in all_packages.items() if name in wanted}


def state(package: Package) -> str:
    """Returns a digest that changes when a file of the package is added, removed or written."""
    digest = hashlib.sha256()
    for folder, subfolders, files in os.walk(package.folder):
        subfolders[:] = sorted(name for name in subfolders if name not in SKIPPED)
        for name in sorted(files):
            path = os.path.join(folder, name)
            info = os.stat(path, follow_symlinks=False)
            digest.update(f"{path}\0{info.st_size}\0{info.st_mtime_ns}\0".encode())
    return digest.hexdigest()
