"""./ur test NAME… and ./ur test --changed: the selection of tests."""

import pathlib

import pytest
from ur_tools import console, git, main, packages, selection, testing
from ur_tools.layout import ROOT

BACKGROUND = True
STOP = "TEST_F(StopTest, KeepsItsLine)\n{\n}\nTEST_P(Angles, AreRead)\n{\n}\n"
FILES = {
    "messages/package.xml": "<package><name>messages</name></package>",
    "messages/CMakeLists.txt": "",
    "messages/action/Move.action": "",
    "driver/package.xml": "<package><name>driver</name><depend>messages</depend></package>",
    "driver/CMakeLists.txt": "",
    "driver/src/stop.cpp": "",
    "driver/test/CMakeLists.txt": "add_executable(goal_test goals.cpp)\n",
    "driver/test/test_stop.cpp": STOP,
    "driver/test/typed/documentation.py": 'FOLDER = ROOT / "docs" / "use" / "commands"\n',
    "driver/test/typed/test_cancel.py": "",
    "driver/test/nodes/test_node.py": "",
    "driver/test/nodes/support.py": "",
    "driver_cli/package.xml": "<package><name>driver_cli</name><exec_depend>driver</exec_depend></package>",
    "driver_cli/CMakeLists.txt": "",
    "driver_cli/test/test_cli.py": "",
    "tools/test/test_console.py": "from ur_tools import console\n",
    "tools/test/test_demo.py": 'import ur_tools.demo\nsys.path.insert(0, ROOT / "driver/test/nodes")\n',
    "tools/test/test_container.py": 'FILES = ROOT / "Dockerfile", ROOT / ".dockerignore", ROOT / ".devcontainer" / "devcontainer.json"\n',
    "tools/test/test_docs.py": "docs.build(folder)\n",
    "tools/test/test_readme.py": 'README = ROOT / "README.md"\nPAGES = *ROOT.glob("*.md"), *ROOT.glob("docs/*/**/*.md")\n',
    "tools/test/test_release.py": 'LICENSE = ROOT / "LICENSE"\nCHANGES = folder / "CHANGELOG.rst"\n',
    "tools/ur_tools/console.py": "",
    "tools/ur_tools/simulation.py": "from . import console\n",
    "tools/ur_tools/demo.py": 'from .simulation import start\nFIGURE = ROOT / "tools" / "ur_tools" / "demo_figure.py"\n',
    "tools/ur_tools/demo_figure.py": "",
    "tools/ur_tools/main.py": "from . import console\n",
    "tools/cmake/sanitize.cmake": "",
    "docs/use/commands/io.md": "",
    "docs/use/simulator.md": "",
    "README.md": "",
    "LICENSE": "",
    "wheels/kilted.txt": "",
    "demo/figure.py": "",
}
ALL = {"driver: robot.StopTest.KeepsItsLine": "build/driver/test_stop", "driver: Each/Angles.AreRead/0": "build/driver/test_stop",
       "driver: goals": "build/driver/goal_test"}
OF_TOOLS = ["tools: test_console", "tools: test_container", "tools: test_demo", "tools: test_docs", "tools: test_readme",
            "tools: test_release"]


@pytest.fixture
def root(tmp_path):
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


@pytest.fixture
def repository(root):
    def run(*arguments):
        result = git.run("-c", "user.name=a", "-c", "user.email=a@b", *arguments, root=root)
        assert result.returncode == 0, result.stderr

    run("init", "-q", "-b", "main")
    run("add", "-A")
    run("commit", "-qm", "first")
    return root, run


def collected(root):
    """Returns name and file of every test, as collected after a build."""
    found = {name: root / path for name, path in ALL.items()}
    for package, folder in selection.test_folders(packages.discover(root), root).items():
        found.update({f"{package}: {path.stem}": path for path in folder.rglob("test_*.py")})
    return found


def select(root, selected):
    return sorted(name for name, path in collected(root).items() if selected.chooses(name.split(":")[0], name, path))


def named(root, *words):
    return selection.by_name(list(words), packages.discover(root), root)


