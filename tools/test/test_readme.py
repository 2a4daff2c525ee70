"""Links and commands on the pages are valid. The tests of ur_ros_rtde_tutorials run the examples of the README."""

import argparse
import importlib
import itertools
import re
import shlex
import subprocess

import pytest
import yaml
from ur_ros_rtde_cli.main import CHECKOUT_COMMANDS, COMMANDS, VIEW, _parse_arguments
from ur_ros_rtde_launch.launch_arguments import DRIVER, MODELS, MOVEIT, SIDES, TWO_ROBOTS, check_name, to_values
from ur_ros_rtde_viewer import program as program_of_viewer
from ur_tools import main, packages, selection, simulation
from ur_tools.environment import program
from ur_tools.layout import ROOT, Layout

BACKGROUND = True
PAGES = {path: path.read_text() for path in (*ROOT.glob("*.md"), *ROOT.glob("*/*.md"), *ROOT.glob("docs/*/**/*.md"))}
README = (ROOT / "README.md").read_text()
CONTRIBUTING = (ROOT / "CONTRIBUTING.md").read_text()
LAUNCH_FILES = {"driver": DRIVER, "two_robots": (*TWO_ROBOTS, *DRIVER), "moveit": (*MOVEIT, *DRIVER)}


def blocks():
    return re.findall(r"```bash\n(.*?)```", README, re.S)


def anchors(text):
    """Returns the anchors that GitHub gives to the headings of a page."""
    headings = re.findall(r"^#+ (.*)$", re.sub(r"^```.*?^```", "", text, flags=re.S | re.M), re.M)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


def test_every_link_refers_to_an_existing_file_and_heading():
    broken = []
    for page, text in PAGES.items():
        for link in re.findall(r"\]\((?!https?:)([^)\s]+)\)", re.sub(r"```.*?```", "", text, flags=re.S)):
            name, _, anchor = link.partition("#")
            target = (page.parent / name).resolve() if name else page
            if not target.exists() or anchor and anchor not in anchors(PAGES.get(target, "")):
                broken.append(f"{page.relative_to(ROOT)}: {link}")
    assert not broken, "\n".join(broken)


def test_every_patch_of_ur_rtde_is_listed_with_its_title():
    page = (ROOT / "docs" / "internals" / "ur_rtde_patches.md").read_text()
    patches = sorted((ROOT / "ur_rtde_vendor" / "patches").glob("*.patch"))
    listed = re.findall(r"^\| \[\d{4}\]\(\.\./\.\./ur_rtde_vendor/patches/([\w.-]+)\) (.+?) \|", page, re.M)
    assert listed == [(patch.name, patch.read_text().split("\n")[0]) for patch in patches]


def test_every_program_in_a_command_exists():
    missing = [path for block in blocks() for path in re.findall(r"python3 (\S+)", block) if not (ROOT / path).is_file()]
    missing += [program for package, program in re.findall(r"ros2 run (\w+) ([\w.]+)", README)
                if program not in (ROOT / package / "CMakeLists.txt").read_text()]
    assert not missing


def test_the_folder_that_the_readme_adds_to_path_has_ur():
    package, folder = re.search(r'^export PATH="\$\(ros2 pkg prefix (\w+)\)/(\S+):\$PATH"', README, re.M).groups()
    layout = Layout.of_environment()
    assert program(layout, package, "ur") == layout.install / folder / "ur"


def test_every_command_of_ur_is_known():
    """Finds `./ur …` anywhere, and `ur …` at the beginning of a line or of code. test_program_name.py runs the help of each one."""
    unknown = {f"{page.relative_to(ROOT)}: ur {command}" for page, text in PAGES.items()
               for command in re.findall(r"(?:\./ur |^ur |`ur )([a-z]+)\b", text, re.M)
               if command not in (*COMMANDS, *CHECKOUT_COMMANDS)}
    assert not unknown


def words_of(text):
    """Yields the words of each command of `ur` and `./ur`, also of one after a variable, `docker compose run …` or `$(`."""
    for command in re.findall(r'(?<![\w.`/#-])((?:\./)?ur -?[a-z](?:"[^"]*"|[^"\n)])*)', re.sub(r"(^|\s)# .*", r"\1", text)):
        words = shlex.split(command, comments=True)
        yield list(itertools.takewhile(lambda word: word not in (">", "|", "||", "&", "&&"), words))


