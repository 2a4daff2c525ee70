"""Prints the lines that let bash or zsh complete `ur`: commands, options, actions and the fields of a goal.

    eval "$(ur completion bash)"      in ~/.bashrc or in the running shell
    eval "$(ur completion zsh)"       in ~/.zshrc

In a checkout, `./ur` is completed too.
"""

import argparse
import importlib
from typing import Any, Iterable, List

from .errors import CliError

SHELLS = ("bash", "zsh")
PROGRAMS = ("ur", "./ur")
BASH_COMPLETION_IN_ZSH = "autoload -U +X compinit && compinit\nautoload -U +X bashcompinit && bashcompinit\n"
# Calls argcomplete in the program. Not argcomplete's own code: that for zsh loses the quote that opens a goal, in some versions (3.1.4)
# also all after a colon, and some versions (1.8) have none that can be called.
CODE = """\
_ur_complete() {
  local IFS=$'\\013'
  COMPREPLY=($(COMP_LINE="$COMP_LINE" COMP_POINT="$COMP_POINT" COMP_TYPE="$COMP_TYPE" _ARGCOMPLETE=1 \\
               _ARGCOMPLETE_COMP_WORDBREAKS="$COMP_WORDBREAKS" "$1" 8>&1 9>/dev/null 1>/dev/null 2>&1))
}
complete -o nospace -o default -o bashdefault -F _ur_complete """ + " ".join(PROGRAMS)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("shell", choices=SHELLS)


def run(options: argparse.Namespace) -> int:
    _argcomplete()  # raises an error now if it is missing: the shell would show none
    print((BASH_COMPLETION_IN_ZSH if options.shell == "zsh" else "") + CODE)
    return 0


def _argcomplete() -> Any:
    try:
        return importlib.import_module("argcomplete")
    except ImportError:
        raise CliError("completion needs argcomplete: sudo apt install python3-argcomplete, or pip install argcomplete") from None


def complete(parser: argparse.ArgumentParser) -> None:
    """Answers the shell and exits."""
    _argcomplete().autocomplete(parser, always_complete_options=False)


def action_names(**_: Any) -> List[str]:
    from .actions import plugin_names  # imported here because other completions do not need the plugins
    return plugin_names()


def goal(prefix: str, parsed_args: argparse.Namespace, **_: Any) -> Iterable[str]:
    """Completes the goal of the action: all fields with their defaults, or the name or the default of the last field."""
    from . import actions, fields  # imported here because they need ROS
    name = actions.split_name(parsed_args.action, "")[1]
    kind = actions.type_of_plugin(name)
    if kind is None:
        return []
    message = actions.load(name, kind).Goal()
    if not prefix.startswith("{"):
        return [fields.to_yaml_line(message)]
    last = max(prefix.rfind("{"), prefix.rfind(", "))
    begin, text = prefix[:last + 1], prefix[last + 1:].lstrip()
    begin += " " if begin.endswith(",") else ""
    name, colon, value = text.partition(":")
    names = [field for field in message.get_fields_and_field_types() if f"{field}:" not in begin]
    if not colon:
        return [f"{begin}{field}: " for field in names if field.startswith(name)]
    default = fields.to_yaml_line(getattr(message, name)) if name in names else ""
    return [f"{begin}{name}: {default}"] if default.startswith(value.strip()) else []
