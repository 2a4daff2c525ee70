"""The pages of the reference about the API of plugins: what its headers declare, in the order of PAGES."""

import pathlib
import re
import textwrap
from dataclasses import dataclass
from typing import Dict, Iterator, List, Sequence, Tuple

from . import docs_headers
from .docs_headers import Declaration
from .layout import ROOT

Page = List[str]
# Name of the page, title, and its groups of headers, in folders `include`.
PAGES: Sequence[Tuple[str, str, Dict[str, Sequence[str]]]] = (
    ("plugin_api", "Plugin API", {
        "Commands": ("ur_ros_rtde/command", "ur_ros_rtde/command_traits", "ur_ros_rtde/check", "ur_ros_rtde/run", "ur_ros_rtde/outcome",
                     "ur_ros_rtde/check_result"),
        "Motions and modes": ("ur_ros_rtde/mode", "ur_ros_rtde/streaming", "ur_ros_rtde/target_messages", "ur_ros_rtde/tcp_target",
                              "ur_ros_rtde/tool_settings"),
        "Inputs, outputs and supervision": ("ur_ros_rtde/outputs", "ur_ros_rtde/digital_output", "ur_ros_rtde/supervision"),
        "Frames of TF": ("ur_ros_rtde/frames",),
        "Extensions of the control program": ("ur_ros_rtde/extension", "ur_ros_rtde_robot/script/script_extension",
                                              "ur_ros_rtde/registers"),
        "Dashboard commands": ("ur_ros_rtde/dashboard_command", "ur_ros_rtde/dashboard_run"),
        "Plugins and their server": ("ur_ros_rtde/plugin", "ur_ros_rtde/plugin_host"),
    }),
    ("plugin_api_ros", "Plugin API: ROS interfaces", {
        "Nodes": ("rcl_cxx/node", "rcl_cxx/callback_group", "rcl_cxx/logging"),
        "Parameters": ("rcl_cxx/parameter",),
        "Topics, services and timers": ("rcl_cxx/qos", "rcl_cxx/publisher", "rcl_cxx/subscription", "rcl_cxx/service", "rcl_cxx/timer"),
    }),
    ("plugin_api_types", "Plugin API: types", {
        "Errors": ("ur_ros_rtde_trajectory/error",),
        "State of the robot": ("ur_ros_rtde_robot/state/sample", "ur_ros_rtde_robot/state/conversions", "ur_ros_rtde_trajectory/vector",
                               "ur_ros_rtde_trajectory/arm_limits", "ur_ros_rtde_robot/robot_status", "ur_ros_rtde_robot/robot"),
        "Motions and stops": ("ur_ros_rtde_robot/motion/motion", "ur_ros_rtde_robot/motion/activity", "ur_ros_rtde_robot/motion/lease",
                              "ur_ros_rtde_robot/motion/setpoint_clock"),
        "Scripts": ("ur_ros_rtde_robot/program/script",),
        "Connections": ("ur_ros_rtde_robot/connection/locked", "ur_ros_rtde_robot/connection/link",
                        "ur_ros_rtde_robot/connection/dashboard_connection"),
    }),
)
INTRODUCTION = """\
What the headers declare for authors of plugins. [Writing a plugin](../docs/use/writing_a_plugin.md) is the tutorial,
[Plugins](../docs/use/plugins.md) describes how goals are executed. [Plugin API](plugin_api.md) has the classes to derive from and those
that plugins use, [Plugin API: ROS interfaces](plugin_api_ros.md) the topics, services, timers and parameters of `host.node()`,
[Plugin API: types](plugin_api_types.md) the types of their arguments and values."""
GUIDES = ("writing_a_plugin", "plugins")  # in docs/use
EXAMPLES = ("ur_ros_rtde_tutorials/src", "ur_ros_rtde_gripper_commands/src", "ur_ros_rtde_commands/src")
_SENTENCE = re.compile(r".+?\.(?=\s|$)", re.S)
_WORD = re.compile(r'`[^`]+`|"[^"]*"|docs/\w+/\w+\.md|\w+/(?:msg|srv|action)/\w+|[\w/]+\.(?:hpp|cmake|cpp)\b|(?:[a-z_]\w*\.)+\w+\(\)|'
                   r'[A-Za-z_]\w*(?:<\w+>)?(?:::~?\w+)*(?:\(\))?|[\\|<>*_\[\]]')


