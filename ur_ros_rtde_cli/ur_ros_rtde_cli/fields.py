"""Converts messages from YAML and to YAML.

A goal file, as `ur call --file`, `./ur plan` and Python clients use it:

    goal = fields.read_file("goal.yaml", MoveJ.Goal())
"""

import array
import difflib
import importlib
import json
import math
import pathlib
import re
from typing import Any, Callable, Tuple, Union

import numpy
import yaml
from rosidl_parser import definition as idl

from .errors import CliError

Path = Tuple[Any, ...]  # ("waypoints", 0, "positions")

# Numbers that float() accepts and YAML 1.1 reads as text: 1e-3, nan, inf.
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?|[-+]?\.?(nan|inf|infinity)", re.I)


class FieldError(CliError):
    def __init__(self, path: Path, text: str):
        super().__init__(text)
        self.path = path


class _Loader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):  # type: ignore[misc]
    """Reports duplicate keys, of which YAML silently keeps the last."""

    def construct_mapping(self, node: Any, deep: bool = False) -> Any:
        seen = set()
        for key, _ in node.value if isinstance(node, yaml.MappingNode) else ():
            if isinstance(key, yaml.ScalarNode) and key.value in seen:
                raise yaml.constructor.ConstructorError(None, None, f"the field {key.value} is given twice", key.start_mark)
            seen.add(key.value if isinstance(key, yaml.ScalarNode) else None)
        return super().construct_mapping(node, deep)


class Document:
    """A YAML document with the fields of a message. Error messages begin with the name of its file and the line."""

    def __init__(self, text: str, source: str = ""):
        self._source = source
        self._node, values = _load(text, source)
        self._values = {} if values is None else values
        if not isinstance(self._values, dict):
            raise CliError(f"{self._location(())}{_not_a_mapping((), values)}, as in {{speed: 0.5}}")

    @classmethod
    def of_file(cls, file: Union[str, pathlib.Path]) -> "Document":
        try:
            return cls(pathlib.Path(file).read_text(encoding="utf-8"), str(file))
        except OSError as error:
            raise CliError(f"{file}: {error.strerror}") from None
        except UnicodeDecodeError:
            raise CliError(f"{file} is not a text file") from None

    @property
    def names(self) -> Tuple[Any, ...]:
        """Names of the outermost fields."""
        return tuple(self._values)

    def fill(self, message: Any) -> Any:
        """Sets the fields of `message` that the document contains. The others keep their values."""
        try:
            fill(message, self._values)
        except FieldError as error:
            raise CliError(f"{self._location(error.path)}{error}") from None
        return message

    def _location(self, path: Path) -> str:
        return f"{self._source}:{_line(self._node, path)}: " if self._source else ""


def read_file(file: Union[str, pathlib.Path], message: Any) -> Any:
    """Sets the fields of `message` that a YAML file contains."""
    return Document.of_file(file).fill(message)


def parse_value(text: str, path: Path) -> Any:
    """Returns the value of one field in YAML, for `fill`."""
    try:
        return _load(text, "")[1]
    except CliError as error:
        raise FieldError(path, str(error).replace("the goal", field_name(path), 1)) from None


def _load(text: str, source: str) -> Tuple[Any, Any]:
    """Returns the YAML node, which has line numbers, and the value of the only document."""
    try:
        loader = _Loader(text)
        try:
            node = loader.get_single_node()
            return node, None if node is None else loader.construct_document(node)
        finally:
            loader.dispose()
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        where = f"line {mark.line + 1}, column {mark.column + 1}: " if mark else ""
        if source:
            where = f"{source}:{mark.line + 1}: " if mark else f"{source}: "
        what = ", ".join(filter(None, (error.context, error.problem)))
        raise CliError(f"{where}not YAML: {what}" if source else f"the goal is not YAML: {where}{what}") from None
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise CliError(f"{source or 'the goal'}: not YAML: {' '.join(str(error).split())}") from None


def _line(node: Any, path: Path) -> int:
    """Returns the line of a field, or of the innermost enclosing field that exists."""
    line = node.start_mark.line if node is not None else 0
    for part in path:
        if isinstance(node, yaml.SequenceNode) and isinstance(part, int) and part < len(node.value):
            node = node.value[part]
            line = node.start_mark.line
        elif isinstance(node, yaml.MappingNode):
            found = next(((key, value) for key, value in node.value if key.value == str(part)), None)
            if found is None:
                break
            line, node = found[0].start_mark.line, found[1]
        else:
            break
    return line + 1


