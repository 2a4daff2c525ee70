"""Describes the form of an action: one input for each field of its goal, with text, unit, range and default.

The fields are those of the generated class; texts, units and ranges are those of the comments in the installed interface files.

    form = describe("/move_j", MoveJ)
    goal = form.read({**form.defaults(), ("speed",): "0.2"})
"""

import importlib
import re
from dataclasses import dataclass
from enum import Enum, auto
from typing import Any, Dict, Iterator, List, Mapping, Tuple, Union

from rosidl_parser import definition as idl
from ur_ros_rtde_cli import fields, interface_files
from ur_ros_rtde_cli.fields import FieldError, Path

Input = Union[str, bool]  # what the page has in an input


class Kind(Enum):
    FLAG = auto()  # true or false
    CHOICE = auto()  # one of the constants of the interface
    TEXT = auto()  # a string, used as it is
    NUMBER = auto()
    LIST = auto()  # values with commas: an array, or the numbers of a message such as a point
    YAML = auto()  # YAML in several lines: a list of messages


class Source(Enum):
    """State of the arm that an input begins with."""

    NONE = auto()
    JOINT_POSITIONS = auto()
    TCP_POSITION = auto()
    TCP_ORIENTATION = auto()

    @property
    def is_in_base(self) -> bool:
        return self in (Source.TCP_POSITION, Source.TCP_ORIENTATION)


FRAME = ("frame_id",)  # path of the field that names the frame of the poses; empty: base


@dataclass(frozen=True)
class FormField:
    path: Path  # ("pose", "position")
    kind: Kind
    default: Input
    comment: str = ""
    parts: Tuple[str, ...] = ()  # of a message in one line: ("x", "y", "z")
    choices: Tuple[str, ...] = ()  # names of constants
    values: Tuple[int, ...] = ()  # of the choices
    multiline: bool = False
    source: Source = Source.NONE

    @property
    def unit(self) -> str:
        """The unit, if it is the only one: "rad/s". Of "N and Nm", the first belongs to forces, the second to torques."""
        units = set(re.findall(r"\bUnit: (.+?)\.(?=\s|$)", self.comment))
        if len(units) != 1 or self.parts[-1:] == ("w",):
            return ""
        first, _, second = units.pop().partition(" and ")
        return second if second and self.path[-1] in ("angular", "torque") else first

    @property
    def label(self) -> str:
        name = fields.field_name(self.path).replace("_", " ")
        parts = f" ({', '.join(self.parts)})" if self.parts else ""
        return f"{name}{parts}" + (f" [{self.unit}]" if self.unit else "")

    @property
    def limits(self) -> str:
        """Unit, size and range in the words of the comment."""
        return " ".join(re.findall(r"\b(?:(?:Unit|Size|Order|Range(?: of [^:.]*)?|Orientation): .+?\.)(?=\s|$)", self.comment))


@dataclass(frozen=True)
class Form:
    name: str  # of the action, "move_j"
    action: Any  # class of the action type
    description: str
    fields: Tuple[FormField, ...]

    def defaults(self) -> Dict[Path, Input]:
        return {field.path: field.default for field in self.fields}

    def read(self, inputs: Mapping[Path, Input]) -> Any:
        """Returns the goal. Raises FieldError with field, value, expected values and limits."""
        goal = self.action.Goal()
        for field in self.fields:
            try:
                fields.fill(goal, _nested(field.path, _value(field, inputs[field.path])))
            except FieldError as error:
                raise FieldError(error.path, f"{error}. {field.limits}".rstrip(". ") + ".") from None
        return goal


def describe(name: str, action: Any) -> Form:
    """Returns the form of the action `name` with this type, such as MoveJ."""
    goal = action.Goal()
    kind = f"{action.__module__.split('.')[0]}/action/{action.__name__}"
    try:
        description = interface_files.description(kind)
    except FileNotFoundError:
        description = ""
    return Form(name, action, description, tuple(_fields_of(goal, kind, (), "")))


def _nested(path: Path, value: Any) -> Any:
    for name in reversed(path):
        value = {name: value}
    return value


def _fields_of(message: Any, interface: str, path: Path, comment_above: str) -> Iterator[FormField]:
    """Yields the inputs of a message whose comments are in `interface`; without comments, that of the enclosing field is used."""
    comments, constants = interface_files.fields(interface), interface_files.constants(interface)
    for name, kind in zip(message.get_fields_and_field_types(), message.SLOT_TYPES):
        if name == "structure_needs_at_least_one_member":
            continue
        comment = comments[name].comment if name in comments and comments[name].comment else comment_above
        yield from _inputs(getattr(message, name), kind, (*path, name), comment, constants)


