import pytest
from ur_tools import lint, system_packages


@pytest.mark.parametrize("text", ["see /" + "work/main", "cd /" + "root/x", "/" + "home/anna/ws"])
def test_a_path_of_one_machine_is_found(text):
    assert lint._TRACES.search(text)


@pytest.mark.parametrize("text", ["/usr/bin/env", "the /tmp folder", "ROOT/tools", "frame/work/piece"])
def test_other_paths_are_not(text):
    assert not lint._TRACES.search(text)


def test_the_list_of_system_packages_has_one_name_a_line(tmp_path):
    file = tmp_path / "list.txt"
    file.write_text("# comment\ng++\n\nlibfmt-dev  # formatting\n")
    assert system_packages.needed(file) == ["g++", "libfmt-dev"]


def test_a_package_that_is_not_installed_is_missing():
    assert system_packages.missing(["no-such-package-anywhere"]) == ["no-such-package-anywhere"]
