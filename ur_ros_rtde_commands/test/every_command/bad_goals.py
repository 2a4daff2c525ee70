"""Generates invalid goals from a valid goal, based on the field types and the comments of the .action file."""

import math
import re
from dataclasses import dataclass

import action_files
import messages
from messages import FLOATS, INTEGERS

NOT_FINITE = (math.nan, math.inf, -math.inf)
OUT_OF_RANGE = 1e30  # outside of every range
GEOMETRY = ("geometry_msgs/Point", "geometry_msgs/Vector3")
QUATERNION = "geometry_msgs/Quaternion"
OWN_PACKAGES = ("", "ur_ros_rtde_msgs", "ur_ros_rtde_tutorials")

# Values that make a command use all fields of its goal. The goal need not remain valid.
USE_ALL_FIELDS = {
    "ur_ros_rtde_msgs/action/GetForwardKinematics": {"use_tcp": True},
    "ur_ros_rtde_msgs/action/GetJacobian": {"use_tcp": True},
    "ur_ros_rtde_msgs/action/Jog": {"frame": 2},
    "ur_ros_rtde_msgs/action/EnableExternalFtSensor": {"enable": True},
}
# Fields of shared types that a command does not use, as their comments state.
UNUSED_FIELDS = {
    ("is_pose_within_safety_limits", "near"),
    ("get_jacobian", "joint_velocities"),
    ("move_c", "via.orientation"),
    ("send_secondary_script", "path"),
}


@dataclass(frozen=True)
class BadGoal:
    what: str  # "speed = nan"
    named: str  # regular expression that the rejection message has to match
    goal: object


def generate(name, kind, good):
    """Returns the invalid goals of the action `name` of type `kind`, derived from the valid goal `good`."""
    good = messages.fill(good, USE_ALL_FIELDS.get(kind, {}))
    bad = [*_invalid_floats(good, kind), *_invalid_integers(good, kind), *_invalid_arrays(good, kind), *_invalid_texts(good, kind),
           *_invalid_quaternions(good, kind), *_invalid_flags(good, kind)]
    return [case for case in bad if _in_use(name, case, good)]


def _in_use(name, case, good):
    if any(name == command and case.what.startswith(field) for command, field in UNUSED_FIELDS):
        return False
    # A waypoint of move_path uses the joint positions if given, otherwise the pose. Only arcs use `via`.
    if name == "move_path":
        index = case.what.partition("[")[2].partition("]")[0]
        waypoint = good.waypoints[int(index)] if index.isdigit() else None
        if waypoint is not None and ".via" in case.what:
            return waypoint.type == 3 and "orientation" not in case.what
        return waypoint is None or ".pose" not in case.what or not len(waypoint.joint_positions)
    return True


def _bad(good, path, value, what=None):
    return BadGoal(f"{messages.text(path)} = {value if what is None else what}", _named(path),
                   messages.with_value(good, path, value))


def _named(path):
    """Returns a regular expression for the field: the element of a list of messages, the field with its index, or the vector."""
    for index in path[:-1]:
        if isinstance(index, int):
            return rf"[a-z](\[{index}\]| {index}\b)"  # "poses[3]", "waypoint 3"
    if isinstance(path[-1], int):
        return rf"{re.escape(messages.text(path[:-1]))}.*\[{path[-1]}\]"
    return re.escape(messages.text(path[:-1] if path[-1] in ("x", "y", "z", "w") else path))


def _commented_field(leaf, kind):
    """Returns the field with its comment. None for messages of other packages, whose comments state no ranges for this action."""
    return action_files.field(leaf.field, leaf.owner or kind) if leaf.owner.partition("/")[0] in OWN_PACKAGES else None


def _with_full_arrays(good, kind):
    """Yields (goal, None) and, for each empty optional array, (goal with the array filled, path of the array)."""
    yield good, None
    for array in messages.arrays(good):
        field = _commented_field(array, kind)
        if field and field.length and not len(messages.at(good, array.path)) and field.numeric:
            yield messages.with_value(good, array.path, [0.5] * field.length), array.path


def _invalid_floats(good, kind):
    for goal, only in _with_full_arrays(good, kind):
        for leaf in messages.leaves(goal):
            if leaf.kind not in FLOATS or (only is not None and leaf.path[:-1] != only):
                continue
            for value in NOT_FINITE:
                yield _bad(goal, leaf.path, value)
            for value in _out_of_range(leaf, kind):
                yield _bad(goal, leaf.path, value)


def _out_of_range(leaf, kind):
    if leaf.owner in GEOMETRY:
        return [OUT_OF_RANGE, -OUT_OF_RANGE]
    field = _commented_field(leaf, kind)
    if field is None or isinstance(leaf.path[-1], int) and leaf.path[-1] not in (0, 5):
        return []
    low, high = field.too_low(), field.too_high()
    return [value for value in (low, None if low is None else min(-1.0, 10.0 * low), high, None if high is None else OUT_OF_RANGE)
            if value is not None]


def _invalid_integers(good, kind):
    for leaf in messages.leaves(good):
        field = _commented_field(leaf, kind)
        if leaf.kind in INTEGERS and field is not None:
            smallest, largest = INTEGERS[leaf.kind]
            high = field.too_high()
            yield _bad(good, leaf.path, largest if high is None or high <= largest else smallest)


def _invalid_arrays(good, kind):
    for array in messages.arrays(good):
        field, values = _commented_field(array, kind), list(messages.at(good, array.path))
        if array.kind.endswith("]"):
            continue  # an array of fixed length cannot be sent with another length
        for length in _wrong_lengths(field, values):
            filler = values[:1] or [0.5]
            yield _bad(good, array.path, (values + filler * length)[:length], f"{length} elements")


def _wrong_lengths(field, values):
    if field is None:
        return [len(values) - 1] if len(values) > 1 and isinstance(values[0], float) else []
    if field.length:
        return [field.length - 1, field.length + 1] + ([] if field.may_be_empty else [0])
    if field.counts:
        minimum, maximum = field.counts
        return [minimum - 1] + ([maximum + 1] if maximum <= 1000 else [])
    return []


def _invalid_texts(good, kind):
    for leaf in messages.leaves(good):
        field = _commented_field(leaf, kind)
        if leaf.kind != "string" or field is None:
            continue
        if "one line" in field.comment:
            for value in ("", "two\nlines", "a bell \a"):
                yield _bad(good, leaf.path, value, repr(value))
        limit = _max_bytes(field.comment)
        if limit:
            yield _bad(good, leaf.path, "x" * (limit + 1), f"{limit + 1} bytes")


def _max_bytes(comment):
    found = re.search(r"\b(\d+) (characters|MB)\b", comment)
    return int(found.group(1)) * (2**20 if found.group(2) == "MB" else 1) if found else None


def _invalid_quaternions(good, kind):
    for path in messages.messages_of(good, QUATERNION):
        field = action_files.field(path[0], kind)
        if field is None or "A zero quaternion:" not in field.comment:
            zero = messages.load(QUATERNION)(x=0.0, y=0.0, z=0.0, w=0.0)
            yield _bad(good, path, zero, "zero")


def _invalid_flags(good, kind):
    """Yields goals without any flag set, for arrays of flags of which "at least one" has to be set."""
    for array in messages.arrays(good):
        field = _commented_field(array, kind)
        if array.kind.startswith("boolean") and field is not None and "at least one" in field.comment:
            yield _bad(good, array.path, [False] * len(messages.at(good, array.path)), "none set")
