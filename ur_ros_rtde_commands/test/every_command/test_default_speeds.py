"""Default speeds and accelerations do not exceed the defaults of movej and movel in URScript."""

import re

import action_files
import messages
import plugins
import pytest

MAX_DEFAULTS = {"rad/s": 1.05, "rad/s^2": 1.4, "m/s": 0.25, "m/s^2": 1.2}
UNIT = re.compile(r"\b(?:rad|m)/s(?:\^2)?(?![\w^])")
# The meaning of an empty list of limits if the goal specifies times.
LIMITS_OF_TIMED_GOALS = {("ExecuteParametrizedTrajectory", "max_velocity"): "Empty: the speed limits of the arm model",
                         ("ExecuteParametrizedTrajectory", "max_acceleration"): "Empty: 5 for each joint"}

ACTIONS = sorted({f"{file.parents[1].name}/action/{file.stem}" for file in action_files.paths(
    {"ur_ros_rtde_msgs", *(plugin.package for plugin in plugins.find().values())})})


def limit_of(field):
    """Returns the smallest limit for the units in the field's comment. None if it is neither a speed nor an acceleration.

    Decelerations are not limited.
    """
    if not field.numeric or "deceleration" in field.name or field.name == "time":
        return None
    return min((MAX_DEFAULTS[unit] for unit in UNIT.findall(field.comment)), default=None)


def limits_of(field, count):
    """Returns the limit of each value. Six values with two units are three translational and three rotational limits of the TCP."""
    units = UNIT.findall(field.comment)
    if count == 6 and units == ["m/s", "rad/s"]:
        return [MAX_DEFAULTS["m/s"]] * 3 + [MAX_DEFAULTS["rad/s"]] * 3
    return [limit_of(field)] * count


def speeds(message, kind):
    """Yields (field, default) of all speeds and accelerations of a goal and its nested messages."""
    for name, type_name in message.get_fields_and_field_types().items():
        element = messages.element_type(type_name)
        if messages.is_message(element or type_name):
            inner = element or type_name
            if inner.startswith("ur_ros_rtde"):
                yield from speeds(messages.load(inner)(), inner)
            continue
        field = action_files.field(name, kind)
        if field is not None and limit_of(field) is not None:
            yield field, getattr(message, name)


@pytest.mark.parametrize("kind", ACTIONS)
def test_defaults_do_not_exceed_the_defaults_of_urscript(kind):
    for field, default in speeds(messages.load(kind).Goal(), kind):
        values = list(default) if hasattr(default, "__len__") else [default]
        for value, limit in zip(values, limits_of(field, len(values))):
            assert abs(value) <= limit, f"{field.name} is {value} by default, the limit is {limit}: {field.comment}"


@pytest.mark.parametrize("kind", ACTIONS)
def test_comments_of_empty_limits_state_slow_defaults(kind):
    for field, default in speeds(messages.load(kind).Goal(), kind):
        if field.name.startswith("max_") and field.type.endswith("[]"):
            expected = LIMITS_OF_TIMED_GOALS.get((kind.split("/")[-1], field.name), f"Empty: {limit_of(field)} for each joint")
            assert len(default) == 0 and expected in field.comment, f"{field.name}: {field.comment}"


@pytest.mark.parametrize("action", ["ServoJ", "ServoL"])
def test_the_default_time_of_servo_motions_is_zero(action):
    assert messages.load(f"ur_ros_rtde_msgs/action/{action}").Goal().time == 0.0


def test_finds_speeds_and_accelerations():
    found = {(kind.split("/")[-1], field.name) for kind in ACTIONS for field, _ in speeds(messages.load(kind).Goal(), kind)}
    assert {("MoveJ", "speed"), ("MoveL", "acceleration"), ("MovePath", "speed"), ("ForceMode", "limits"), ("Jog", "acceleration"),
            ("ExecuteTrajectory", "max_velocity"), ("ExecuteCartesianPath", "rotation_speed"), ("DirectTorque", "max_joint_speed"),
            ("MoveDownUntilForce", "speed")} <= found
    assert not [name for _, name in found if "deceleration" in name]


@pytest.mark.parametrize("comment, limit", [("Speed of the TCP. Unit: m/s. Range: above 0, at most 3.", 0.25),
                                            ("Acceleration of the leading joint. Unit: rad/s^2.", 1.4),
                                            ("MOVE_J: Unit: rad/s. Range: at most 3.14. Other types: Unit: m/s.", 0.25),
                                            ("Unit: m. Range: 0 to 2.", None), ("Unit: rad/s^3. Size: exactly 6.", None)])
def test_reads_units_from_comments(comment, limit):
    assert limit_of(action_files.Field("float64", "speed", comment)) == limit