def affected(root, *names):
    found = selection.Affected(packages.discover(root), root)
    for name in names:
        found.add(name)
    return found.selection()


# --- By name ------------------------------------------------------------------------------------------------------------


NAMES = {
    "test_cancel": ["driver: test_cancel"],
    "CANCEL": ["driver: test_cancel"],
    "driver/test/typed/test_cancel.py": ["driver: test_cancel"],
    "driver_cli": ["driver_cli: test_cli"],
    "driver": ["driver: Each/Angles.AreRead/0", "driver: goals", "driver: robot.StopTest.KeepsItsLine", "driver: test_cancel",
               "driver: test_node"],
    "StopTest": ["driver: robot.StopTest.KeepsItsLine"],
    "robot.StopTest.Keeps": ["driver: robot.StopTest.KeepsItsLine"],
    "Each/Angles.AreRead/0": ["driver: Each/Angles.AreRead/0"],
    "test_stop": ["driver: Each/Angles.AreRead/0", "driver: robot.StopTest.KeepsItsLine"],
    "goal_test": ["driver: goals"],
    "tools": OF_TOOLS,
    "test_node StopTest": ["driver: robot.StopTest.KeepsItsLine", "driver: test_node"],
}


def test_names_select_packages_files_and_cases(root):
    assert {words: select(root, named(root, *words.split())) for words in NAMES} == NAMES


def test_only_the_packages_of_the_tests_are_built(root):
    needed = {"test_cli": ["driver_cli"], "test_cancel": ["driver"], "test_console": None}
    assert {word: named(root, word).packages for word in needed} == needed


def test_an_unknown_name_is_rejected_with_similar_ones(root):
    for word, near in (("test_cansel", "test_cancel"), ("drivr", "driver"), ("StopTestt", "StopTest"),
                       ("xyzzy", "Packages: messages, driver, driver_cli, tools")):
        with pytest.raises(console.Failure) as failure:
            named(root, "test_console", word)
        assert f'"{word}"' in str(failure.value) and near in str(failure.value)


def test_a_package_without_tests_is_named(root):
    with pytest.raises(console.Failure) as failure:
        named(root, "messages")
    assert str(failure.value) == "the package messages has no tests"


def test_the_tests_of_this_checkout_have_names():
    found = selection.sources(packages.discover(ROOT))
    assert len({case for source in found for case in source.cases}) > 200
    assert {"test_cancel", "test_selection", "fuzz.modbus"} <= {source.path.stem for source in found}
    assert not [source.path for source in found if source.path.stem.endswith("_")]


# --- By change ------------------------------------------------------------------------------------------------------------


CHANGES = {
    "driver/test/typed/test_cancel.py": ["driver: test_cancel"],
    "driver/test/test_stop.cpp": sorted(ALL),
    "driver/test/nodes/support.py": [*sorted(ALL), "driver: test_cancel", "driver: test_node", "tools: test_demo"],
    "driver/src/stop.cpp": [*sorted(ALL), "driver: test_cancel", "driver: test_node", "driver_cli: test_cli", *OF_TOOLS],
    "driver/CHANGELOG.rst": ["tools: test_release"],
    "driver_cli/CMakeLists.txt": ["driver_cli: test_cli", *OF_TOOLS],
    "docs/use/commands/io.md": ["driver: test_cancel", "tools: test_docs", "tools: test_readme"],
    "docs/use/simulator.md": ["tools: test_docs", "tools: test_readme"],
    "docs/site/conf.py": ["tools: test_docs"],
    "README.md": ["tools: test_docs", "tools: test_readme"],
    "SECURITY.md": ["tools: test_docs", "tools: test_readme"],
    "CHANGELOG.rst": ["tools: test_docs"],
    "CITATION.cff": [],
    "tools/ur_tools/demo.py": ["tools: test_demo"],
    "tools/ur_tools/demo_figure.py": ["tools: test_demo"],
    "tools/ur_tools/console.py": ["tools: test_console", "tools: test_demo"],
    "tools/test/test_console.py": ["tools: test_console"],
    "demo/figure.py": ["tools: test_demo"],
    "LICENSE": ["tools: test_release"],
    "Dockerfile": ["tools: test_container"],
    ".dockerignore": ["tools: test_container"],
    ".devcontainer/devcontainer.json": ["tools: test_container"],
    ".gitignore": [],
    "ruff.toml": [],
}


