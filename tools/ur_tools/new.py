"""./ur new: creates a package with a working plugin from a template."""

import pathlib
import re
from typing import Dict

from . import say
from .layout import ROOT

TEMPLATES = ROOT / "tools" / "templates"
KINDS = tuple(sorted(path.name for path in TEMPLATES.iterdir() if path.is_dir()))
_NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")


def _checked(what: str, name: str) -> str:
    if not _NAME.fullmatch(name):
        raise say.Failure(f"{what} is \"{name}\": it must be lower case letters, digits and single underscores and begin with a "
                          "letter, as in pick_part")
    return name


def _snake(pascal: str) -> str:
    """Returns the name that rosidl gives the header of an interface."""
    return re.sub("([a-z0-9])([A-Z])", r"\1_\2", re.sub("(.)([A-Z][a-z]+)", r"\1_\2", pascal)).lower()


def _pascal(name: str) -> str:
    pascal = "".join(part.capitalize() for part in name.split("_"))
    if _snake(pascal) != name:
        raise say.Failure(f"the name is \"{name}\": rosidl names the header of its interface {pascal} {_snake(pascal)}; use that name")
    return pascal


def _words(name: str, package: str) -> Dict[str, str]:
    """Returns the placeholders of the templates with their replacements."""
    return {"my_package": package, "my_command": name, "MyCommand": _pascal(name)}


def _filled(text: str, words: Dict[str, str]) -> str:
    return re.sub("|".join(words), lambda match: words[match.group()], text)


def create(kind: str, name: str, package: str, folder: pathlib.Path) -> pathlib.Path:
    """Creates the package in the existing `folder`. Returns its path."""
    words = _words(_checked("the name", name), _checked("the package", package or f"{name}_{kind}"))
    target = folder / words["my_package"]
    if not folder.is_dir():
        raise say.Failure(f"there is no folder {folder}; create it, or choose another with --directory")
    if target.exists():
        raise say.Failure(f"{target} exists already; remove it, or choose another name with --package")
    for source in sorted(path for path in (TEMPLATES / kind).rglob("*") if path.is_file()):
        file = target / _filled(str(source.relative_to(TEMPLATES / kind)), words)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(_filled(source.read_text(), words))
    return target


def _purpose(file: pathlib.Path, kind: str) -> str:
    """Returns what the author changes in a file; empty for files that need no change."""
    if file.suffix == ".action":
        return "what it does, and its fields; `ur plugins` shows the first sentence"
    if file.suffix == ".cpp":
        return "the code"
    if kind == "dashboard" and file.name == "package.xml":
        return "<description>: what it does; `ur plugins` shows it"
    return ""


def run(kind: str, name: str, package: str, folder: pathlib.Path) -> int:
    target = create(kind, name, package, folder)
    files = sorted((path for path in target.rglob("*") if path.is_file()), key=lambda path: not _purpose(path, kind))
    width = max(len(str(file.relative_to(folder))) for file in files)
    for file in files:
        say.line(f"    {str(file.relative_to(folder)):{width}}  {_purpose(file, kind)}".rstrip())
    say.line("Only the files with a remark need changes. `colcon build` in the workspace builds the package (in `./ur shell` where no ROS is "
             "installed); docs/writing_a_plugin.md continues from there.")
    return 0
