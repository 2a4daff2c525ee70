"""Writes the pages of the site that follow from the sources. Runs in the environment of Sphinx, which has YAML."""

import ast
import os
import pathlib
import re
import subprocess
import sys
from typing import Any, Dict, Iterator, List, Sequence, Tuple

from . import docs_commands, docs_examples, docs_plugin_api
from .docs_commands import Command
from .layout import ROOT, load

MESSAGES = ROOT / "ur_ros_rtde_msgs"
PARTS = ("Goal", "Result", "Feedback")
FORWARDING_HELP = ("sim", "shell")  # pass --help on to a program, which has to be built
# The argument of a function that creates a publisher, a subscription or a service, and its type.
ENDPOINT = re.compile(r'\b(create_publisher|create_subscription|create_service|serve)<([\w:]+)>\(\s*"(/?\w+)"')
ENDPOINTS = {"create_publisher": "Published topics", "create_subscription": "Subscribed topics",
             "create_service": "Services", "serve": "Services"}
Page = List[str]

interface_files = load("ur_ros_rtde_cli/ur_ros_rtde_cli/interface_files.py")
launch_arguments = load("ur_ros_rtde/ur_ros_rtde_launch/launch_arguments.py")


def _cell(text: str) -> str:
    return re.sub(r"([|<>*_\[\]])", r"\\\1", text)


def _code(text: str) -> str:
    return f"`{text}`" if text else ""


def _type(name: str) -> str:
    """Links a message or service of this project to its fields."""
    package, _, short = name.partition("[")[0].rpartition("/")
    for folder, page in (("msg", "messages"), ("srv", "services")):
        if package.partition("/")[0] in ("", MESSAGES.name) and (MESSAGES / folder / f"{short}.{folder}").is_file():
            return f"[`{name}`]({page}.md#{short.lower()})"
    return f"`{name}`"


def _table(columns: Sequence[str], rows: Sequence[Sequence[str]]) -> Page:
    return [f"| {' | '.join(row)} |" for row in (columns, ["---"] * len(columns), *rows)] + [""]


def _fields(fields: Sequence[Any]) -> Page:
    if not fields:
        return ["No fields.", ""]
    rows = [(f"`{field.name}`", _type(field.type), _code(field.default), _cell(field.comment)) for field in fields]
    return _table(("field", "type", "default", "meaning"), rows)


def _constants(file: pathlib.Path) -> Page:
    found = interface_files.constants_of(file).values()
    rows = [(f"`{constant.name}`", constant.value, _cell(constant.comment)) for constant in found]
    return _table(("constant", "value", "meaning"), rows) if rows else []


def _errors(command: Command, file: pathlib.Path) -> Page:
    codes = docs_commands.error_codes(command, file.read_text()) - {"NONE"}
    constants = interface_files.constants_of(MESSAGES / "msg" / "ErrorCode.msg")
    links = [f"[{name}](error_codes.md#{constant.value}-{name.lower()})"
             for name, constant in constants.items() if name in codes]
    return [f"**Error codes**: {', '.join(links)}", ""]


def _examples(command: Command, is_ours: bool) -> Page:
    texts = {"bash": command.call, "python": docs_examples.python(command),
             "cpp": docs_examples.cpp(command, interface_files.header_name(command.type.rpartition("/")[2]), is_ours)}
    return [line for language, text in texts.items() for line in (f"```{language}", text.rstrip(), "```", "")]


def _interface(command: Command, file: pathlib.Path) -> Page:
    lines = []
    for title, fields in zip(PARTS, interface_files.parse(file)):
        lines += [f"**{title}**", "", *_fields(fields), *(_constants(file) if title == "Goal" else [])]
    return [*lines, *_errors(command, file)]


def _description(command: Command, file: pathlib.Path) -> str:
    """Returns the description of the type. If several commands may have the type, that of the plugin comes first."""
    text = interface_files.description_of(file) if file.is_file() else ""
    if file.is_file() and file.stem.lower() == command.name.replace("_", ""):
        return str(text)
    return f"{docs_commands.descriptions()[command.name]}. {text}"