def _inputs(value: Any, kind: Any, path: Path, comment: str, constants: Mapping[str, Any]) -> Iterator[FormField]:
    if isinstance(kind, idl.NamespacedType):
        parts = tuple(value.get_fields_and_field_types())
        if all(isinstance(part, idl.BasicType) and part.typename != idl.BOOLEAN_TYPE for part in value.SLOT_TYPES):
            numbers = [getattr(value, part) for part in parts]
            yield FormField(path, Kind.LIST, _in_one_line(numbers), comment, parts, source=_source_of_message(kind.name, comment))
        else:
            yield from _fields_of(value, f"{kind.namespaces[0]}/msg/{kind.name}", path, comment)
    elif isinstance(kind, idl.AbstractNestedType):
        yield _list_input(value, kind, path, comment)
    elif isinstance(kind, idl.AbstractGenericString):
        yield FormField(path, Kind.TEXT, value, comment, multiline="URScript program" in comment)
    elif kind.typename == idl.BOOLEAN_TYPE:
        yield FormField(path, Kind.FLAG, bool(value), comment)
    else:
        yield _number_input(value, path, comment, constants)


def _number_input(value: Any, path: Path, comment: str, constants: Mapping[str, Any]) -> FormField:
    named = [name for name in constants if re.search(rf"\b{name}\b", comment)]
    values = tuple(int(constants[name].value) for name in named)
    if value in values:
        texts = "".join(f" {name}: {constants[name].comment}" for name in named if constants[name].comment)
        return FormField(path, Kind.CHOICE, named[values.index(value)], comment + texts, choices=tuple(named), values=values)
    return FormField(path, Kind.NUMBER, str(value), comment)


def _list_input(value: Any, kind: Any, path: Path, comment: str) -> FormField:
    if isinstance(kind.value_type, idl.NamespacedType):
        return FormField(path, Kind.YAML, _template(kind.value_type), comment, multiline=True)
    values: List[Any] = fields.to_plain(value)
    exact = re.search(r"Size: exactly (\d+)\b(?!, or empty)", comment)
    if exact and path[-1] == "joint_positions":  # empty without a robot: zeros would be a target that the user has not chosen
        return FormField(path, Kind.LIST, "", comment, source=Source.JOINT_POSITIONS)
    return FormField(path, Kind.LIST, _in_one_line(values or [0.0] * int(exact.group(1) if exact else 0)), comment)


def _source_of_message(name: str, comment: str) -> Source:
    if "active TCP" not in comment:
        return Source.NONE
    return {"Point": Source.TCP_POSITION, "Quaternion": Source.TCP_ORIENTATION}.get(name, Source.NONE)


def _template(kind: Any) -> str:
    """Returns a list with one message, all of whose fields have their defaults, as YAML."""
    message = getattr(importlib.import_module(".".join(kind.namespaces)), kind.name)()
    lines = fields.to_yaml(message, width=60).splitlines()
    return "\n".join(("- " if number == 0 else "  ") + line for number, line in enumerate(lines))


def _in_one_line(values: List[Any]) -> str:
    return ", ".join(str(value).lower() if isinstance(value, bool) else str(value) for value in values)


def numbers_text(values: Any) -> str:
    """Returns numbers of the robot's state as the text of an input, with four decimals."""
    return ", ".join(f"{float(value):.4f}" for value in values)


def _value(field: FormField, value: Input) -> Any:
    """Converts what an input contains to a value for `fields.fill`."""
    if field.kind == Kind.CHOICE:
        return field.values[field.choices.index(str(value))] if value in field.choices else value
    if field.kind in (Kind.FLAG, Kind.TEXT):
        return value
    text = str(value).strip()
    if not text and field.kind == Kind.NUMBER:
        raise FieldError(field.path, f"{fields.field_name(field.path)} is empty: expected a number such as {field.default}")
    if field.kind == Kind.LIST and not text.startswith("["):
        text = f"[{text}]"
    parsed = fields.parse_value(text, field.path)
    return _named_parts(field, parsed) if field.parts else parsed


def _named_parts(field: FormField, values: Any) -> Dict[str, Any]:
    if not isinstance(values, list) or len(values) != len(field.parts):
        found = f"has {len(values)} values" if isinstance(values, list) else f"is {values!r}"
        raise FieldError(field.path, f"{fields.field_name(field.path)} {found}: expected {len(field.parts)} numbers, "
                                     f"{', '.join(field.parts)}")
    return dict(zip(field.parts, values))