def field_name(path: Path) -> str:
    """Returns "waypoints[0].speed" for ("waypoints", 0, "speed")."""
    text = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in path)
    return text.lstrip(".") or "the goal"


def _not_a_mapping(path: Path, values: Any) -> str:
    return f"{field_name(path)} is {_abbreviated(values)}: expected a mapping of fields"


def fill(message: Any, values: Any, path: Path = ()) -> None:
    """Sets the fields of `message` from a mapping."""
    types = dict(zip(message.get_fields_and_field_types(), message.SLOT_TYPES))
    if not isinstance(values, dict):
        raise FieldError(path, f"{_not_a_mapping(path, values)}: {_joined(types)}")
    for name, value in values.items():
        own = (*path, name)
        if name not in types:
            close = difflib.get_close_matches(str(name), types, 1)
            hint = f"; did you mean {close[0]}?" if close else "."
            raise FieldError(own, f"there is no field {field_name(own)}{hint} The fields are: {_joined(types)}")
        try:
            setattr(message, name, _convert(types[name], getattr(message, name), value, own))
        except (AssertionError, TypeError, ValueError, OverflowError) as error:
            raise FieldError(own, f"{field_name(own)} is {_abbreviated(value)}: expected {_expected(types[name])} "
                             f"({' '.join(str(error).split())})") from None


def _joined(names: Any) -> str:
    return ", ".join(names) or "none"


