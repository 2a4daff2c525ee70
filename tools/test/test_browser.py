"""The browser of the browser tests: what is used, and what is reported where there is none."""

import pytest
from ur_tools import browser, console, testing
from ur_tools.layout import Layout

BACKGROUND = True


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path / "bin"))
    monkeypatch.setattr(browser, "_install_playwright", lambda _layout: None)
    return tmp_path / "browser"


def add_program(file):
    file.parent.mkdir(parents=True)
    file.write_text("#!/bin/sh\n")
    file.chmod(0o755)


def test_a_browser_on_path_is_used(folder, tmp_path):
    add_program(tmp_path / "bin" / "chromium")
    assert browser.environment(Layout.of_environment(), folder) == {browser.VARIABLE: str(tmp_path / "bin" / "chromium")}


def test_an_unpacked_browser_is_used_with_its_libraries(folder):
    add_program(folder / browser.PROGRAM)
    for library in ("usr/lib/a/liba.so.1", "usr/lib/b/libb.so"):
        (folder / library).parent.mkdir(parents=True)
        (folder / library).touch()
    found = browser.environment(Layout.of_environment(), folder)
    assert found == {browser.VARIABLE: str(folder / browser.PROGRAM), browser.LIBRARIES: f"{folder}/usr/lib/a:{folder}/usr/lib/b"}


def test_without_debians_tools_reason_and_remedy_are_reported(folder, capsys):
    found = browser.environment(Layout.of_environment(), folder)
    assert "no apt-get" in found[browser.MISSING] and "Install chromium" in found[browser.MISSING]
    assert "the browser tests are skipped: this machine has no apt-get" in capsys.readouterr().out
    assert not folder.exists()


def test_package_lists_are_downloaded_once_where_the_machine_has_none(tmp_path, monkeypatch):
    calls = []

    def update(command):
        calls.append(command)
        (tmp_path / "apt" / "lists" / "main_Packages.lz4").touch()

    monkeypatch.setattr(browser, "SYSTEM_LISTS", tmp_path)
    monkeypatch.setattr(browser, "LISTS", tmp_path / "apt")
    monkeypatch.setattr(browser, "_run", update)
    assert browser._apt_options() == browser._apt_options() and f"Dir::State::lists={tmp_path / 'apt' / 'lists'}" in calls[0]
    assert len(calls) == 1
    (tmp_path / "main_Packages.lz4").touch()
    assert browser._apt_options() == []


def test_a_program_that_takes_too_long_is_reported(monkeypatch):
    monkeypatch.setattr(browser, "TIMEOUT", 0.1)
    with pytest.raises(console.Failure, match="took longer than 0.1 s"):
        browser._run(["sleep", "60"])


def test_a_file_may_need_a_browser(tmp_path):
    (tmp_path / "test_a.py").write_text("BROWSER = True\n")
    (tmp_path / "test_b.py").write_text("")
    assert [test.browser for test in testing._pytest(Layout.of_environment(), "viewer", tmp_path)] == [True, False]
