"""Writes the stub file commands.pyi, from which editors and type checkers know every installed command.

    ur_ros_rtde_stubs                     beside the installed module
    ur_ros_rtde_stubs --output FILE

Run it again after a plugin was installed. It needs no driver.
"""

import argparse
import keyword
import pathlib
import re
import sys
import textwrap
from collections.abc import Iterator

from ur_ros_rtde_cli import actions, errors, interface_files

from .commands import Plugin, documentation, names

HEADER = '''\
# Written by ur_ros_rtde_stubs. Changes are lost when it runs again.
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeAlias

from numpy import floating
from numpy.typing import NDArray
from ur_ros_rtde_cli.plugins import Plugin as Plugin

from .connection import Connection
from .goal import Goal

Numbers: TypeAlias = Sequence[float] | Sequence[Sequence[float]] | NDArray[floating[Any]]
Message: TypeAlias = Numbers | Mapping[str, Any] | Any


def names() -> dict[str, Plugin]: ...
def documentation(kind: str, summary: str = ...) -> str: ...
'''
INIT = "    def __init__(self, connection: Connection, goals: set[Goal]) -> None: ..."
WIDTH = 120


def _scalar(kind: str) -> str | None:
    """Returns the Python type of a primitive type, or None."""
    if kind.startswith(("float", "double")):
        return "float"
    if re.match(r"u?int\d|byte|char", kind):
        return "int"
    return {"bool": "bool"}.get(kind, "str" if kind.startswith(("string", "wstring")) else None)


def _base(kind: str) -> tuple[str, bool]:
    """Returns the type of the elements, and whether it is an array: ("float64", True) for "float64[6]"."""
    base, bracket, _ = kind.partition("[")
    return base.partition("<=")[0], bool(bracket)


class _Types:
    """Classes of the messages in results and feedback, in the order in which they have to be defined."""

    def __init__(self) -> None:
        self.classes: dict[str, list[str]] = {}

    def of_section(self, kind: str, section: int, suffix: str) -> str:
        """Returns the class of the result or feedback of an action."""
        package, _, name = kind.partition("/action/")
        return self._add(f"{name}{suffix}", package, kind, section)

    def _of_field(self, kind: str, package: str) -> str:
        base, is_array = _base(kind)
        name = _scalar(base)
        if name is not None:
            is_numpy = name == "float" and re.search(r"\[\d+\]$", kind)
            return "NDArray[floating[Any]]" if is_numpy else _listed(name, is_array)
        if "/" not in base:
            base = f"std_msgs/{base}" if base == "Header" else f"{package}/{base}"
        message = "/msg/".join((base.partition("/")[0], base.rpartition("/")[2]))
        try:
            interface_files.find(message)
        except FileNotFoundError:
            return "Any"
        return _listed(self._add(base.rpartition("/")[2], base.partition("/")[0], message, 0), is_array)

    def _add(self, name: str, package: str, kind: str, section: int) -> str:
        key = name if self.classes.get(name, [kind])[0] == kind else f"{package}_{name}"
        if key not in self.classes:
            self.classes[key] = [kind]
            lines = []
            for field in interface_files.fields(kind, section).values():
                lines.append(f"    {field.name}: {self._of_field(field.type, package)}")
                lines += _documentation(field.comment, "    ") if field.comment else []
            self.classes[key] = [kind, "", "", f"class {key}:", *(lines or ["    ..."])]
        return key

    def lines(self) -> Iterator[str]:
        for lines in self.classes.values():
            yield from lines[1:]


def _listed(name: str, is_array: bool) -> str:
    return f"Sequence[{name}]" if is_array else name


def _documentation(text: str, indentation: str) -> list[str]:
    lines = [line for part in text.replace("\\", "\\\\").replace('"""', "'''").split("\n")
             for line in textwrap.wrap(part, WIDTH - 8, subsequent_indent=" " * 8) or [""]]
    lines[-1] += '"""'
    return [f'{indentation}"""{lines[0]}', *(f"{indentation}{line}".rstrip() for line in lines[1:])]


def _parameter(field: interface_files.Field) -> str:
    base, is_array = _base(field.type)
    name = _scalar(base)
    if name is None:
        return f"{field.name}: Message = ..."
    return f"{field.name}: {'Numbers' if is_array and name == 'float' else _listed(name, is_array)} = ..."


def _method(plugin: Plugin, kind: str, types: _Types, starts: bool) -> list[str]:
    parameters = ["self", *(_parameter(field) for field in interface_files.fields(kind).values())]
    result = "Goal"
    if not starts:
        result = types.of_section(kind, 1, "Result")
        feedback = types.of_section(kind, 2, "Feedback")
        parameters += ["*", f"on_progress: Callable[[{feedback}], object] | None = ...", "result_timeout: float | None = ..."]
    name = plugin.name.rpartition("/")[2]
    return ["", f"    def {name}(", *(f"        {parameter}," for parameter in parameters), f"    ) -> {result}:",
            *_documentation(documentation(kind, plugin.description), "        "), "        ..."]


def _is_method(name: str) -> bool:
    return name.isidentifier() and not keyword.iskeyword(name)


def _class(name: str, plugins: dict[str, tuple[Plugin, str]], types: _Types, starts: bool, prefix: str = "") -> list[str]:
    """Returns the class of a group of commands, after the classes of the groups in it."""
    own = {full: found for full, found in plugins.items() if full.startswith(prefix)}
    groups = sorted({full[len(prefix):].partition("/")[0] for full in own if "/" in full[len(prefix):]})
    lines, members = [], []
    for group in groups:
        inner = f"_{name.strip('_')}{group.title().replace('_', '')}"
        lines += _class(inner, plugins, types, starts, f"{prefix}{group}/")
        members.append(f"    {group}: {inner}")
    methods = [line for full, (plugin, kind) in own.items() if _is_method(full[len(prefix):])
               for line in _method(plugin, kind, types, starts)]
    return [*lines, "", "", f"class {name}:", *members, *([] if prefix else [INIT]), *methods]


def stub(plugins: dict[str, Plugin]) -> tuple[str, list[str]]:
    """Returns the text of the stub file, and the names of the commands whose type is unknown without a driver."""
    known, unknown = {}, []
    for name, plugin in sorted(plugins.items()):
        kind = actions.type_of(plugin)
        try:
            interface_files.find(kind or "")
            known[name] = (plugin, kind or "")
        except (FileNotFoundError, ValueError, errors.CliError):
            unknown.append(name)
    types = _Types()
    commands = [*_class("Commands", known, types, starts=False), *_class("StartedCommands", known, types, starts=True)]
    return "\n".join([HEADER.rstrip("\n"), *types.lines(), *commands]) + "\n", unknown


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="ur_ros_rtde_stubs", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path(__file__).with_name("commands.pyi"), metavar="FILE",
                        help="stub file (default: %(default)s)")
    options = parser.parse_args(arguments)
    plugins = names()
    text, unknown = stub(plugins)
    try:
        options.output.write_text(text, encoding="utf-8")
    except OSError as error:
        print(f"{options.output}: {error.strerror}; give another file with --output", file=sys.stderr)
        return 1
    print(f"{options.output}: {len(plugins) - len(unknown)} commands")
    if unknown:
        print(f"without types, because plugins.xml does not name their action: {', '.join(unknown)}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