def _command(command: Command, page: str) -> Page:
    file = (ROOT / command.type).with_suffix(".action")
    is_ours = file.is_file()
    lines = [f"## {command.name}", "", _cell(_description(command, file)), "",
             f"Type: `{command.type}`. [Description](../docs/use/commands/{page}#{command.name.replace('/', '')}).", ""]
    lines += _interface(command, file) if is_ours else []
    return [*lines, "**Examples**", "", *_examples(command, is_ours)]


def _commands(page: pathlib.Path) -> Page:
    text = page.read_text()
    title = text.splitlines()[0].lstrip("# ")
    lines = [f"# Actions: {title}", "",
             "Fields from the `.action` files, error codes from the sources. The examples in C++ include "
             "[goal_client.hpp](../ur_ros_rtde_tutorials/examples/cpp/goal_client.hpp). In a plugin: "
             "[`run.call`](../docs/use/plugins.md#calls-of-other-commands).", ""]
    return lines + [line for command in docs_commands.of_page(text) for line in _command(command, page.name)]


def endpoints() -> Iterator[Tuple[str, str, str]]:
    """Yields the topics and services of the driver: name, type and one of ENDPOINTS."""
    for file in sorted((ROOT / "ur_ros_rtde" / "src").rglob("*.cpp")):
        header = file.with_suffix(".hpp")
        text = file.read_text() + (header.read_text() if header.is_file() else "")
        aliases = dict(re.findall(r"\busing (\w+) = ([\w:]+);", text))
        for function, kind, name in ENDPOINT.findall(text):
            kind = re.sub(r"^srv::", f"{MESSAGES.name}::srv::", aliases.get(kind, kind))
            yield name, kind.replace("::", "/"), ENDPOINTS[function]


def _topics() -> Page:
    """The page has the sections in the order of ENDPOINTS."""
    page = ["# Topics and services", "",
            "Of the driver, from its sources. [Interfaces](../docs/use/interfaces.md) describes them.", ""]
    for direction in dict.fromkeys(ENDPOINTS.values()):
        rows = [(f"`{name}`", _type(kind)) for name, kind, of in sorted(endpoints()) if of == direction]
        page += [f"## {direction}", "", *_table(("name", "type"), rows)]
    return page


def _parameter(argument: Any) -> Tuple[str, str, str, str]:
    values = ", ".join(f"`{choice}`" if choice else "empty" for choice in argument.text_choices)
    if argument.limits:
        values = f"{argument.limits[0]:g} to {argument.limits[1]:g}"
    elif argument.pattern:
        values = _cell(argument.pattern[1])
    return f"`{argument.name}`", _code(argument.default_text or ""), values, _cell(argument.description)


def _parameters() -> Page:
    """A test compares them with the parameters of the running nodes."""
    page = ["# Parameters", "", "[Launch files and parameters](../docs/use/parameters.md) describes them.", ""]
    for title, arguments in (("Parameters and launch arguments", launch_arguments.PARAMETERS),
                             ("Further arguments of driver.launch.py", launch_arguments.OPTIONS),
                             ("Arguments of two_robots.launch.py", launch_arguments.TWO_ROBOTS),
                             ("Arguments of moveit.launch.py", launch_arguments.MOVEIT)):
        rows = [_parameter(argument) for argument in arguments]
        page += [f"## {title}", "", *_table(("name", "default", "values", "meaning"), rows)]
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
    for constant in interface_files.constants_of(MESSAGES / "msg" / "ErrorCode.msg").values():
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


def _pages(source: pathlib.Path) -> Iterator[Tuple[str, Page]]:
    for page in sorted((source / "docs" / "use" / "commands").glob("*.md")):
        if page.stem != "README":
            yield f"actions_{page.stem}", _commands(page)
    yield "error_codes", _error_codes(source)
    yield "messages", _messages("Message types", sorted((MESSAGES / "msg").glob("*.msg")))
    yield "parameters", _parameters()
    yield "services", _messages("Service types", sorted((MESSAGES / "srv").glob("*.srv")))
    yield "topics", _topics()
    yield "command_line", _command_line()
    yield from docs_plugin_api.pages()


def write(source: pathlib.Path) -> None:
    """Writes the folder `reference` of `source`, which has the pages that the generated ones link to."""
    folder = source / "reference"
    folder.mkdir()
    for name, page in _pages(source):
        (folder / f"{name}.md").write_text("\n".join(page))


if __name__ == "__main__":
    write(pathlib.Path(sys.argv[1]))
