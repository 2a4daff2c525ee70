"""Creates a package with a plugin: a command, a dashboard command or an extension."""

import argparse
import keyword
import pathlib
import re
from typing import Dict
from xml.sax.saxutils import escape

from .actions import plugin_names
from .errors import CliError, OperationFailed
from .interface_files import header_name, prefixes

TEMPLATES = pathlib.Path(__file__).parent / "templates"
# Folders of templates of each kind of plugin, and the default description.
KINDS = {"command": ("own_action", "command"), "dashboard": ("dashboard",), "extension": ("own_action", "extension")}
DESCRIPTIONS = {"command": "Turns wrist 3 by an angle and back",
                "dashboard": "Shows a text on the teach pendant and asks for the robot mode",
                "extension": "Turns wrist 3 by an angle, by a program on the controller"}
ROBOT_MEMBERS = ("close", "modes", "record", "start", "state", "stream")  # of ur_ros_rtde.Robot, whose other methods are the commands
_NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")


def _checked(what: str, name: str) -> str:
    if not _NAME.fullmatch(name):
        raise CliError(f"{what} is \"{name}\": it must be lower case letters, digits and single underscores and begin with a "
                       "letter, as in pick_part")
    return name


def _method(kind: str, name: str) -> str:
    """The name of a plugin is that of its method in Python."""
    if keyword.iskeyword(name):
        raise CliError(f"the name is \"{name}\": Python has no method of this name; choose another, as in {name}_part")
    if kind != "dashboard" and name in ROBOT_MEMBERS:
        raise CliError(f"the name is \"{name}\": Robot.{name} of ur_ros_rtde is something else; choose another, as in {name}_part")
    return _checked("the name", name)


def _pascal(name: str) -> str:
    pascal = "".join(part.capitalize() for part in name.split("_"))
    if header_name(pascal) != name:
        raise CliError(f"the name is \"{name}\": rosidl names the header of its interface {pascal} {header_name(pascal)}; use that name")
    return pascal


def _filled(text: str, words: Dict[str, str]) -> str:
    return re.sub("|".join(words), lambda match: words[match.group()], text)


def create(kind: str, name: str, package: str, folder: pathlib.Path, description: str = "") -> pathlib.Path:
    """Creates the package in the existing `folder`. Returns its path."""
    words = {"my_package": _checked("the package", package or f"{name}_{kind}"), "my_command": _method(kind, name),
             "MyCommand": _pascal(name), "my_kind": kind, "my_description": description.rstrip(".") or DESCRIPTIONS[kind]}
    escaped = {placeholder: escape(word) for placeholder, word in words.items()}
    target = folder / words["my_package"]
    is_built = any(prefixes())  # in a shell in which the plugins are found
    if is_built and (f"dashboard/{name}" if kind == "dashboard" else name) in plugin_names():
        raise CliError(f"a plugin is named {name} already, see `ur plugins`; choose another name")
    if not folder.is_dir():
        raise CliError(f"there is no folder {folder}; create it, or choose another with --directory")
    if target.exists():
        raise CliError(f"{target} exists already; remove it, or choose another name with --package")
    try:
        for templates in (TEMPLATES / part for part in KINDS[kind]):
            for source in sorted(path for path in templates.rglob("*") if path.is_file() and path.suffix != ".pyc"):
                file = target / _filled(str(source.relative_to(templates)), words)
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(_filled(source.read_text(), escaped if source.suffix == ".xml" else words))
    except OSError as error:
        raise OperationFailed(f"{error.filename} cannot be written: {error.strerror}; choose another folder with --directory") from None
    return target


def _purpose(file: pathlib.Path, kind: str, described: bool) -> str:
    """Returns what the author changes in a file; empty for files that need no change."""
    if file.suffix == ".action":
        return "the fields" if described else "what it does, and its fields; `ur plugins` shows the first sentence"
    if file.suffix == ".cpp":
        return "the code"
    if kind == "dashboard" and file.name == "package.xml" and not described:
        return "<description>: what it does; `ur plugins` shows it"
    return ""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("kind", choices=KINDS)
    parser.add_argument("name", help="name of the plugin and its action, such as pick_part")
    parser.add_argument("--package", default="", metavar="NAME", help="name of the package (default: NAME_KIND)")
    parser.add_argument("--description", default="", metavar="TEXT", help="one sentence that `ur plugins` shows (default: an example)")
    parser.add_argument("--directory", type=pathlib.Path, default=pathlib.Path("."), metavar="DIR",
                        help="folder in which the package is created (default: the current folder)")


def run(options: argparse.Namespace) -> int:
    target = create(options.kind, options.name, options.package, options.directory, options.description)
    files = [path for path in target.rglob("*") if path.is_file()]
    purposes = {path: _purpose(path, options.kind, bool(options.description)) for path in files}
    width = max(len(str(file.relative_to(options.directory))) for file in purposes)
    for file in sorted(purposes, key=lambda path: (not purposes[path], path)):
        print(f"    {str(file.relative_to(options.directory)):{width}}  {purposes[file]}".rstrip())
    print("Change the files that have a remark. Then build the package with `colcon build` in the workspace (in `./ur shell` if ROS is\n"
          "not installed). The page \"Writing a plugin\" of the documentation continues from there.")
    return 0
