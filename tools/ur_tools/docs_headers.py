"""Reads the public declarations of our C++ headers with their comments, as clang-format has laid them out.

`///` is the comment of the declaration that follows; if an empty line follows, that of several declarations. `///<` is the comment of what
precedes. A line `// Title` without a period begins a group. Groups with the title FOR_DRIVER are left out.
"""

import re
import textwrap
from dataclasses import dataclass, field
from typing import Iterator, List, Optional

FOR_DRIVER = "For the driver"
FOR_PLUGINS = "For plugins"  # ends the group before, without a title
_TEMPLATE = r"(?:template <[^{]*?>\s*)?"
_TYPE = re.compile(_TEMPLATE + r"(?:class|struct|enum class|enum)\s+(?:\[\[\w+\]\]\s*)?(\w+)(?![\w<:])")
_ALIAS = re.compile(_TEMPLATE + r"using (\w+) =")
_FUNCTION = re.compile(r"((?:\w+::)*(?:operator\W+(?=\()|operator \w+|~?\w+))\s*\(")
_BODY = re.compile(_TEMPLATE + r"(?:class|struct|enum|namespace|extern)\b|.*(?:\)|\bconst|\boverride|\bfinal|\bnoexcept)$", re.S)
_INITIALIZERS = re.compile(r"\)\s*:(?!:).*", re.S)
_HIDDEN = re.compile(_TEMPLATE + r"(?:(?:friend|static_assert|class|struct|enum)\b|using [^=]*$|.*= (?:delete|default)$)", re.S)
_ACCESS = re.compile(r"(public|protected|private):")
_ARGUMENTS_OF_TEMPLATES = re.compile(r"<[^<>()]*(?:\([^<>()]*\)[^<>()]*)*>")


@dataclass
class Declaration:
    kind: str  # "type", "enum", "enumerator", "function", "variable", "alias", "macro", or "comment" of several
    text: str  # without the body of a function or type
    name: str = ""
    comment: str = ""  # paragraphs and indented code, as in the header
    title: str = ""  # of the group that it begins
    begins_block: bool = True  # after an empty line or a title
    members: List["Declaration"] = field(default_factory=list)  # public ones


@dataclass
class _Item:
    """What is between two separators of a scope. No text: a comment of several."""

    text: str
    body: Optional[str]
    comment: str
    title: str
    begins_block: bool


def _skip(text: str, position: int) -> int:
    """Returns the position after the character, string or comment that begins here. No header has raw strings."""
    if text.startswith("//", position):
        return text.index("\n", position)
    quote = text[position]
    if quote == '"' or (quote == "'" and not text[position - 1].isalnum()):  # 10'000
        position += 1
        while text[position] != quote:
            position += 2 if text[position] == "\\" else 1
    return position + 1


def _end_of_braces(text: str, begin: int) -> int:
    depth, position = 0, begin
    while True:
        depth += {"{": 1, "}": -1}.get(text[position], 0)
        position = _skip(text, position)
        if depth == 0:
            return position


def _has_body(head: str) -> bool:
    """Returns whether `{` after this text begins a body, not a value."""
    return not head[-1].isidentifier() if _INITIALIZERS.search(head) else bool(_BODY.match(head))


