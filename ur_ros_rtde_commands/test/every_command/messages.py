"""Creates, traverses and modifies ROS messages by introspection."""

import copy
import importlib
import re
from dataclasses import dataclass
from typing import Tuple, Union

Path = Tuple[Union[str, int], ...]  # ("waypoints", 0, "positions", 3)
FLOATS = ("double", "float")
INTEGERS = {f"{sign}int{bits}": ((0, 2**bits - 1) if sign else (-2**(bits - 1), 2**(bits - 1) - 1))
            for sign in ("", "u") for bits in (8, 16, 32, 64)}


def load(name):
    """Returns the class of a type such as "ur_ros_rtde_msgs/action/MoveJ" or "geometry_msgs/Pose"."""
    package, *kind, message = name.split("/")
    return getattr(importlib.import_module(f"{package}.{kind[0] if kind else 'msg'}"), message)


def has_standard_result(action):
    """Returns whether the result of the action type has the fields success, error_code and message."""
    return {"success", "error_code", "message"} <= set(load(action).Result.get_fields_and_field_types())


def element_type(kind):
    """Returns the element type of an array or sequence: "double" for "sequence<double, 3>" and "double[6]". Otherwise None."""
    found = re.fullmatch(r"sequence<([^,>]+).*>|(.+)\[\d+\]", kind)
    return (found.group(1) or found.group(2)) if found else None


def is_message(kind):
    return "/" in kind


def fill(message, values):
    """Sets the fields in the mapping `values`. Raises ValueError with the field if a name or type is wrong."""
    kinds = message.get_fields_and_field_types()
    for name, value in (values or {}).items():
        if name not in kinds:
            raise ValueError(f"{type(message).__name__} has no field {name}; it has {', '.join(kinds)}")
        try:
            setattr(message, name, _converted(kinds[name], value, getattr(message, name)))
        except (AssertionError, TypeError) as error:
            raise ValueError(f"{name}: {value!r} does not fit {kinds[name]}: {error}") from None
    return message


def _converted(kind, value, present):
    element = element_type(kind)
    if element is not None:
        return [_converted(element, item, None) for item in value]
    if is_message(kind):
        return fill(copy.deepcopy(present) if present is not None else load(kind)(), value)
    # YAML distinguishes 1 and 1.0; both are accepted for floats.
    return float(value) if kind in FLOATS and isinstance(value, int) and not isinstance(value, bool) else value


@dataclass(frozen=True)
class Leaf:
    path: Path
    kind: str
    owner: str  # the message type that the field belongs to, "" for the goal itself
    field: str  # the name of the field in its owner


def leaves(message, path=(), owner=""):
    """Yields all fields of primitive types, and all elements of arrays of primitive types."""
    for name, kind in message.get_fields_and_field_types().items():
        value, here, element = getattr(message, name), (*path, name), element_type(kind)
        if element is None:
            if is_message(kind):
                yield from leaves(value, here, kind)
            else:
                yield Leaf(here, kind, owner, name)
        else:
            for index, item in enumerate(value):
                if is_message(element):
                    yield from leaves(item, (*here, index), element)
                else:
                    yield Leaf((*here, index), element, owner, name)


def arrays(message, path=(), owner=""):
    """Yields all array fields, including nested ones, as a Leaf whose path ends at the array."""
    for name, kind in message.get_fields_and_field_types().items():
        value, here, element = getattr(message, name), (*path, name), element_type(kind)
        if element is not None:
            yield Leaf(here, kind, owner, name)
        for where, item in ([(here, value)] if element is None else [((*here, i), item) for i, item in enumerate(value)]):
            if is_message(element or kind):
                yield from arrays(item, where, element or kind)


def messages_of(message, kind, path=()):
    """Yields the paths of all nested messages of type `kind`."""
    for name, found in message.get_fields_and_field_types().items():
        value, here, element = getattr(message, name), (*path, name), element_type(found)
        for where, item in ([(here, value)] if element is None else [((*here, i), item) for i, item in enumerate(value)]):
            if not is_message(element or found):
                continue
            if (element or found) == kind:
                yield where
            yield from messages_of(item, kind, where)


def at(message, path):
    for part in path:
        message = message[part] if isinstance(part, int) else getattr(message, part)
    return message


def with_value(message, path, value):
    """Returns a copy of the message with another value at the path."""
    copied = copy.deepcopy(message)
    owner = at(copied, path[:-1])
    if isinstance(path[-1], int):
        owner[path[-1]] = value
    else:
        setattr(owner, path[-1], value)
    return copied


def text(path):
    """Formats a path: ("waypoints", 0, "speed") becomes "waypoints[0].speed"."""
    return "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in path).lstrip(".")
