"""./ur fuzz: its targets, their corpora and the command line of libFuzzer."""

import os
import subprocess

import pytest
from ur_tools import console, fuzz, layout


def test_every_target_has_a_corpus_and_is_built_and_replayed():
    built = "".join(path.read_text() for path in (fuzz.PROJECT / "CMakeLists.txt", fuzz.PROJECT / "driver.cmake"))
    assert {"urscript", "rtde_stream", "plugin_description"} <= set(fuzz.targets())
    for name, folder in fuzz.folders().items():
        package = folder.parent
        assert f"add_fuzz_target({package.name} {name} " in built
        assert f"add_fuzz_replay({name} " in (package / "test" / "CMakeLists.txt").read_text()
        assert any((folder / "corpus" / name).iterdir()), name


def test_every_corpus_has_a_target():
    corpora = {path.name for path in layout.ROOT.glob("*/fuzz/corpus/*")}
    assert corpora == set(fuzz.targets())


def test_an_unknown_target_is_rejected_with_the_known_ones():
    with pytest.raises(console.Failure, match="no fuzz target nonsense; the targets are .*urscript"):
        fuzz.selected(["urscript", "nonsense"])
    assert fuzz.selected([]) == fuzz.targets()


def test_new_inputs_are_kept_apart_from_the_seeds(tmp_path, monkeypatch):
    monkeypatch.setattr(layout, "STATE", tmp_path)
    for fast, build in ((False, "fuzz"), (True, "fuzz-fast")):
        command = fuzz.command(layout.Layout("kilted"), "urscript", fast, "-runs=1000")
        assert command[:2] == [str(tmp_path / "kilted" / build / "fuzz_urscript"), "-runs=1000"]
        # libFuzzer writes to the first corpus only. The builds share it.
        found = tmp_path / "kilted" / "fuzz" / "corpus" / "urscript"
        assert command[-2:] == [str(found), str(layout.ROOT / "ur_simulator" / "fuzz" / "corpus" / "urscript")]
        assert found.is_dir()


@pytest.mark.parametrize("thorough, mutations", [({}, 100), ({"UR_TEST_THOROUGH": "1"}, 600)])
def test_a_replay_is_longer_in_a_thorough_run(tmp_path, thorough, mutations):
    program = layout.Layout.of_environment().build / "ur_simulator" / "test" / "replay_modbus"
    env = {name: value for name, value in os.environ.items() if name != "UR_TEST_THOROUGH"}
    done = subprocess.run([str(program), str(layout.ROOT / "ur_simulator" / "fuzz" / "corpus" / "modbus"), "600"],
                          env={**env, **thorough}, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and f", {mutations} mutations" in done.stdout, done.stdout + done.stderr
