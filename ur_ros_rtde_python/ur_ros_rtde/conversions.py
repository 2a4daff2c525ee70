"""Converts numbers, numpy arrays and messages into the fields of goals, and messages into numpy arrays."""

import importlib
from collections import deque
from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

import numpy
from numpy.typing import ArrayLike, NDArray
from rosidl_parser import definition as idl
from ur_ros_rtde_cli import fields

JOINT_COUNT = 6
Array: TypeAlias = NDArray[numpy.float64]


def interface(name: str) -> Any:
    """Returns the class of an interface such as "ur_ros_rtde_msgs/msg/GoalRejected". Imported on use, because that takes time."""
    package, folder, kind = name.split("/")
    return getattr(importlib.import_module(f"{package}.{folder}"), kind)


def pose(position: ArrayLike, orientation: ArrayLike = (0.0, 0.0, 0.0, 1.0)) -> Array:
    """Returns a pose as the goals take it: x, y, z (m), and a quaternion x, y, z, w.

    `orientation` is a quaternion (4 numbers) or a rotation vector in rad (3 numbers), as on the teach pendant.
    """
    rotation = numpy.asarray(orientation, float)
    if rotation.shape == (3,):
        angle = float(numpy.linalg.norm(rotation))
        half_sinc = numpy.sinc(angle / (2.0 * numpy.pi)) / 2.0  # sin(angle / 2) / angle
        rotation = numpy.append(half_sinc * rotation, numpy.cos(angle / 2.0))
    if rotation.shape != (4,):
        raise ValueError(f"orientation has {rotation.size} numbers: expected a quaternion (4) or a rotation vector (3)")
    where = numpy.asarray(position, float)
    if where.shape != (3,):
        raise ValueError(f"position has {where.size} numbers: expected 3")
    return numpy.concatenate((where, rotation))


def trajectory(times: ArrayLike, positions: ArrayLike, velocities: ArrayLike | None = None, accelerations: ArrayLike | None = None, *,
               joint_names: Sequence[str] = (), start_at: float = 0.0) -> Any:
    """Returns a trajectory_msgs/JointTrajectory for execute_parametrized_trajectory and follow_joint_trajectory.

    `times` are the N times from the start in s. The other arrays have N rows of 6 joints in rad, rad/s and rad/s^2. For
    follow_joint_trajectory, which needs `joint_names`: `start_at` is the time of its start in s since the epoch, so that several arms
    start together; 0, and a time that is over when the goal arrives: at once.
    """
    if start_at and not joint_names:
        raise ValueError("start_at needs joint_names: follow_joint_trajectory heeds it, execute_parametrized_trajectory does not")
    duration, point = interface("builtin_interfaces/msg/Duration"), interface("trajectory_msgs/msg/JointTrajectoryPoint")
    seconds = numpy.asarray(times, float)
    if seconds.ndim != 1:
        raise ValueError(f"times has the shape {seconds.shape}: expected one number for each point")
    columns = {"positions": positions, "velocities": velocities, "accelerations": accelerations}
    arrays = {name: numpy.asarray(values, float) for name, values in columns.items() if values is not None}
    for name, values in arrays.items():
        if values.shape != (len(seconds), JOINT_COUNT):
            raise ValueError(f"{name} has the shape {values.shape}: expected {(len(seconds), JOINT_COUNT)}")
    points = [point(time_from_start=duration(**_parts(time)), **{name: values[index].tolist() for name, values in arrays.items()})
              for index, time in enumerate(seconds)]
    message = interface("trajectory_msgs/msg/JointTrajectory")(joint_names=list(joint_names), points=points)
    message.header.stamp = interface("builtin_interfaces/msg/Time")(**_parts(start_at))
    return message


def _parts(seconds: float) -> dict[str, int]:
    """Returns the fields of a time or duration."""
    nanoseconds = round(1e9 * seconds)
    return {"sec": nanoseconds // 10**9, "nanosec": nanoseconds % 10**9}


def numbers(message: Any) -> Array:
    """Returns the numbers of a message in the order of its fields: a pose as x, y, z and the quaternion x, y, z, w."""
    if not hasattr(message, "get_fields_and_field_types"):
        return numpy.atleast_1d(numpy.asarray(message, float))
    return numpy.concatenate([numbers(getattr(message, name)) for name in message.get_fields_and_field_types()])


def plain(kind: Any, value: Any) -> Any:
    """Returns the value of a field of the type `kind` as mappings, lists and scalars.

    A message that contains only floating-point numbers may be given as their sequence: a pose as 7 numbers or, with a position
    only, as 3; a waypoint as 6.
    """
    if hasattr(value, "get_fields_and_field_types"):
        return fields.to_plain(value)
    if isinstance(value, (numpy.ndarray, numpy.generic)):
        value = value.tolist()
    if isinstance(value, Sequence) and not isinstance(value, (str, bytes)):
        value = [item.item() if isinstance(item, numpy.generic) else item for item in value]
        if isinstance(kind, idl.AbstractNestedType):
            return [plain(kind.value_type, item) for item in value]
        from_numbers = _mapping(kind, value) if isinstance(kind, idl.NamespacedType) else None
        return list(value) if from_numbers is None else from_numbers
    if isinstance(value, Mapping) and isinstance(kind, idl.NamespacedType):
        kinds = kinds_of(_message_type(kind))
        return {name: plain(kinds.get(name), item) for name, item in value.items()}
    return value


def _message_type(kind: Any) -> Any:
    return interface("/".join((*kind.namespaces, kind.name)))


def kinds_of(message: Any) -> dict[str, Any]:
    """Returns the types of the fields of a message by name."""
    return dict(zip(message.get_fields_and_field_types(), message.SLOT_TYPES, strict=True))


def _mapping(kind: Any, values: Sequence[Any]) -> dict[str, Any] | None:
    """Returns the fields of a message from its numbers, or None if they do not fit. Trailing messages may be missing."""
    if not values or not all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in values):
        return None
    rest = deque(values)
    try:
        found = _take(_message_type(kind), rest)
    except (IndexError, TypeError):
        return None
    return None if rest else found


def _take(message: Any, rest: deque[Any]) -> dict[str, Any]:
    """Takes the fields of a message from `rest`. Raises IndexError if numbers are missing, TypeError for other fields."""
    taken: dict[str, Any] = {}
    for name, kind in kinds_of(message).items():
        if isinstance(kind, idl.NamespacedType):
            if rest:
                taken[name] = _take(_message_type(kind), rest)
        elif isinstance(kind, idl.BasicType) and kind.typename in idl.FLOATING_POINT_TYPES:
            taken[name] = rest.popleft()
        elif isinstance(kind, idl.UnboundedSequence) and getattr(kind.value_type, "typename", "") in idl.FLOATING_POINT_TYPES:
            taken[name] = list(rest)
            rest.clear()
        else:
            raise TypeError(name)
    return taken
