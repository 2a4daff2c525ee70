"""Launch descriptions that reject unknown arguments and invalid values before anything is started."""

from typing import Any, Callable, Collection, Dict, Iterable, List, Sequence

from launch import LaunchContext, LaunchDescription, LaunchDescriptionEntity
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from .launch_arguments import Argument, check_name, to_values

Start = Callable[[LaunchContext, Dict[str, Any]], Sequence[LaunchDescriptionEntity]]

# Arguments that `ros2 launch` adds itself.
LAUNCH_OWN = {"launch-prefix", "launch-prefix-filter"}


def make_launch_description(launch_file: str, arguments: Sequence[Argument], start: Start,
                            entities: Iterable[LaunchDescriptionEntity] = (), replaced: Collection[str] = ()) -> LaunchDescription:
    """Returns a description that checks and declares the arguments, and then executes the entities.

    `start` receives the values of the given arguments and returns further entities, which are executed before `entities`.
    `replaced` are arguments of included launch files that this launch file sets itself.
    """
    given: Dict[str, str] = {}

    def check(context: LaunchContext) -> None:
        declared = {argument.name for argument in description.get_launch_arguments()}
        passed = _passed_names(context, description)
        for name in passed:
            check_name(name, (declared - set(replaced)) | LAUNCH_OWN, launch_file)
        passed += [argument.split(":=")[0] for argument in context.argv or ()]
        given.clear()
        given.update(_given(context, arguments, passed))
        to_values(arguments, given)

    def run(context: LaunchContext) -> Sequence[LaunchDescriptionEntity]:
        return start(context, to_values(arguments, given))

    description = LaunchDescription([OpaqueFunction(function=check), *map(_declaration, arguments), OpaqueFunction(function=run),
                                     *entities])
    return description


def _declaration(argument: Argument) -> DeclareLaunchArgument:
    return DeclareLaunchArgument(argument.name, default_value=argument.default_text, description=argument.help,
                                 choices=list(argument.text_choices) or None)


def _given(context: LaunchContext, arguments: Sequence[Argument], passed: Collection[str]) -> Dict[str, str]:
    """Returns the arguments whose value was given. A default value may remain from a launch file that was included before."""
    texts = context.launch_configurations
    return {argument.name: texts[argument.name] for argument in arguments
            if texts.get(argument.name) and (argument.name in passed or texts[argument.name] != argument.default_text)}


def _passed_names(context: LaunchContext, description: LaunchDescription) -> List[str]:
    """Returns the arguments that the including launch file passes to this description.

    Launch configurations cannot be used, because they also contain the arguments of all including launch files.
    """
    root = getattr(context.get_locals_as_dict().get("event"), "launch_description", None)
    return [perform_substitutions(context, normalize_to_list_of_substitutions(name))
            for include in _includes(root) if include.launch_description_source.try_get_launch_description_without_context()
            is description for name, _ in include.launch_arguments]


def _includes(entity: Any) -> Iterable[IncludeLaunchDescription]:
    if entity is None:
        return
    if isinstance(entity, IncludeLaunchDescription):
        yield entity
    for sub_entity in entity.describe_sub_entities():
        yield from _includes(sub_entity)
    for _, sub_entities in entity.describe_conditional_sub_entities():
        for sub_entity in sub_entities:
            yield from _includes(sub_entity)
