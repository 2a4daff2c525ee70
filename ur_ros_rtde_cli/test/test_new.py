"""ur new. docs/use/writing_a_plugin.md, whose test builds the packages, explains it."""

import pathlib
import re

import pytest
from ur_ros_rtde_cli.main import main
from ur_ros_rtde_cli.new import KINDS


@pytest.fixture
def new(capsys):
    """Runs `ur new` with these arguments. Returns the exit code and the output."""

    def run(*arguments):
        code = main(["new", *map(str, arguments)])
        printed = capsys.readouterr()
        return code, printed.out + printed.err

    return run


def test_the_description_is_in_one_file(tmp_path, new):
    for kind in KINDS:
        _, printed = new(kind, "wag", "--directory", tmp_path)
        shown, = re.findall(r"^    (\S+)  .*`ur plugins` shows", printed, re.M)
        text = (tmp_path / shown).read_text()
        description = re.search(r"^# (.*?)\.|<description>(.*?)\.?</description>", text)
        words = description.group(1) or description.group(2)
        files = [file for file in (tmp_path / f"wag_{kind}").rglob("*") if file.is_file()]
        assert [file for file in files if words in file.read_text()] == [tmp_path / shown]


def test_a_given_description_requires_no_edit(tmp_path, new):
    for kind, to_change in (("command", {".action", ".cpp"}), ("dashboard", {".cpp"}), ("extension", {".action", ".cpp"})):
        _, printed = new(kind, "wag", "--directory", tmp_path, "--description", "Wags & more.")
        assert {pathlib.Path(name).suffix for name in re.findall(r"^    (\S+)  +\S", printed, re.M)} == to_change, printed
        assert "`ur plugins` shows" not in printed
        files = [file for file in (tmp_path / f"wag_{kind}").rglob("*") if file.suffix in (".xml", ".action")]
        written = "<description>Wags &amp; more.</description>" if kind == "dashboard" else "# Wags & more."
        assert any(written in file.read_text() for file in files), kind


def test_an_invalid_name_is_rejected_with_the_reason(tmp_path, new):
    for name, reason in (("Bad", "lower case"), ("a__b", "single underscores"), ("part_2", "part2")):
        code, printed = new("command", name, "--directory", tmp_path)
        assert code == 2 and reason in printed and not list(tmp_path.iterdir()), printed


@pytest.mark.parametrize("name, reason", [("return", "Python has no method"), ("close", "Robot.close of ur_ros_rtde is something else")])
def test_a_name_that_cannot_be_a_method_is_rejected(tmp_path, new, name, reason):
    code, printed = new("command", name, "--directory", tmp_path)
    assert code == 2 and reason in printed and not list(tmp_path.iterdir()), printed


def test_a_dashboard_command_may_be_called_close(tmp_path, new):
    assert new("dashboard", "close", "--directory", tmp_path)[0] == 0


def test_an_existing_package_is_not_overwritten(tmp_path, new):
    assert new("command", "wag", "--directory", tmp_path)[0] == 0
    code, printed = new("command", "wag", "--directory", tmp_path)
    assert code == 2 and "exists already" in printed


def test_a_folder_that_cannot_be_written_is_reported(new):
    code, printed = new("command", "wag", "--directory", "/proc")
    assert code == 1 and "/proc/wag_command cannot be written" in printed and "--directory" in printed