def test_a_changed_file_selects_the_tests_that_it_can_affect(root):
    assert {changed: select(root, affected(root, changed)) for changed in CHANGES} == CHANGES


def test_a_file_that_everything_depends_on_selects_all_tests(root):
    for changed in ("messages/action/Move.action", "wheels/kilted.txt", "tools/cmake/sanitize.cmake", "a_new_folder/file"):
        assert select(root, affected(root, changed)) == sorted(collected(root)), changed


def test_a_removed_test_is_not_run(root):
    (root / "tools/test/test_console.py").unlink()
    assert affected(root, "tools/test/test_console.py").packages == []


def test_changes_include_uncommitted_ones_since_the_merge_base(repository):
    root, git = repository
    git("checkout", "-qb", "work")
    (root / "driver/src/stop.cpp").write_text("// committed\n")
    git("commit", "-qam", "second")
    (root / "README.md").write_text("written")
    (root / "driver/src/new file.cpp").write_text("")
    git("checkout", "-q", "--detach", "main")
    (root / "LICENSE").write_text("on main, later")
    git("commit", "-qm", "third", "LICENSE")
    git("branch", "-f", "main")
    git("checkout", "-q", "work")
    assert selection.changed_files("main", root) == ["README.md", "driver/src/new file.cpp", "driver/src/stop.cpp"]
    assert selection.changed_files("HEAD", root) == ["README.md", "driver/src/new file.cpp"]


def test_a_renamed_file_counts_with_both_names(repository):
    root, git = repository
    git("mv", "driver_cli/test/test_cli.py", "driver_cli/test/test_call.py")
    assert selection.changed_files("HEAD", root) == ["driver_cli/test/test_call.py", "driver_cli/test/test_cli.py"]


def test_the_default_base_is_origin_main_if_it_exists(repository):
    root, git = repository
    assert selection.default_base(root) == "HEAD"
    git("update-ref", "refs/remotes/origin/main", "HEAD")
    assert selection.default_base(root) == "origin/main"


def test_an_unknown_base_is_reported(repository):
    root, _ = repository
    with pytest.raises(console.Failure, match="--base no_branch"):
        selection.by_change("no_branch", packages.discover(root), root)


def test_without_changes_no_packages_are_built_and_no_tests_run(repository, capsys):
    root, _ = repository
    found = selection.by_change("HEAD", packages.discover(root), root)
    assert found.packages == [] and select(root, found) == []
    assert capsys.readouterr().out == "0 files changed since HEAD\n"


# --- The command ----------------------------------------------------------------------------------------------------------


def test_the_options_of_the_command(monkeypatch):
    given = []
    monkeypatch.setattr(testing, "run", lambda options: given.append((options.names, options.changed, options.base)) or 0)
    for arguments in ("", "move_j StopTest --repeat 2", "--changed", "--base main"):
        assert main.main(["test", *arguments.split()]) == 0
    assert given == [([], False, ""), (["move_j", "StopTest"], False, ""), ([], True, ""), ([], True, "main")]


def test_names_and_changed_exclude_each_other(capsys):
    assert main.main(["test", "move_j", "--changed"]) == 1
    assert "names or --changed, not both" in capsys.readouterr().err


def test_a_test_has_the_path_of_its_program_or_file():
    program = testing.Test("driver: robot.StopTest.x", ["build/test_stop", "--gtest_filter=StopTest.x"], pathlib.Path(), 1.0)
    file = testing.Test("driver: test_node", ["python", "-m", "pytest", "driver/test/test_node.py"], pathlib.Path(), 1.0)
    assert program.path.stem == "test_stop" and file.path.name == "test_node.py"
