"""The installation of the system packages, with another apt-get."""

import pytest
from ur_tools import console, system_packages

BACKGROUND = True


@pytest.fixture
def apt(tmp_path, monkeypatch):
    """Returns a function that says what `apt-get install` does."""
    monkeypatch.setattr(system_packages, "absent", lambda: ["g++"])
    monkeypatch.setattr(system_packages, "_prefix", list)

    def install(script):
        program = tmp_path / "apt-get"
        program.write_text(f'#!/bin/sh\n[ "$1" = update ] || {{ {script}; }}\n')
        program.chmod(0o755)

    for name in ("dpkg-query", "apt-get"):
        (tmp_path / name).write_text("")
        (tmp_path / name).chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    return install


def test_the_progress_is_shown(apt, monkeypatch):
    shown = []
    monkeypatch.setattr(console.Status, "show", lambda _, text: shown.append(text))
    apt("echo Get:1 g++; echo Unpacking g++")
    system_packages.ensure()
    assert shown == ["Get:1 g++", "Unpacking g++"]


def test_a_failure_is_explained_with_the_last_lines(apt):
    apt("echo Get:1 g++; echo no network; exit 100")
    with pytest.raises(console.Failure, match=r"`apt-get install .* g\+\+` failed:\nGet:1 g\+\+\nno network\nCheck the network"):
        system_packages.ensure()
