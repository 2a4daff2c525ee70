"""Messages from YAML and to YAML."""

import array
import importlib
from typing import Any

import numpy
import yaml
from rosidl_parser.definition import AbstractNestedType, NamespacedType

from .problem import Problem


def read(text: str, message: Any) -> Any:
    """Fills `message` from a YAML mapping; what is not named keeps its default."""
    try:
        values = yaml.safe_load(text or "{}")
    except yaml.YAMLError as error:
        raise Problem(f"the goal is not YAML: {error}")
    fill(message, values if values is not None else {}, "")
    return message


def fill(message: Any, values: Any, where: str) -> None:
    if not isinstance(values, dict):
        raise Problem(f"{where or 'the goal'} is {values!r}: it must be a mapping of fields, as in {{speed: 0.5}}")
    types = dict(zip(message.get_fields_and_field_types(), message.SLOT_TYPES))
    for name, value in values.items():
        path = f"{where}.{name}" if where else str(name)
        if name not in types:
            raise Problem(f"there is no field {path}; there are: {', '.join(types) or 'none'}")
        try:
            setattr(message, name, _value(types[name], getattr(message, name), value, path))
        except (AssertionError, TypeError, ValueError, OverflowError) as error:
            kind = message.get_fields_and_field_types()[name]
            raise Problem(f"{path} is {value!r}: it must be of type {kind} ({' '.join(str(error).split())})")


def _value(kind: Any, old: Any, value: Any, path: str) -> Any:
    if isinstance(kind, NamespacedType):
        fill(old, value, path)
        return old
    if isinstance(kind, AbstractNestedType):
        if not isinstance(value, list):
            raise ValueError("a list is needed")
        if isinstance(kind.value_type, NamespacedType):
            return [_message(kind.value_type, item, f"{path}[{index}]") for index, item in enumerate(value)]
        return [_scalar(old, item) for item in value]
    return type(old)(value) if isinstance(value, int) and isinstance(old, float) else value


def _scalar(old: Any, item: Any) -> Any:
    """YAML's 1 is a float where floats are needed."""
    floats = (isinstance(old, numpy.ndarray) and old.dtype.kind == "f") or (isinstance(old, array.array) and old.typecode in "fd")
    return float(item) if floats and isinstance(item, int) and not isinstance(item, bool) else item


def _message(kind: NamespacedType, values: Any, path: str) -> Any:
    module = importlib.import_module(".".join(kind.namespaces))
    message = getattr(module, kind.name)()
    fill(message, values, path)
    return message


def plain(value: Any) -> Any:
    """A message as mappings, lists and scalars."""
    if hasattr(value, "get_fields_and_field_types"):
        return {name: plain(getattr(value, name)) for name in value.get_fields_and_field_types()}
    if isinstance(value, (list, tuple, numpy.ndarray, array.array)):
        return [plain(item) for item in value]
    return value.item() if isinstance(value, numpy.generic) else value


def _rounded(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _rounded(item) for name, item in value.items()}
    if isinstance(value, list):
        return [_rounded(item) for item in value]
    return round(value, 6) + 0.0 if isinstance(value, float) else value


def show(message: Any) -> str:
    """For people: YAML, six digits behind the point."""
    return yaml.safe_dump(_rounded(plain(message)), sort_keys=False, default_flow_style=None, width=120).rstrip("\n")
