import shutil

import pytest
import yaml
from ur_tools import git, lint, system_packages
from ur_tools.layout import ROOT, Layout

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


def test_continuous_integration_runs_all_tests_thoroughly():
    workflow = yaml.safe_load((ROOT / ".github" / "workflows" / "ci.yml").read_text())
    commands = [step["run"].splitlines()[-1] for job in workflow["jobs"].values() for step in job["steps"] if step.get("name") == "Test"]
    assert commands == [".ci/run --ros installed", ".ci/run --ros ${{ matrix.ros }}"]
    assert './ur test --thorough "$@"' in (ROOT / ".ci" / "run").read_text()


@pytest.fixture
def layout(tmp_path, monkeypatch):
    monkeypatch.setattr("ur_tools.layout.STATE", tmp_path)
    layout = Layout("kilted")
    (layout.venv / "bin").mkdir(parents=True)
    return layout


def install_program(layout, name, text, status):
    """Installs a program that writes its arguments to a file, prints a text and exits with this status."""
    file = layout.venv / "bin" / name
    file.write_text(f"#!/bin/sh\necho \"$@\" >> '{file}.arguments'\ncat << 'END'\n{text}\nEND\nexit {status}\n")
    file.chmod(0o755)
    return file.with_name(f"{name}.arguments")


def test_the_findings_in_python_are_shown_and_the_cache_is_not_in_the_sources(layout):
    for name, check in (("ruff", lint.check_ruff), ("mypy", lint.check_mypy)):
        install_program(layout, name, "a.py:1:2: first\nb.py:3: second", 1)
        result = check(layout)
        assert (result.name, result.ok) == (f"sources: {name}", False)
        assert result.text.splitlines()[:2] == ["    a.py:1:2: first", "    b.py:3: second"]
        arguments = install_program(layout, name, "no issues", 0)
        assert check(layout).ok
        assert f"--cache-dir {layout.base / f'{name}_cache'}" in arguments.read_text()


def test_a_test_that_imports_a_name_that_does_not_exist_is_found(layout, tmp_path, monkeypatch):
    (layout.venv / "bin" / "mypy").symlink_to(shutil.which("mypy"))
    monkeypatch.setattr(lint, "ROOT", tmp_path)
    for configuration in ("mypy.ini", "mypy_tests.ini"):
        shutil.copy(ROOT / configuration, tmp_path)
    (tmp_path / "tools").mkdir()
    (tmp_path / "tools" / "library.py").write_text("LIMIT = 1\n")
    (tmp_path / "arm" / "test").mkdir(parents=True)
    (tmp_path / "arm" / "test" / "test_arm.py").write_text("from library import LIMITS\n\nprint(LIMITS)\n")
    git.run("init", "-q", root=tmp_path)
    result = lint.check_mypy(layout)
    assert not result.ok and 'test_arm.py:1: error: Module "library" has no attribute "LIMITS"' in result.text
    assert result.text.count("error:") == 1


@pytest.mark.parametrize("output, status, ok", [("", 0, True), ("a.cpp:1:2: warning: unused", 0, False), ("", 139, False)])
def test_clang_tidy_passes_only_without_a_finding_and_without_a_crash(layout, output, status, ok):
    install_program(layout, "clang-tidy", output, status)
    source = ROOT / "rcl_cxx" / "src" / "a.cpp"
    assert lint._check_tidy(str(layout.venv / "bin" / "clang-tidy"), layout.base / "compile_commands.json", source).ok is ok


def test_the_sources_are_checked_by_each_program(layout, capsys):
    for name in ("clang-format", "ruff", "mypy", "hadolint"):
        install_program(layout, name, "finding", 1)
    failed = [check.name for check in lint.checks(layout) if not check.ok]
    assert capsys.readouterr().out == "==> Checking the sources\n"
    assert failed == ["sources: formatting", "sources: ruff", "sources: mypy", "sources: hadolint"]
