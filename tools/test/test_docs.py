"""`./ur docs` builds the site without a warning, and its reference has everything."""

import re

import pytest
from ur_ros_rtde_launch import launch_arguments
from ur_ros_rtde_launch.launch_arguments import PARAMETERS
from ur_tools import console, docs, docs_commands, docs_reference
from ur_tools.layout import ROOT

BACKGROUND = True


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    return docs.build(tmp_path_factory.mktemp("site")).parent


def text_of(page):
    return re.sub(r"<[^>]*>", "", page.read_text())


def test_a_number_of_an_error_is_an_entry_of_the_index(site):
    """The search compares it with the whole query."""
    entries = (site / "searchindex.js").read_text()
    for line in (ROOT / "ur_ros_rtde_msgs" / "msg" / "ErrorCode.msg").read_text().splitlines():
        if number := re.match(r"uint16 \w+ = (\d+)", line):
            assert f'"error {number[1]}":' in entries, line


def section(site, command):
    """Returns the HTML of the reference of a command."""
    found = [page.read_text().split(f'<section id="{command}">')[1:] for page in (site / "reference").glob("actions_*.html")]
    (text,) = [text for texts in found for text in texts]
    return text.split("<section ")[0]


def test_the_reference_of_a_command_has_fields_error_codes_and_examples(site):
    text = section(site, "move-j")
    assert re.search(r"speed.*float64.*0\.5.*Unit: rad/s", text, re.S)
    for link in ("docs/use/commands/motion.html#move-j", "messages.html#armstate", "error_codes.html#not-reached"):
        assert link in text, link
    for example in ("ur call move_j ", "arm.move_j(", "goal.speed = 0.5;"):
        assert example in re.sub(r"<[^>]*>", "", text), example
    assert "CUSTOM" in section(site, "jog")


def test_the_menu_has_every_page_in_the_order_of_the_readmes():
    menu = dict(docs._menu(ROOT))
    for heading, folder, pattern in docs.SECTIONS:
        assert sorted(menu[heading]) == sorted(str(page.relative_to(ROOT)) for page in (ROOT / folder).glob(pattern))
    assert menu["Use"][:2] == ["docs/use/first_day.md", "docs/use/safety.md"]
    assert menu["Commands"][:2] == ["docs/use/commands/README.md", "docs/use/commands/motion.md"]


def test_the_reference_has_every_command(site):
    text = "".join(text_of(page) for page in (site / "reference").glob("actions_*.html"))
    pages = (ROOT / "docs" / "use" / "commands").glob("*.md")
    assert [command.name for page in pages for command in docs_commands.of_page(page.read_text()) if f"{command.name}¶" not in text] == []


def test_every_error_code_and_command_is_in_the_reference(site):
    codes = re.findall(r"^uint16 (\w+) =", (ROOT / "ur_ros_rtde_msgs" / "msg" / "ErrorCode.msg").read_text(), re.M)
    messages, commands = text_of(site / "reference" / "messages.html"), text_of(site / "reference" / "command_line.html")
    assert len(codes) > 20 and not [code for code in codes if code not in messages]
    assert "usage: ./ur test" in commands and "usage: ur call" in commands


@pytest.mark.parametrize("name, has, has_not", [
    ("move_j", {"PREEMPTED", "CLIENT_LOST", "PROTECTIVE_STOP", "NOT_REACHED"}, set()),
    ("stop", {"BUSY", "LINK_LOST"}, {"PREEMPTED", "CLIENT_LOST", "NOT_REACHED"}),
    ("make_ready", {"BUSY", "PREEMPTED", "CLIENT_LOST"}, {"NOT_REACHED"}),
    ("set_digital_output", {"BUSY", "NOT_READY"}, {"PREEMPTED", "NOT_REACHED"}),
    ("dashboard/play", {"PREEMPTED", "REJECTED_BY_ROBOT"}, {"NOT_REACHED", "CLIENT_LOST"}),
])
def test_the_error_codes_of_a_command_follow_from_its_kind(name, has, has_not):
    pages = (ROOT / "docs" / "use" / "commands").glob("*.md")
    command = next(command for page in pages for command in docs_commands.of_page(page.read_text()) if command.name == name)
    codes = docs_commands.error_codes(command, "")
    assert has <= codes and not has_not & codes, codes


