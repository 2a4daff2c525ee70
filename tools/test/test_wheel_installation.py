"""The installation of the wheels, with a fake pip."""

import subprocess

import pytest
from ur_tools import console, venv
from ur_tools.layout import Layout

# Fails for each file that is listed in "failing". Exits when all requirement files are being installed.
PIP = """#!/bin/sh
for last; do :; done
file=$(basename "$last" .txt)
folder=$(dirname "$0")
echo "Collecting first==1.0 (from -r $last)"
touch "$folder/started-$file"
for attempt in $(seq 1000); do [ $(ls "$folder" | grep -c ^started-) = 3 ] && break; sleep 0.01; done
[ $(ls "$folder" | grep -c ^started-) = 3 ] || exit 1
echo "end of $file"
! grep -qs "$file" "$folder/failing"
"""


@pytest.fixture
def layout(tmp_path, monkeypatch):
    monkeypatch.setattr("ur_tools.layout.STATE", tmp_path / "a path with spaces")
    monkeypatch.setattr(venv, "RETRY_DELAY", 0.0)
    layout = Layout("kilted")
    layout.python.parent.mkdir(parents=True)
    layout.python.write_text(PIP)
    layout.python.chmod(0o755)
    return layout


def test_the_files_are_installed_at_the_same_time(layout, monkeypatch, capsys):
    shown = []
    monkeypatch.setattr(console.Status, "show", lambda _, text: shown.append(text))
    venv._pip_install(layout, layout.requirements)
    assert {file.name for file in layout.base.glob("pip_*.log")} == {"pip_kilted.log", "pip_libraries.log", "pip_tools.log"}
    assert capsys.readouterr().out == "" and all("packages" in text for text in shown)


def test_the_log_of_the_failed_file_is_shown(layout, capsys):
    (layout.python.parent / "failing").write_text("tools")
    with pytest.raises(console.Failure) as failure:
        venv._pip_install(layout, layout.requirements)
    text = str(failure.value)
    assert "three attempts" in text and f"{layout.base / 'pip_tools.log'}:" in text and "end of tools" in text
    assert "pip_kilted.log" not in text and capsys.readouterr().out.count("trying again") == 2


def test_the_progress_counts_the_packages_of_all_files(layout):
    with venv.Installation(layout, layout.requirements, {}) as installation:
        assert installation.wait() == []
        total = sum(venv._count(file) for file in layout.requirements)
        assert installation._progress() == f"3 of about {total} packages: first"


def test_an_interrupted_installation_leaves_no_process(layout):
    layout.python.write_text("#!/bin/sh\nexec sleep 60\n")
    with pytest.raises(KeyboardInterrupt), venv.Installation(layout, layout.requirements, {}) as installation:
        raise KeyboardInterrupt
    assert all(isinstance(process, subprocess.Popen) and process.returncode is not None for process in installation._running.values())


def test_a_package_with_a_version_for_each_python_counts_once(tmp_path):
    file = tmp_path / "tools.txt"
    file.write_text('# comment\nnumpy==1.0; python_version < "3.11"\nnumpy==2.0; python_version >= "3.11"\nclang-format==19.1.7\n')
    assert venv._count(file) == 2