@dataclass(frozen=True)
class Header:
    name: str  # "ur_ros_rtde/command.hpp"
    declarations: Sequence[Declaration]

    @property
    def types(self) -> List[Declaration]:
        return [found for found in self.declarations if found.kind in ("type", "enum")]

    @property
    def others(self) -> List[Declaration]:
        return [found for found in self.declarations if found.kind not in ("type", "enum")]

    @property
    def kind_of_others(self) -> str:
        kinds = [found.kind for found in self.others]
        return {"alias": "Types", "macro": "Macros", "variable": "Constants"}.get("" if "function" in kinds else kinds[0], "Functions")

    @property
    def heading_of_others(self) -> str:
        return f"{self.kind_of_others} of {pathlib.PurePath(self.name).name}"


def _read(name: str) -> Header:
    path = ROOT / name.split("/")[0] / "include" / f"{name}.hpp"
    return Header(f"{name}.hpp", docs_headers.declarations(path.read_text()))


def _slug(heading: str) -> str:
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")


def _code(text: str) -> Page:
    return ["```cpp", text, "```", ""]


class _Writer:
    """Writes the pages. Knows all types, for the links between them."""

    def __init__(self) -> None:
        self._groups = {page: {group: [_read(name) for name in names] for group, names in groups.items()} for page, _, groups in PAGES}
        self._links = {found.name: f"{page}.md#{_slug(found.name)}" for page, groups in self._groups.items()
                       for headers in groups.values() for header in headers for found in header.types}
        guides = [(f"../docs/use/{name}.md", part) for name in GUIDES
                  for part in re.split(r"^##+ ", (ROOT / "docs" / "use" / f"{name}.md").read_text(), flags=re.M)[1:]]
        self._guides = [(path, *part.split("\n", 1)) for path, part in guides]
        self._examples = [(path.relative_to(ROOT), re.sub(r"//.*", "", path.read_text()))
                          for folder in EXAMPLES for path in sorted((ROOT / folder).rglob("*.cpp"))]

    def pages(self) -> Iterator[Tuple[str, Page]]:
        for name, title, _ in PAGES:
            yield name, self._page(name, title)

    def _inline(self, text: str) -> str:
        """Returns Markdown for a text of a comment: names as code, types of this API as links."""
        def word(match: "re.Match[str]") -> str:
            found = match[0]
            plain = found.strip("`")
            name = re.split(r"<|::", plain)[0]
            if found.startswith("docs/"):
                return f"[{pathlib.PurePath(found).name}](../{found})"
            if name in self._links and (found != name or re.search(r"[a-z][A-Z]", name)):
                return f"[`{plain}`]({self._links[name]})"
            if found[0] == '"' or len(found) == 1:
                return re.sub(r"([\\|<>*_\[\]])", r"\\\1", found)
            return f"`{plain}`" if plain != found or re.search(r"_|/|::|\(\)$|\.\w+$", found) else found

        return _WORD.sub(word, " ".join(text.split()))

    def _comment(self, comment: str) -> Tuple[str, Page, Page]:
        """Returns the first sentence, the examples with what leads to them, and the rest."""
        first, examples, rest = "", [], []  # type: str, Page, Page
        for block in re.split(r"\n\s*\n", comment):
            if block.startswith("    "):
                lead = rest.pop() if rest and rest[-1].endswith(":") else ""
                examples += [*([lead, ""] if lead else []), *_code(textwrap.dedent(block))]
                continue
            if not first:
                found = _SENTENCE.match(block)
                first = found[0] if found else block
                block = block[len(first):].strip()
            colon = re.search(r"[^.]*:$", block)  # leads to the example that follows
            parts = (block[:colon.start()], colon[0]) if colon else (block,)
            rest += [self._inline(part) for part in parts if part.strip()]
        return self._inline(first), examples, [line for block in rest for line in (block, "")]

    def _see(self, header: Header, names: Sequence[str]) -> Page:
        """Links the sections and examples with one of these names."""
        word = re.compile(rf"\b(?:{'|'.join(map(re.escape, names))})\b")
        in_code = re.compile(rf"`[^`\n]*{word.pattern}[^`\n]*`")
        sections = [found for found in self._guides if word.search(found[1])]
        sections = sections or [found for found in self._guides if in_code.search(found[2])]
        links = [f"[{title.replace('`', '')}]({path}#{_slug(title)})" for path, title, _ in sections[:3]]
        files = [path for path, text in self._examples if word.search(text)][:3]
        links += [f"[{path.name}](../{path})" for path in files]
        return [f"Header: `{header.name}`." + (f" See {', '.join(links)}." if links else ""), ""]

    def _table(self, rows: Sequence[Declaration], column: str) -> Page:
        return [f"| {column} | meaning |", "|---|---|",
                *(f"| `{row.text.rstrip(';').replace('|', chr(92) + '|')}` | {self._inline(row.comment)} |" for row in rows), ""]

    def _members(self, members: Sequence[Declaration], column: str = "field") -> Page:
        """Fields become a table. A function without a comment belongs to the one before, as in the header."""
        page, fields, code, text = [], [], [], ""  # type: Page, List[Declaration], List[str], str

        def flush() -> None:
            nonlocal page, fields, code
            page += self._table(fields, column) if fields else []
            page += [*_code("\n".join(code)), *([self._inline(text), ""] if text else [])] if code else []
            fields, code = [], []

        for member in members:
            if member.kind in ("type", "enum"):
                continue
            is_field = member.kind == "variable"
            if member.title or member.comment or member.begins_block or is_field != bool(fields):
                if not (is_field and fields and not member.title):
                    flush()
            page += [f"**{member.title}**", ""] if member.title else []
            if is_field:
                fields.append(member)
            elif member.kind == "comment":
                page += [self._inline(member.comment), ""]
            else:
                text = text if code else member.comment
                code.append(member.text)
        flush()
        return page

    def _type(self, header: Header, found: Declaration, level: str = "###", scope: str = "") -> Page:
        first, examples, rest = self._comment(found.comment)
        page = [f"{level} {scope}{found.name}", "", first, "", *examples, *rest]
        page += self._see(header, [found.name]) if not scope else []
        if found.kind == "enum":
            has_comments = any(member.comment for member in found.members)
            return page + (self._table(found.members, "value") if has_comments else
                           [", ".join(f"`{member.text}`" for member in found.members) + ".", ""])
        page += _code(f"{found.text};") if "\n" in found.text or " : " in found.text else []
        page += self._members(found.members)
        for nested in found.members:
            if nested.kind in ("type", "enum"):
                page += self._type(header, nested, f"{level}#", f"{found.name}::")
        return page

    def _overview(self, page: str) -> Page:
        rows = []
        for group, headers in self._groups[page].items():
            cell = f"[{group}](#{_slug(group)})"
            for header in headers:
                for found in header.types:
                    rows.append((cell, f"[`{found.name}`](#{_slug(found.name)})", self._comment(found.comment)[0]))
                    cell = ""
                if names := list(dict.fromkeys(found.name for found in header.others if found.name.isidentifier())):
                    link = f"[{header.kind_of_others.lower()}](#{_slug(header.heading_of_others)})"
                    rows.append((cell, link, ", ".join(f"`{name}`" for name in names)))
                    cell = ""
        return ["| for | name | purpose |", "|---|---|---|", *(f"| {' | '.join(row)} |" for row in rows), ""]

    def _page(self, name: str, title: str) -> Page:
        page = [f"# {title}", "", INTRODUCTION, "", *self._overview(name)]
        for group, headers in self._groups[name].items():
            page += [f"## {group}", ""]
            for header in headers:
                for found in header.types:
                    page += self._type(header, found)
                if header.others:
                    names = [found.name for found in header.others if found.name]
                    page += [f"### {header.heading_of_others}", "", *self._see(header, names), *self._members(header.others, "constant")]
        return page


def pages() -> Iterator[Tuple[str, Page]]:
    """Yields the names of the pages and their lines."""
    yield from _Writer().pages()
