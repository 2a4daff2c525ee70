"""git in the checkout of another user, in a hook, and without git."""

import subprocess

import pytest
from ur_tools import git, lint, main

SOURCES = ["README.md", "src/log/main.cpp"]
GENERATED = [".ur/jazzy/build/main.o", "build/main.o", "log/events.log", "src/__pycache__/main.pyc"]


@pytest.fixture
def checkout(tmp_path):
    for name in (*SOURCES, *GENERATED):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("")
    return tmp_path


@pytest.fixture
def repository(checkout):
    (checkout / ".gitignore").write_text("/.ur/\n/build/\n/log/\n__pycache__/\n")
    assert git.run("init", "-q", root=checkout).returncode == 0
    return checkout


def names(root):
    return [str(path.relative_to(root)) for path in git.files(root)]


def test_the_files_of_a_repository_are_those_that_it_does_not_ignore(repository):
    assert names(repository) == [".gitignore", *SOURCES]


def test_the_repository_of_another_user_has_the_same_files(repository, monkeypatch):
    monkeypatch.setenv("GIT_TEST_ASSUME_DIFFERENT_OWNER", "1")
    assert "dubious ownership" in subprocess.run(["git", "status"], cwd=repository, capture_output=True, text=True).stderr
    assert git.run("ls-files", root=repository).returncode == 0
    assert names(repository) == [".gitignore", *SOURCES]


def test_an_archive_without_a_repository_has_the_same_files(checkout, monkeypatch):
    assert names(checkout) == SOURCES
    monkeypatch.setenv("PATH", "")
    assert git.run("status", root=checkout).stderr == "git is not installed"
    assert names(checkout) == SOURCES


def test_in_a_hook_another_repository_stays_as_it_is(repository, tmp_path_factory, monkeypatch):
    other = tmp_path_factory.mktemp("other")
    assert git.run("init", "-q", root=other).returncode == 0
    monkeypatch.setenv("GIT_DIR", str(other / ".git"))
    monkeypatch.setenv("GIT_INDEX_FILE", str(other / ".git" / "index"))
    git.run("add", "README.md", root=repository)
    assert (repository / ".git" / "index").exists() and not (other / ".git" / "index").exists()


def test_a_program_that_fails_is_reported_without_a_traceback(monkeypatch, capsys):
    def fail(*_unused):
        subprocess.run(["false"], check=True)

    monkeypatch.setattr(lint, "run", fail)
    monkeypatch.setattr(main, "_prepared", lambda options: None)
    assert main.main(["lint"]) == 1
    assert capsys.readouterr().err == "\nfalse failed with status 1\n"