class _Scope:
    """Splits the text between the braces of a namespace, class or enumeration."""

    def __init__(self, text: str, access: str, separator: str = ";") -> None:
        self._text = text.rstrip() + "\n"
        self._access = access
        self._separator = separator
        self._position = 0
        self._comment: List[str] = []  # lines before what follows
        self._title = ""
        self._begins_block = True
        self._last: Optional[_Item] = None

    def _take_line(self) -> str:
        begin, self._position = self._position, self._text.index("\n", self._position)
        return self._text[begin:self._position].strip()

    def _take_comment(self) -> None:
        begins_line = not self._text[self._text.rfind("\n", 0, self._position) + 1:self._position].strip()
        line = self._take_line()
        if line.startswith("///<"):
            if self._last is not None:
                self._last.comment = f"{self._last.comment} {line[4:].strip()}".strip()
        elif line.startswith("///"):
            self._comment.append(line[3:])
        elif begins_line and not line.endswith("."):
            self._title, self._begins_block = line[2:].strip(), True

    def _item(self, begin: int, end: int, body: Optional[str] = None) -> _Item:
        indent = begin - (self._text.rfind("\n", 0, begin) + 1)
        text = re.sub(rf"\n {{0,{indent}}}", "\n", self._text[begin:end].strip())
        comment = textwrap.dedent("\n".join(self._comment)).strip("\n")
        self._last = _Item(text, body, comment, self._title, self._begins_block)
        self._comment, self._title, self._begins_block = [], "", False
        return self._last

    def _take_code(self) -> _Item:
        begin = position = self._position
        parentheses = 0
        while position < len(self._text):
            character = self._text[position]
            parentheses += {"(": 1, ")": -1}.get(character, 0)
            if not parentheses and (character == self._separator or self._separator == "," and self._text.startswith("//", position)):
                break
            if character == "{":
                end = _end_of_braces(self._text, position)
                if not parentheses and _has_body(self._text[begin:position].rstrip()):
                    self._position = end + self._text.startswith(";", end)
                    return self._item(begin, position, self._text[position + 1:end - 1])
                position = end
            else:
                position = _skip(self._text, position)
        self._position = position + self._text.startswith(self._separator, position)
        return self._item(begin, position)

    def _take_macro(self) -> _Item:
        begin = self._position
        while self._take_line().endswith("\\"):
            self._position += 1
        return self._item(begin, self._position)

    def _items(self) -> Iterator[_Item]:
        """Yields the public ones and comments of several. The comment after an item is added to it later."""
        while True:
            blanks = re.compile(r"\s*").match(self._text, self._position)
            assert blanks is not None
            self._position = blanks.end()
            if blanks[0].count("\n") > 1:
                if self._comment:
                    yield self._item(self._position, self._position)
                self._begins_block = True
            access = _ACCESS.match(self._text, self._position)
            if self._position >= len(self._text):
                return
            if access:
                self._access, self._position = access[1], access.end()
            elif self._text.startswith("//", self._position):
                self._take_comment()
            else:
                item = self._take_macro() if self._text[self._position] == "#" else self._take_code()
                if self._access == "public":
                    yield item

    def items(self) -> List[_Item]:
        return list(self._items())


def _without_templates(text: str) -> str:
    while _ARGUMENTS_OF_TEMPLATES.search(text):
        text = _ARGUMENTS_OF_TEMPLATES.sub("", text)
    return text


def _declaration(item: _Item) -> Optional[Declaration]:
    """Returns None for what the documentation does not show, such as declarations of types and definitions of members."""
    text, body = item.text, item.body

    def made(kind: str, shown: str, name: str = "") -> Declaration:
        return Declaration(kind, shown, name, item.comment, "", item.begins_block)

    if not text:
        return made("comment", "")
    if text.startswith("#"):
        macro = re.match(r"#define ((\w+)(?:\([^)]*\))?)", text)
        return made("macro", macro[1], macro[2]) if macro and item.comment else None
    if body is not None and (found := _TYPE.match(text)):
        result = made("enum" if text.startswith("enum") else "type", text, found[1])
        access = "private" if re.search(r"\bclass\b", text) else "public"
        result.members = _enumerators(body) if result.kind == "enum" else _members(body, access)
        return result
    if _HIDDEN.match(text):
        return None
    if found := _ALIAS.match(text):
        return made("alias", f"{text};", found[1])
    head = text if body is None else _INITIALIZERS.sub(")", text)
    plain = _without_templates(re.sub(r"^template ", "", head))
    found = _FUNCTION.search(plain if "operator" in plain else plain.partition("=")[0])
    if found is None or "(*" in plain:
        return made("variable", f"{' '.join(text.split())};")
    if "::" in found[1] or not item.comment and re.match(r"~|operator==?$", found[1]) or "&&) noexcept" in text:
        return None
    return made("function", f"{head};", found[1])


def _enumerators(body: str) -> List[Declaration]:
    return [Declaration("enumerator", " ".join(item.text.split()), comment=item.comment) for item in _Scope(body, "public", ",").items()]


def _members(body: str, access: str) -> List[Declaration]:
    declarations, group, title = [], "", ""
    for item in _Scope(body, access).items():
        if item.title:
            group, title = item.title, "" if item.title == FOR_PLUGINS else item.title
        found = _declaration(item) if group != FOR_DRIVER else None
        if found is not None:
            found.title, title = title, ""  # even if the first of the group is not shown
            declarations.append(found)
    return declarations


def _scopes(text: str) -> Iterator[str]:
    """Yields the text in each of our namespaces except `detail`, and the text outside of all."""
    outside, position = "", 0
    while begin := re.compile(r"^namespace ([\w:]*)\s*\{", re.M).search(text, position):
        end = _end_of_braces(text, begin.end() - 1)
        if begin[1].startswith(("ur_ros_rtde", "rcl_cxx")):
            yield from _scopes(text[begin.end():end - 1])
        outside, position = outside + text[position:begin.start()], text.index("\n", end)
    yield outside + text[position:]


def declarations(header: str) -> List[Declaration]:
    """Returns what the text of a header declares for others."""
    return [found for scope in _scopes(header) for found in _members(scope, "public")]
