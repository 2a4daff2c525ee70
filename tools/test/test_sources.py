from ur_tools import lint, system_packages

BACKGROUND = True


def test_machine_specific_paths_are_found_and_others_ignored():
    specific = ["see /" + "work/main", "cd /" + "root/x", "/" + "home/anna/ws"]
    others = ["/usr/bin/env", "the /tmp folder", "ROOT/tools", "frame/work/piece"]
    assert [text for text in (*specific, *others) if lint._MACHINE_SPECIFIC.search(text)] == specific


def test_the_list_of_system_packages_has_one_name_per_line(tmp_path):
    file = tmp_path / "list.txt"
    file.write_text("# comment\ng++\n\nlibfmt-dev  # formatting\n")
    assert system_packages.needed(file) == ["g++", "libfmt-dev"]


def test_a_package_that_is_not_installed_is_reported_as_missing():
    assert system_packages.missing(["no-such-package-anywhere"]) == ["no-such-package-anywhere"]
