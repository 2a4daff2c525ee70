"""The commands as methods: those of the installed plugins, and those that the driver serves.

`ur_ros_rtde_stubs` writes their types and documentation to commands.pyi for editors and type checkers.
"""

import inspect
from collections.abc import Callable
from typing import Any

from ur_ros_rtde_cli import actions, fields, interface_files, plugins

from .connection import Connection, load
from .conversions import kinds_of, plain
from .errors import INVALID_GOAL, Rejected
from .goal import Goal, Progress

Plugin = plugins.Plugin
Method = Callable[..., Any]


def names() -> dict[str, Plugin]:
    """Returns the installed plugins by name: "move_j", "dashboard/power_on"."""
    return {plugin.name: plugin for plugin in plugins.installed()}


def documentation(kind: str, summary: str = "") -> str:
    """Returns the documentation of a command from its plugin and the comments of its .action file."""
    try:
        text = interface_files.description(kind)
    except FileNotFoundError:
        text = ""
    summary = summary.rstrip(".")
    parts = ["" if text.startswith(summary) else f"{summary}.", text]
    for title, section in (("Goal", 0), ("Result", 1)):
        lines = [f"    {field.name} ({field.type}): {field.comment}".rstrip(": ")
                 for field in interface_files.fields(kind, section).values()]
        parts.append("\n".join([f"{title}:", *lines]) if lines else "")
    return "\n\n".join(filter(None, parts))


class Group:
    """Commands with a common beginning of their names, such as those of `arm.dashboard`."""

    def __init__(self, connection: Connection, goals: set[Goal], starts: bool, prefix: str = ""):
        self._connection, self._goals, self._starts, self._prefix = connection, goals, starts, prefix

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
        full, known = self._prefix + name, names()
        if full not in known and any(other.startswith(full + "/") for other in known):
            found: Any = Group(self._connection, self._goals, self._starts, full + "/")
        else:
            found = self._method(full, known.get(full))
        setattr(self, name, found)
        return found

    def __dir__(self) -> list[str]:
        own = (name[len(self._prefix):] for name in names() if name.startswith(self._prefix))
        return [*super().__dir__(), *(name.partition("/")[0] for name in own)]

    def _method(self, name: str, plugin: Plugin | None) -> Method:
        kind = (actions.type_of(plugin) if plugin else None) or self._connection.type_of(name)
        action = load(name, kind)

        def created(*values: Any, **given: Any) -> Goal:
            goal = Goal(self._connection, name, _goal_message(name, action, values, given), self._goals.discard)
            self._goals.add(goal)
            return goal

        def start(*values: Any, **given: Any) -> Goal:
            goal = created(*values, **given)
            try:
                return goal.send()
            except BaseException:  # Ctrl-C after it was accepted
                goal.abandon()
                raise

        def call(*values: Any, on_progress: Progress | None = None, result_timeout: float | None = None, **given: Any) -> Any:
            timeout = self._connection.result_timeout if result_timeout is None else result_timeout
            goal = created(*values, **given)
            try:
                return goal.send().result(timeout, on_progress)
            except BaseException:  # Ctrl-C between the two
                goal.abandon()
                raise

        method: Any = start if self._starts else call
        method.goal = created  # returns a goal that is not sent yet
        method.__name__ = method.__qualname__ = name.rpartition("/")[2]
        method.__doc__ = documentation(kind, plugin.description if plugin else "")
        method.__signature__ = _signature(action, self._starts)
        return method


def _signature(action: Any, starts: bool) -> inspect.Signature:
    goal = action.Goal()
    parameters = [inspect.Parameter(name, inspect.Parameter.POSITIONAL_OR_KEYWORD, default=fields.to_plain(getattr(goal, name)))
                  for name in goal.get_fields_and_field_types()]
    options = () if starts else ("on_progress", "result_timeout")
    return inspect.Signature([*parameters, *(inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None) for name in options)])


def _goal_message(name: str, action: Any, values: tuple[Any, ...], given: dict[str, Any]) -> Any:
    """Returns the goal with these values, in the order of the fields or by name."""
    goal = action.Goal()
    kinds = kinds_of(goal)
    known = list(kinds)
    if len(values) > len(known):
        raise Rejected(name, INVALID_GOAL, f"{len(values)} values were given, the fields are: {', '.join(known) or 'none'}")
    twice = next((field for field in known[:len(values)] if field in given), None)
    if twice:
        raise Rejected(name, INVALID_GOAL, f"{twice} was given twice", twice)
    everything = {**dict(zip(known, values, strict=False)), **given}
    try:
        fields.fill(goal, {field: plain(kinds.get(field), value) for field, value in everything.items()})
    except fields.FieldError as error:
        raise Rejected(name, INVALID_GOAL, str(error), fields.field_name(error.path)) from None
    return goal


class Commands(Group):
    """All commands. A call waits for the result.

    Fields of the goal are given in their order or by name, as numbers, lists, numpy arrays, mappings or messages. Further arguments:
    `on_progress` is called with each feedback message; `result_timeout` (s) replaces that of the Robot.

    Raises Rejected if the goal is not accepted, CommandFailed if it fails, NoDriver, and Timeout.
    """

    def __init__(self, connection: Connection, goals: set[Goal]):
        super().__init__(connection, goals, starts=False)


class StartedCommands(Group):
    """All commands. A call returns the Goal as soon as it is accepted."""

    def __init__(self, connection: Connection, goals: set[Goal]):
        super().__init__(connection, goals, starts=True)