def _abbreviated(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _expected(kind: Any) -> str:
    """Describes a type for an error message."""
    if isinstance(kind, idl.NamespacedType):
        return f"a mapping of the fields of {kind.namespaces[0]}/{kind.name}"
    if isinstance(kind, idl.AbstractNestedType):
        size = ""
        if isinstance(kind, idl.Array):
            size = f"{kind.size} "
        elif isinstance(kind, idl.BoundedSequence):
            size = f"at most {kind.maximum_size} "
        inner = kind.value_type
        if isinstance(inner, idl.NamespacedType):
            return f"a list of {size}{inner.namespaces[0]}/{inner.name}"
        if isinstance(inner, idl.BasicType):
            return f"a list of {size}{'numbers' if _is_float(inner) else f'{inner.typename} values'}"
        return f"a list of {size}strings"
    if isinstance(kind, idl.AbstractGenericString):
        limit = f" of at most {kind.maximum_size} characters" if getattr(kind, "maximum_size", None) else ""
        return f"a string{limit}"
    if _is_float(kind):
        return "a number"
    if kind.typename == idl.BOOLEAN_TYPE:
        return "true or false"
    bounds = _integer_bounds(kind)
    return f"an integer from {bounds[0]} to {bounds[1]}" if bounds else f"a value of type {kind.typename}"


def _is_float(kind: Any) -> bool:
    return isinstance(kind, idl.BasicType) and kind.typename in idl.FLOATING_POINT_TYPES


def _integer_bounds(kind: Any) -> Any:
    match = re.fullmatch(r"(u?)int(8|16|32|64)", kind.typename) if isinstance(kind, idl.BasicType) else None
    if match is None:
        return (0, 255) if isinstance(kind, idl.BasicType) and kind.typename == idl.OCTET_TYPE else None
    bits = int(match.group(2))
    return (0, 2**bits - 1) if match.group(1) else (-2**(bits - 1), 2**(bits - 1) - 1)


def _convert(kind: Any, old: Any, value: Any, path: Path) -> Any:
    """Converts a YAML value for a field of the type `kind` whose current value is `old`."""
    if isinstance(kind, idl.NamespacedType):
        fill(old, value, path)
        return old
    if isinstance(kind, idl.AbstractNestedType):
        return _convert_sequence(kind, value, path)
    if _is_float(kind):
        number = _to_float(value)
        if number is not None:
            return number
    elif isinstance(kind, idl.AbstractGenericString):
        limit = getattr(kind, "maximum_size", None)
        if isinstance(value, str) and (limit is None or len(value) <= limit):
            return value
        if isinstance(value, (bool, int, float)):
            raise FieldError(path, f"{field_name(path)} is {_abbreviated(value)}: expected {_expected(kind)}; put it in quotes")
    elif kind.typename == idl.BOOLEAN_TYPE:
        if isinstance(value, bool) or value in (0, 1):  # numbers as in the axes of URScript
            return bool(value)
    else:
        bounds = _integer_bounds(kind)
        if bounds is None:
            return value  # checked by the message on assignment
        if isinstance(value, int) and not isinstance(value, bool) and bounds[0] <= value <= bounds[1]:
            return bytes([value]) if kind.typename == idl.OCTET_TYPE else value
    raise FieldError(path, f"{field_name(path)} is {_abbreviated(value)}: expected {_expected(kind)}")


def _to_float(value: Any) -> Any:
    """Returns None if the value is not a number."""
    if isinstance(value, str) and _NUMBER.fullmatch(value):
        return float(value.replace(".nan", "nan").replace(".inf", "inf"))
    return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else None


def _convert_sequence(kind: Any, value: Any, path: Path) -> Any:
    wrong = not isinstance(value, list)
    if not wrong and isinstance(kind, idl.Array):
        wrong = len(value) != kind.size
    elif not wrong and isinstance(kind, idl.BoundedSequence):
        wrong = len(value) > kind.maximum_size
    if wrong:
        found = f"has {len(value)} values" if isinstance(value, list) else f"is {_abbreviated(value)}"
        raise FieldError(path, f"{field_name(path)} {found}: expected {_expected(kind)}")
    inner = kind.value_type
    if isinstance(inner, idl.NamespacedType):
        return [_convert_message(inner, item, (*path, index)) for index, item in enumerate(value)]
    return [_convert(inner, None, item, (*path, index)) for index, item in enumerate(value)]


def _convert_message(kind: Any, values: Any, path: Path) -> Any:
    module = importlib.import_module(".".join(kind.namespaces))
    message = getattr(module, kind.name)()
    fill(message, values, path)
    return message


def to_plain(value: Any) -> Any:
    """Converts a message to mappings, lists and scalars."""
    if isinstance(value, dict):
        return {name: to_plain(item) for name, item in value.items()}
    if hasattr(value, "get_fields_and_field_types"):
        return {name: to_plain(getattr(value, name)) for name in value.get_fields_and_field_types()}
    if isinstance(value, (list, tuple, numpy.ndarray, array.array)):
        return [to_plain(item) for item in value]
    return value.item() if isinstance(value, numpy.generic) else value


def _mapped(convert: Callable[[Any], Any], value: Any) -> Any:
    """Returns what to_plain() returns with all its scalars converted."""
    if isinstance(value, dict):
        return {name: _mapped(convert, item) for name, item in value.items()}
    if isinstance(value, list):
        return [_mapped(convert, item) for item in value]
    return convert(value)


def _rounded(values: Any, decimals: int = 6) -> Any:
    return _mapped(lambda value: round(value, decimals) + 0.0 if isinstance(value, float) else value, values)


def plain_to_yaml(values: Any, width: int, decimals: int) -> str:
    """Returns what to_plain() returns as YAML."""
    return yaml.safe_dump(_rounded(values, decimals), sort_keys=False, default_flow_style=None, width=width).rstrip("\n")


def to_yaml(message: Any, width: int = 120) -> str:
    """Returns a message as YAML with six decimals."""
    return plain_to_yaml(to_plain(message), width, 6)


def to_yaml_line(value: Any) -> str:
    """Returns a message, or a field of one, as YAML in one line with six decimals."""
    text = yaml.safe_dump(_rounded(to_plain(value)), sort_keys=False, default_flow_style=True, width=float("inf"))
    return text.removesuffix("\n").removesuffix("\n...")  # the end of a document that is a scalar


def to_json(values: Any) -> str:
    """Returns mappings, lists, scalars and messages as JSON in one line. JSON has no nan and no inf: they become null."""
    return json.dumps(_mapped(_json_scalar, to_plain(values)))


def _json_scalar(value: Any) -> Any:
    if isinstance(value, bytes):
        return list(value)
    return None if isinstance(value, float) and not math.isfinite(value) else value