def command_lines():
    """Yields page and words of each command in a code block."""
    for page, text in PAGES.items():
        for language, block in re.findall(r"^ *```(\w*)\n(.*?)^ *```", text, re.M | re.S):
            if language in ("", "bash", "text"):
                yield from ((page.relative_to(ROOT), words) for words in words_of(block.replace("\\\n", " ")))


def commands_in_sentences():
    """Yields page and words of each command in code within a sentence, which may lack arguments."""
    for page, text in PAGES.items():
        for code in re.findall(r"`([^`]+)`", re.sub(r"```.*?```", "", text, flags=re.S)):
            if re.match(r"(?:\w+=\S+ )?(?:\./)?ur ", code):
                yield from ((page.relative_to(ROOT), words) for words in words_of(" ".join(code.split())))


class WrongArguments(Exception):
    """What a parser says, and the parser."""


def parse(command, *arguments):
    """Raises WrongArguments where the program would exit."""
    if command == VIEW:
        program_of_viewer.parse(arguments)
    elif command in COMMANDS and (command, arguments) != ("doctor", ()):
        _parse_arguments(command, arguments)
    else:
        options = main._parse([command, *arguments])
        if options.function is main.command_module:
            importlib.import_module(f"ur_tools.{command.replace('-', '_')}").parse(main._forwarded(options))


@pytest.fixture
def problem_of(monkeypatch):
    """Returns a function that says what is wrong with a command; None if nothing is. A command in a sentence may lack arguments, and have
    placeholders: FILE, …"""
    def fail(parser, message):
        raise WrongArguments(message, parser)

    monkeypatch.setattr(argparse.ArgumentParser, "error", fail)

    def problem(words, in_sentence=False):
        options = [word.partition("=")[0] for word in words if word.startswith("-")]
        if words[1] in ("--help", "--version"):
            return None
        try:
            parse(*[word for word in words[1:] if word != "--help"])
        except WrongArguments as wrong:
            message, parser = wrong.args
            is_incomplete = re.search(r"required: |expected (?:one|at least one) argument|: '?(?:[A-Z]+\b|…)", message)
            is_known = all(option in (*parser._option_string_actions, "--help") for option in options)
            return None if in_sentence and is_incomplete and is_known else message
        return None

    return problem


def test_the_arguments_of_every_command_line_of_ur_are_known(problem_of):
    lines = list(command_lines())
    wrong = {f"{page}: {shlex.join(words)}: {problem}" for page, words in lines if (problem := problem_of(words))}
    assert len(lines) > 100 and not wrong, "\n".join(wrong)


def test_the_arguments_of_every_command_of_ur_in_a_sentence_are_known(problem_of):
    lines = list(commands_in_sentences())
    wrong = {f"{page}: {shlex.join(words)}: {problem}" for page, words in lines if (problem := problem_of(words, in_sentence=True))}
    assert len(lines) > 80 and not wrong, "\n".join(wrong)


@pytest.mark.parametrize("line", [
    "ur call move_j --shwo", "ur calls move_j", "  ./ur test --chnaged", "ur state --namespace", "DOMAIN=1 ./ur demo --adress 127.0.0.2",
    "docker compose run --rm driver ur state --wrong", 'eval "$(ur completion fish)"', "ur view --wrong", "./ur bench --wrong",
    "(cd new && ./ur bench --wrong)"])
def test_a_wrong_command_line_is_found(problem_of, line):
    (words,) = words_of(line)
    assert problem_of(words)


@pytest.mark.parametrize("line, is_right", [
    ("ur doctor --robot", True), ("ur doctor --robt", False), ("ur call", True), ("ur call --shwo", False), ("ur new KIND NAME", True),
    ("ur new commands wag", False), ("./ur shell --ros kilted", True), ("./ur shell --ros kiltd", False), ("ur view --help", True)])
def test_a_command_in_a_sentence_may_lack_arguments_but_not_have_wrong_ones(problem_of, line, is_right):
    (words,) = words_of(line)
    assert (problem_of(words, in_sentence=True) is None) == is_right


