"""Writes the pages of the site that follow from the sources: actions, messages, error codes, command lines, headers of the plugin API."""

import ast
import importlib.util
import os
import pathlib
import re
import subprocess
import sys
from collections import defaultdict
from typing import Any, Dict, Iterator, List, Sequence, Tuple

from .layout import ROOT

# (action, type, page of docs/use/commands) of the examples
EXAMPLE = re.compile(r"ros2 action send_goal (?:--feedback )?/(\S+) (\w+/action/\w+)")
PARTS = ("Goal", "Result", "Feedback")
HEADERS = ("ur_ros_rtde/include/ur_ros_rtde", "ur_ros_rtde_robot/include/ur_ros_rtde_robot")
FORWARDING_HELP = ("sim", "shell")  # pass --help on to a program, which has to be built
Page = List[str]


def _interface_files() -> Any:
    """Returns the module of `ur` that reads interface files. It needs no ROS."""
    spec = importlib.util.spec_from_file_location("interface_files", ROOT / "ur_ros_rtde_cli" / "ur_ros_rtde_cli" / "interface_files.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # for dataclasses
    spec.loader.exec_module(module)
    return module


interface_files = _interface_files()


def _cell(text: str) -> str:
    return re.sub(r"([|<>*_\[\]])", r"\\\1", text)


def _code(text: str) -> str:
    return f"`{text}`" if text else ""


def _fields(fields: Sequence[Any]) -> Page:
    if not fields:
        return ["No fields.", ""]
    rows = [f"| `{field.name}` | `{field.type}` | {_code(field.default)} | {_cell(field.comment)} |" for field in fields]
    return ["| field | type | default | meaning |", "|---|---|---|---|", *rows, ""]


def _constants(file: pathlib.Path) -> Page:
    found = interface_files.constants_of(file)
    rows = [f"| `{constant.name}` | {constant.value} | {_cell(constant.comment)} |" for constant in found.values()]
    return ["| constant | value | meaning |", "|---|---|---|", *rows, ""] if rows else []


def _examples(source: pathlib.Path) -> Dict[str, List[Tuple[str, str]]]:
    """Returns the actions of each type, with the pages that describe them."""
    found: Dict[str, List[Tuple[str, str]]] = defaultdict(list)
    for page in sorted((source / "docs" / "use" / "commands").glob("*.md")):
        for name, kind in dict.fromkeys(EXAMPLE.findall(page.read_text())):
            if re.search(rf"^### {re.escape(name)}$", page.read_text(), re.M):
                anchor = name.replace("/", "")
                found[kind].append((name, f"../docs/use/commands/{page.name}#{anchor}"))
    return found


def _actions(source: pathlib.Path, package: str, files: Sequence[pathlib.Path]) -> Page:
    examples = _examples(source)
    page = [f"# Actions of {package}", "", "Goals, results and feedback, from the `.action` files.", ""]
    for file in files:
        kind = f"{package}/action/{file.stem}"
        page += [f"## {file.stem}", "", _cell(interface_files.description_of(file)), ""]
        if kind in examples:
            page += ["Served as " + ", ".join(f"[{name}]({link})" for name, link in examples[kind]) + f". Type: `{kind}`.", ""]
        for part, fields in zip(PARTS, interface_files.parse(file)):
            page += [f"**{part}**", "", *_fields(fields)]
    return page


def _messages(title: str, files: Sequence[pathlib.Path]) -> Page:
    page = [f"# {title}", ""]
    for file in files:
        page += [f"## {file.stem}", "", _cell(interface_files.description_of(file)), "", *_constants(file)]
        sections = interface_files.parse(file)
        for part, fields in zip(("Request", "Response") if len(sections) > 1 else ("",), sections):
            page += [f"**{part}**", ""] if part else []
            page += _fields(fields) if fields or part else []
    return page


def _remedies() -> Dict[str, str]:
    """Returns the remedies of ur_ros_rtde.errors, which needs ROS, by the name of the code."""
    tree = ast.parse((ROOT / "ur_ros_rtde_python" / "ur_ros_rtde" / "errors.py").read_text())
    value, = [node.value for node in tree.body if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "REMEDIES"]
    found = ast.literal_eval(value)
    assert isinstance(found, dict)
    return found


def _error_codes(source: pathlib.Path) -> Page:
    """The search of Sphinx drops numbers, but compares whole queries with the index: "error 7"."""
    page = ["# Error codes", "", "The values of `error_code` in results and rejections. The `message` beside it has the details.", ""]
    remedies = _remedies()
    texts = {name: (source / "docs" / "use" / name).read_text() for name in ("troubleshooting.md", "troubleshooting_motions.md")}
    for constant in interface_files.constants_of(ROOT / "ur_ros_rtde_msgs" / "msg" / "ErrorCode.msg").values():
        links = [f"[{name}](../docs/use/{name}#{constant.name.lower()})" for name, text in texts.items()
                 if re.search(rf"^### {constant.name}$", text, re.M)]
        page += ["```{index} error %s, error_code %s" % (constant.value, constant.value), "```", "",
                 f"## {constant.value}: {constant.name}", "", _cell(constant.comment) or "Success.", ""]
        page += [f"In Python: {_cell(remedies[constant.name])}.", ""] if constant.name in remedies else []
        page += ["Messages with cause and remedy: " + ", ".join(links) + ".", ""] if links else []
    return page


def _help(arguments: Sequence[str]) -> str:
    command = [sys.executable, str(ROOT / "ur"), *arguments, "--help"]
    result = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True, env={**os.environ, "COLUMNS": "100"})
    return result.stdout.rstrip()


def _command_line() -> Page:
    first = _help([])
    names = [name for name in re.findall(r"^    (\w+) {2,}\S", first, re.M) if name not in FORWARDING_HELP]
    page = ["# Command line", "", "The help of `./ur`, which is `ur` in its shell, and of its commands.", "", "```text", first, "```", ""]
    for name in names:
        page += [f"## {name}", "", "```text", _help([name]), "```", ""]
    return page


def _plugin_api() -> Page:
    page = ["# Plugin API", "", "The public headers, for authors of plugins. `writing_a_plugin.md` leads to the first plugin.", ""]
    for folder in HEADERS:
        page += [f"## {folder.split('/')[0]}", ""]
        for header in sorted((ROOT / folder).rglob("*.hpp")):
            if "detail" not in header.parts:
                page += [f"### {header.relative_to((ROOT / folder).parent)}", "", "```cpp", header.read_text().rstrip(), "```", ""]
    return page


def _pages(source: pathlib.Path) -> Iterator[Tuple[str, Page]]:
    for folder in sorted(ROOT.glob("*/action")):
        package = folder.parent.name
        yield f"actions_{package}", _actions(source, package, sorted(folder.glob("*.action")))
    messages = ROOT / "ur_ros_rtde_msgs"
    yield "error_codes", _error_codes(source)
    yield "messages", _messages("Messages", sorted((messages / "msg").glob("*.msg")))
    yield "services", _messages("Services", sorted((messages / "srv").glob("*.srv")))
    yield "command_line", _command_line()
    yield "plugin_api", _plugin_api()


def write(source: pathlib.Path, folder: pathlib.Path) -> None:
    """`source` has the pages of the documentation, which the generated ones link to."""
    folder.mkdir()
    for name, page in _pages(source):
        (folder / f"{name}.md").write_text("\n".join(page))