def rows(page, columns):
    """Yields the cells of the rows that begin with a name, in the tables of a page of docs/use with so many columns."""
    for line in (ROOT / "docs" / "use" / page).read_text().splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if line.startswith("| `") and len(cells) == columns:
            yield cells


def test_the_tables_of_topics_and_services_match_the_sources():
    served = {name: kind.replace("/msg/", "/").replace("/srv/", "/") for name, kind, _ in docs_reference.endpoints()}
    described = {}
    for names, types, last in rows("interfaces.md", 3):
        package, _, short = types.partition("/")
        topics = re.findall(r"`(\w+)`", names) if short else []
        described.update(zip(topics, [f"{package}/{name}" for name in short.split(", ")] * len(topics)))
        described.update({name: served[name] for name in re.findall(r"`(get_\w+)`", last)})
    assert len(described) > 20 and described.items() - served.items() == set()
    page = (ROOT / "docs" / "use" / "interfaces.md").read_text()
    assert [name for name in served if name not in described and name.lstrip("/") not in page] == []


def test_the_list_of_error_codes_matches_the_message():
    defined = re.findall(r"^uint16 (\w+) = (\d+)", (ROOT / "ur_ros_rtde_msgs" / "msg" / "ErrorCode.msg").read_text(), re.M)
    listed = (ROOT / "docs" / "use" / "interfaces.md").read_text().split("\n## Error codes\n")[1]
    assert re.findall(r"(\d+) ([A-Z_]+)[,.]", listed) == [(number, name) for name, number in defined]


def plain(default):
    """Returns a default in a table as launch_arguments has it: "0.1 s" is 0.1, "none" an empty list."""
    text = default.split(" ")[0].strip('`"')
    if text in ("none", "all"):
        return ()
    return float(text) if re.match(r"\d", text) else {"true": True, "false": False}.get(text, text)


def test_the_tables_of_parameters_match_the_launch_arguments():
    """Which another test compares with the parameters of the nodes."""
    described = {name.strip("`"): (second, third) for name, second, third, _ in rows("parameters.md", 4)}
    assert set(described) == {argument.name for argument in PARAMETERS}
    for argument in PARAMETERS:
        second, third = described[argument.name]
        if argument.name.startswith("stream_"):
            assert (plain(second), third) == (argument.default, "{:g} to {:g}".format(*argument.limits)), argument.name
        else:
            assert plain(third) == argument.default, argument.name


def test_the_names_in_migration_exist():
    """Those of this driver: actions and the fields of their goals, topics, services, parameters and launch files."""
    actions = {command.name: (ROOT / command.type).with_suffix(".action")
               for page in (ROOT / "docs" / "use" / "commands").glob("*.md") for command in docs_commands.of_page(page.read_text())}
    arguments = {argument.name for argument in (*PARAMETERS, *launch_arguments.OPTIONS, *launch_arguments.MOVEIT)}
    served = {name.lstrip("/") for name, _, _ in docs_reference.endpoints()}
    known = {*actions, *served, *arguments, *(path.name for path in ROOT.glob("*/launch/*.launch.py"))}
    page = (ROOT / "docs" / "use" / "migration.md").read_text().replace("\n### Plugins and extensions\n", "\n### (")
    rows = [line.strip("|").split("|") for table in page.split("\n### ") if not table.startswith("(")
            for line in table.splitlines() if line.startswith("| `")]
    names = [re.findall(r"`([\w./]+)(?::=\w+)?`", cells[1]) for cells in rows]
    assert len(rows) > 80 and {name for row in names for name in row} - known == set()
    for cells, row in zip(rows, names):
        files = [actions[name] for name in row if name in actions and actions[name].is_file()]
        fields = set(re.findall(r"^\S+ (\w+)", "".join(file.read_text().split("---")[0] for file in files), re.M))
        if re.match(r" `[A-Z]", cells[0]):
            assert set(re.findall(r"`(\w+)`", " ".join(cells[2:]))) - fields - served == set(), row


def test_a_dead_link_is_an_error(site, tmp_path, capfd):
    page = docs.FOLDER / "source" / "docs" / "internals" / "goals.md"
    page.write_text(page.read_text() + "\n[nowhere](nowhere.md#there)\n")
    with pytest.raises(console.Failure):
        docs.run_sphinx(docs.ensure_sphinx(), docs.FOLDER / "source", tmp_path / "html")
    assert "nowhere.md" in capfd.readouterr().err
