"""The pinned Python packages: what `./ur lock` writes, and what happens if a file has another hash. No test uses a network."""

import base64
import hashlib
import sys
import zipfile

import pytest
from ur_tools import bench_trajectory, browser, console, docs, pin_hashes, pins, venv
from ur_tools.layout import WHEELS, Layout

BACKGROUND = True
FILES = sorted(pins.FOLDER.glob("*.txt"))
WRONG = "0" * 64


def make_wheel(folder, name, version, requires_python=">=3.8"):
    """Writes a wheel with an empty module. Returns its SHA-256."""
    info = f"{name}-{version}.dist-info"
    contents = {f"{name}.py": "", f"{info}/WHEEL": "Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
                f"{info}/METADATA": f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\nRequires-Python: {requires_python}\n"}
    record = "".join(f"{path},sha256={base64.urlsafe_b64encode(hashlib.sha256(text.encode()).digest()).decode().rstrip('=')},{len(text)}\n"
                     for path, text in contents.items())
    file = folder / f"{name}-{version}-py3-none-any.whl"
    with zipfile.ZipFile(file, "w") as archive:
        for path, text in {**contents, f"{info}/RECORD": f"{record}{info}/RECORD,,\n"}.items():
            archive.writestr(path, text)
    return hashlib.sha256(file.read_bytes()).hexdigest()


@pytest.fixture
def registry(tmp_path, monkeypatch):
    """A folder with wheels, from which pip installs."""
    folder = tmp_path / "registry"
    folder.mkdir()
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    monkeypatch.setenv("PIP_FIND_LINKS", str(folder))
    monkeypatch.setenv("PIP_TARGET", str(tmp_path / "installed"))
    return folder


@pytest.fixture
def file(tmp_path, monkeypatch):
    monkeypatch.setattr(pins, "FOLDER", tmp_path)
    return tmp_path / "kilted.txt"


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_pinned_package_has_hashes(path):
    missing = [pin.requirement for pin in pins.read(path) if not pin.hashes]
    assert not missing, f"run `./ur lock {path.stem}`"


def test_every_file_that_is_installed_is_locked():
    installed = {file for ros in (*WHEELS, "installed") for file in Layout(ros).requirements + Layout(ros).viewer_requirements}
    assert {*installed, browser.REQUIREMENTS, docs.REQUIREMENTS, bench_trajectory.REQUIREMENTS} <= set(FILES)


def test_a_file_that_is_read_and_written_stays_the_same(tmp_path):
    for path in FILES:
        copy = tmp_path / path.name
        copy.write_text(path.read_text())
        pins.write(copy, pins.read(copy))
        assert copy.read_text() == path.read_text()


@pytest.mark.parametrize("line", ["numpy", "numpy>=2", 'numpy==2.2.6; sys_platform == "linux"', "--hash=sha256:12"])
def test_a_line_that_pins_nothing_is_named(file, line):
    file.write_text(f"# comment\nsix==1.17.0\n{line}\n")
    with pytest.raises(console.Failure) as failure:
        pins.read(file)
    assert f"kilted.txt:3: `{line}`" in str(failure.value)


def test_a_package_with_its_hash_is_installed(registry, file, tmp_path):
    file.write_text(pins.Pin("first", "1.0", hashes=(make_wheel(registry, "first", "1.0"),)).text)
    pins.install(sys.executable, file)
    assert (tmp_path / "installed" / "first.py").is_file()


@pytest.mark.parametrize("expected", [(WRONG,), (WRONG, "1" * 64)])
def test_a_package_with_another_hash_is_not_installed_and_named(registry, file, tmp_path, expected):
    received = make_wheel(registry, "first", "1.0")
    file.write_text(pins.Pin("first", "1.0", hashes=expected).text)
    with pytest.raises(pins.Mismatch) as failure:
        pins.install(sys.executable, file)
    text = str(failure.value)
    assert text.startswith("first==1.0 was not installed") and received in text and "./ur lock kilted" in text
    assert ("one of the 2" in text) == (len(expected) == 2)
    assert not (tmp_path / "installed" / "first.py").exists()


def test_a_set_up_does_not_try_again_after_a_mismatch(registry, file, tmp_path, monkeypatch, capsys):
    make_wheel(registry, "first", "1.0")
    file.write_text(pins.Pin("first", "1.0", hashes=(WRONG,)).text)
    monkeypatch.setattr("ur_tools.layout.STATE", tmp_path / "state")
    layout = Layout("kilted")
    layout.python.parent.mkdir(parents=True)
    layout.python.symlink_to(sys.executable)
    with pytest.raises(pins.Mismatch, match=r"first==1\.0 was not installed"):
        venv._pip_install(layout, [file])
    assert "trying again" not in capsys.readouterr().out


def test_lock_writes_the_hashes_and_keeps_comments_and_markers(registry, file, tmp_path):
    old, new = make_wheel(registry, "first", "1.0"), make_wheel(registry, "first", "2.0", ">=3.11")
    file.write_text(f'# A comment.\nFirst==1.0; python_version < "3.11" \\\n    --hash=sha256:{WRONG}\n'
                    'First==2.0; python_version >= "3.11"\n')
    assert pin_hashes.lock("kilted", sys.executable, tmp_path) == 2
    assert file.read_text() == (f'# A comment.\nFirst==1.0; python_version < "3.11" \\\n    --hash=sha256:{old}\n'
                                f'First==2.0; python_version >= "3.11" \\\n    --hash=sha256:{new}\n')
    assert pin_hashes.lock("kilted", sys.executable, tmp_path) == 0


def test_lock_rejects_a_version_that_a_supported_python_cannot_install(registry, file, tmp_path):
    make_wheel(registry, "first", "2.0", ">=3.11.5")
    file.write_text("first==2.0\n")
    with pytest.raises(console.Failure, match=r'first 2\.0 needs Python >=3\.11\.5.*python_version < "3\.11"'):
        pin_hashes.lock("kilted", sys.executable, tmp_path)


def test_lock_names_a_package_that_does_not_exist(registry, file, tmp_path):
    file.write_text("missing==1.0\n")
    with pytest.raises(console.Failure, match=r"pip found no files for kilted with Python 3\.10 on x86_64:(.|\n)*missing==1\.0"):
        pin_hashes.lock("kilted", sys.executable, tmp_path)
    assert file.read_text() == "missing==1.0\n"


def test_the_newest_and_the_oldest_python_and_both_processors_are_covered():
    for name in ("tools", "docs"):
        assert {"Python 3.10 on aarch64", "Python 3.14 on x86_64"} <= {str(machine) for machine in pin_hashes.machines(name)}
    assert {str(machine) for machine in pin_hashes.machines("kilted")} == {f"Python 3.{minor} on x86_64" for minor in (10, 11, 12)}