def test_the_names_in_the_examples_of_ur_test_select_tests():
    found = packages.discover(ROOT)
    examples = re.findall(r"^\./ur test (\w[\w ]*?) *(?:#.*)?$", CONTRIBUTING, re.M)
    assert len(examples) >= 2
    for words in examples:
        selection.by_name(words.split(), found)  # raises an error for an unknown name


def test_contributing_lists_every_package_folder():
    folders = {package.folder.name for package in packages.discover(ROOT).values()}
    listed = re.findall(r"`(\w+)`", "".join(re.findall(r"^\| (`[^|]*) \|", CONTRIBUTING.split("\n## Packages and directories\n")[1], re.M)))
    assert folders - set(listed) == set() and [name for name in listed if not (ROOT / name).is_dir()] == []


def test_the_goal_of_each_ur_call_matches_its_action():
    """Not those of docs/use/commands, whose goals are sent by every_command, and of writing_a_plugin.md, which is executed."""
    lines = {line for page, text in PAGES.items() if page.parent.name != "commands" and page.name != "writing_a_plugin.md"
             for block in re.findall(r"```\w*\n(.*?)```", text, re.S) for line in block.splitlines() if re.match(r"(\./)?ur call", line)}
    assert len(lines) >= 6
    for _, call, *arguments in [shlex.split(line, comments=True) for line in sorted(lines)]:
        result = subprocess.run([str(program(Layout.of_environment(), "ur_ros_rtde_cli", "ur")), call, *arguments, "--show"],
                                capture_output=True, text=True, timeout=300)
        assert result.returncode == 0, (arguments, result.stderr)


def test_the_launch_arguments_are_declared():
    for document in PAGES.values():
        for launch_file, arguments in re.findall(r"ros2 launch ur_ros_rtde (\w+)\.launch\.py(.*)", document):
            assert (ROOT / "ur_ros_rtde" / "launch" / f"{launch_file}.launch.py").is_file(), launch_file
            for name, text in re.findall(r"(\w+):=(\S+)", arguments):
                if "<" not in text:
                    to_values(LAUNCH_FILES[launch_file], {name: text.strip("`,.;)")})
                check_name(name, [argument.name for argument in LAUNCH_FILES[launch_file]], f"{launch_file}.launch.py")


def test_the_controllers_and_relays_of_two_arms_have_the_names_of_their_drivers():
    page = PAGES[ROOT / "docs" / "use" / "description.md"]
    example, = (yaml.safe_load(block) for block in re.findall(r"```yaml\n(.*?)```", page, re.S) if "controller_names" in block)
    file = yaml.safe_load((ROOT / "ur_ros_rtde" / "config" / "moveit" / "moveit_controllers.yaml").read_text())
    one_arm = file["moveit_simple_controller_manager"]["follow_joint_trajectory"]
    names = {argument.name: argument.default for argument in TWO_ROBOTS}
    manager = example["moveit_simple_controller_manager"]
    assert manager == {"controller_names": [names[f"{side}_namespace"] for side in SIDES], **{
        names[f"{side}_namespace"]: {**one_arm, "action_ns": "follow_joint_trajectory",
                                     "joints": [names[f"{side}_tf_prefix"] + joint for joint in one_arm["joints"]]} for side in SIDES}}
    for side in SIDES:
        assert f"relay /{names[f'{side}_namespace']}/joint_states /joint_states" in page


def test_launch_file_and_driver_have_the_same_models():
    table = (ROOT / "ur_ros_rtde_trajectory" / "src" / "kinematics" / "arm_limits.cpp").read_text()
    assert list(MODELS) == re.findall(r'Model\{"(\w+)"', table)
    assert MODELS == simulation.MODELS


def test_the_goal_sent_by_ros2_matches_its_action():
    line = next(line for block in blocks() for line in block.splitlines() if "send_goal" in line)
    name, fields = re.search(r"ur_ros_rtde_msgs/action/(\w+) \"\{(.*)\}\"", line).groups()
    goal = (ROOT / "ur_ros_rtde_msgs" / "action" / f"{name}.action").read_text().split("---")[0]
    for field in re.findall(r"(\w+):", fields):
        assert re.search(rf"^\S+ {field}\b", goal, re.M), field
