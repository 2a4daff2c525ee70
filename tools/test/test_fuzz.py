"""./ur fuzz: its targets, their corpora and the command line of libFuzzer."""

import pytest
from ur_tools import console, fuzz


def test_every_target_has_a_corpus_and_is_built():
    listed = (fuzz.FUZZ / "CMakeLists.txt").read_text()
    assert "urscript" in fuzz.targets()
    for name in fuzz.targets():
        assert f"add_fuzz_target({name} " in listed
        assert any((fuzz.FUZZ / "corpus" / name).iterdir()), name


def test_an_unknown_target_is_refused_with_the_known_ones():
    with pytest.raises(console.Failure, match="no fuzz target nonsense; the targets are .*urscript"):
        fuzz.selected(["urscript", "nonsense"])
    assert fuzz.selected([]) == fuzz.targets()


def test_new_inputs_are_kept_apart_from_the_seeds(tmp_path):
    command = fuzz.command(tmp_path, "urscript", 5)
    assert "-max_total_time=5" in command
    # libFuzzer writes to the first corpus only.
    assert command[-2:] == [str(tmp_path / "corpus" / "urscript"), str(fuzz.FUZZ / "corpus" / "urscript")]
    assert (tmp_path / "corpus" / "urscript").is_dir()
