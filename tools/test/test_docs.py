"""`./ur docs` builds the site without a warning. Its search finds what users look for, and its reference has everything."""

import re

import pytest
from ur_tools import console, docs
from ur_tools.layout import ROOT

BACKGROUND = True


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    return docs.build(tmp_path_factory.mktemp("site")).parent


def text_of(page):
    return re.sub(r"<[^>]*>", "", page.read_text())


@pytest.mark.parametrize("word", ["urcap", "on_busy", "protective_stop", "lookahead_time", "safeguard"])
def test_the_search_finds(site, word):
    terms = (site / "searchindex.js").read_text()
    assert re.search(rf'"?{word[:-2]}\w*"?:', terms), f"{word} is not in the index"  # which has the stems of the words


def test_a_number_of_an_error_is_an_entry_of_the_index(site):
    """The search compares it with the whole query."""
    entries = (site / "searchindex.js").read_text()
    for line in (ROOT / "ur_ros_rtde_msgs" / "msg" / "ErrorCode.msg").read_text().splitlines():
        if number := re.match(r"uint16 \w+ = (\d+)", line):
            assert f'"error {number[1]}":' in entries, line


def test_the_reference_has_every_action(site):
    for file in ROOT.glob("*/action/*.action"):
        page = text_of(site / "reference" / f"actions_{file.parent.parent.name}.html")
        assert f"{file.stem}¶" in page, f"{file.stem} is missing"


def test_fields_have_their_defaults_and_actions_their_examples(site):
    page = (site / "reference" / "actions_ur_ros_rtde_msgs.html").read_text()
    section = page[page.index('id="movej"'):page.index('id="movejik"')]
    assert "docs/use/commands/motion.html#move-j" in section and re.search(r"speed.*float64.*0\.5.*Unit: rad/s", section, re.S)


def test_every_error_code_and_command_is_in_the_reference(site):
    codes = re.findall(r"^uint16 (\w+) =", (ROOT / "ur_ros_rtde_msgs" / "msg" / "ErrorCode.msg").read_text(), re.M)
    messages, commands = text_of(site / "reference" / "messages.html"), text_of(site / "reference" / "command_line.html")
    assert len(codes) > 20 and not [code for code in codes if code not in messages]
    assert "usage: ./ur test" in commands and "usage: ur call" in commands


def test_a_dead_link_is_an_error(site, tmp_path, capfd):
    page = docs.FOLDER / "source" / "docs" / "use" / "goals.md"
    page.write_text(page.read_text() + "\n[nowhere](nowhere.md#there)\n")
    with pytest.raises(console.Failure):
        docs.run_sphinx(docs.ensure_sphinx(), docs.FOLDER / "source", tmp_path / "html")
    assert "nowhere.md" in capfd.readouterr().err
