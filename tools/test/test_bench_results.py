"""./ur bench: files of results, their comparison, and the report."""

import json
import pathlib

import pytest
from ur_tools import bench, bench_compare, bench_machine, bench_report, bench_results, bench_rows, console
from ur_tools.bench_compare import BETTER, NOT_JUDGED, ONLY_NEW, ONLY_OLD, SAME, WORSE, judge
from ur_tools.bench_results import Results
from ur_tools.layout import ROOT, Layout

BACKGROUND = True

MACHINE = {"cpu": "one", "cores": 2, "kernel": "6.1", "governor": "performance", "compiler": "GNU 12", "ros": "kilted",
           "build": "release"}
LATENCY = "package to C++ subscriber"


def results(values, begin=0.0, machine=None, settings=None, load=0.0, steal=0.0):
    """Returns runs with these medians of the latency, which began at `begin`, `begin` + 2 and so on."""
    runs = [{"begin": begin + 2.0 * number, "load": {"other processes": load, "steal": steal}, "figures": {LATENCY: {"p50": value}},
             "samples": {LATENCY: [[0.002 * index, value] for index in range(300)]}} for number, value in enumerate(values)]
    return Results({**MACHINE, **(machine or {})}, "0123456789ab", settings or {"repeat": 40}, runs)


def verdicts(old, new):
    return {line.row.title: line.verdict for line in bench_compare.compare(old, new)}


# --- Comparison -------------------------------------------------------------------------------------------------------


CHANGES = [
    ([0.20, 0.21, 0.21, 0.21, 0.22], [0.30, 0.31, 0.31, 0.31, 0.32], WORSE),
    ([0.30, 0.31, 0.31, 0.31, 0.32], [0.20, 0.21, 0.21, 0.21, 0.22], BETTER),
    ([0.20, 0.21, 0.21, 0.21, 0.22], [0.20, 0.21, 0.21, 0.21, 0.22], SAME),
    ([0.20, 0.21, 0.21, 0.21, 5.00], [0.20, 0.21, 0.21, 0.21, 0.22], SAME),  # one outlier
    ([0.20, 0.21, 0.21, 0.21, 0.40], [0.30, 0.31, 0.31, 0.31, 0.32], SAME),  # the ranges overlap
    ([0.20, 0.25, 0.25, 0.25, 0.30], [0.31, 0.32, 0.32, 0.32, 0.33], SAME),  # apart, but by less than the first result varies
    ([75.0] * 5, [75.5] * 5, SAME),  # 0.7 %
    ([0.0] * 5, [0.0] * 5, SAME),
    ([0.0] * 5, [0.5, 0.6, 0.6, 0.6, 0.6], WORSE),
    ([0.2] * 4, [0.9] * 5, NOT_JUDGED),
    ([0.2], [0.9], NOT_JUDGED),
    ([], [0.9] * 5, ONLY_NEW),
    ([0.9] * 5, [], ONLY_OLD),
]


def test_a_change_is_judged_by_the_spread_of_both_results():
    assert [(old, new, judge(old, new)) for old, new, _ in CHANGES] == CHANGES


def test_rows_of_only_one_result_are_shown_and_others_omitted():
    old, new = results([0.2] * 5), results([0.2] * 5)
    for run in new.runs:
        run["figures"] = {"start to ready": 0.8}
    assert verdicts(old, new) == {f"{LATENCY} p50": ONLY_OLD, "start to ready": ONLY_NEW}


def test_a_row_that_failed_in_one_run_is_compared_by_the_others():
    old, new = results([0.2] * 6), results([0.9] * 6)
    new.runs[0]["figures"][LATENCY] = None
    assert verdicts(old, new) == {f"{LATENCY} p50": WORSE}


def test_nothing_is_judged_across_machines():
    for key, value in (("cpu", "another"), ("cores", 8), ("kernel", "6.8-rt"), ("compiler", "Clang 19")):
        old, new = results([0.2] * 5), results([0.9] * 5, machine={key: value})
        assert verdicts(old, new) == {f"{LATENCY} p50": NOT_JUDGED}, key
        assert any(f"{key}: {MACHINE[key]}, now {value}" in note for note in bench_compare.notes(old, new)), key


def test_nothing_is_judged_across_settings():
    assert verdicts(results([0.2] * 5), results([0.9] * 5, settings={"repeat": 5})) == {f"{LATENCY} p50": NOT_JUDGED}


def test_runs_that_alternate_on_a_quiet_machine_have_no_notes():
    assert bench_compare.notes(results([0.2] * 5, begin=0.0), results([0.9] * 5, begin=1.0)) == []


def test_what_limits_the_comparison_is_noted():
    old = results([0.2] * 5, begin=0.0)
    for new, text in ((results([0.2] * 5, begin=100.0), "do not alternate"),
                      (results([0.2], begin=1.0), "Runs: 5 before, 1 now"),
                      (results([0.2] * 5, begin=1.0, load=1.5), "1.5 cores during the runs now"),
                      (results([0.2] * 5, begin=1.0, steal=3.0), "3.0 % of the processor time during the runs now"),
                      (results([0.2] * 5, begin=6.5), "do not alternate"),  # two changes
                      (results([0.2] * 5, begin=1.0, settings={"repeat": 5}), "repeat 40, now 5")):
        assert any(text in note for note in bench_compare.notes(old, new)), text


def test_the_table_marks_what_changed(capsys):
    bench_compare.show(results([0.2, 0.2, 0.21, 0.22, 0.22]), results([0.4, 0.4, 0.41, 0.42, 0.42], begin=1.0))
    line = next(line for line in capsys.readouterr().out.splitlines() if line.startswith(LATENCY))
    assert "0.210 (0.200 to 0.220)" in line and "0.410 (0.400 to 0.420)" in line and "1.95" in line and line.endswith("WORSE")


# --- Files ------------------------------------------------------------------------------------------------------------


def test_a_file_has_what_was_written(tmp_path):
    written = results([0.2, 0.3])
    bench_results.save(tmp_path / "a.json", written)
    assert bench_results.load(tmp_path / "a.json", "--compare") == written


def content(**changes):
    made = {"format": bench_results.FORMAT, "machine": {}, "commit": "", "settings": {}, "runs": [{"figures": {}}], **changes}
    return json.dumps({key: value for key, value in made.items() if value is not None}).encode()


UNUSABLE = [
    (b"", "not a JSON file"),
    (b"0.1 0.2\n", "not a JSON file"),
    (b"\xff\xfe\x00\x80", "not a JSON file"),
    (b"[1, 2]", "not written by ./ur bench"),
    (b'{"benchmarks": []}', "not written by ./ur bench"),
    (content(format="ur bench 99"), "format \"ur bench 99\""),
    (content(machine=None), "its field machine is missing"),
    (content(runs={}), "its field runs"),
    (content(runs=[{"begin": 1}]), "its field runs"),
    (content(runs=[]), "has no runs"),
]


def test_unusable_files_are_rejected(tmp_path):
    file = tmp_path / "old.json"
    for text, message in UNUSABLE:
        file.write_bytes(text)
        with pytest.raises(console.Failure) as failure:
            bench_results.load(file, "--compare")
        assert f"--compare {file}: " in str(failure.value) and message in str(failure.value), text


WRONG_OPTIONS = [
    (["--compare", "/no/such.json"], 1, "--compare /no/such.json: No such file or directory"),
    (["--input", "/no/such.json"], 1, "--input /no/such.json: No such file or directory"),
    (["--output", "/no/such/folder/a.json"], 1, "--output /no/such/folder/a.json: there is no such folder"),
    (["--output", str(ROOT)], 1, "it is a folder"),
    (["--report", "/no/such/folder/a.html"], 1, "--report /no/such/folder/a.html: there is no such folder"),
    (["--report", __file__], 1, "give a folder or a file that ends in .html"),
    (["--append"], 2, "--append needs --output"),
    (["--runs", "0"], 2, "--runs must be at least 1"),
    (["--input", "a.json", "--stress"], 2, "--input measures nothing"),
    (["--scale", "--stream"], 2, "--stream and --scale exclude each other"),
    (["--trajectory", "--output", "a.json"], 2, "--trajectory has no rows"),
    (["--robots", "3"], 2, "give some of 1, 4, 8"),
]


def test_wrong_options_are_reported_before_anything_runs(run_without_build):
    for arguments, expected, message in WRONG_OPTIONS:
        code, text = run_without_build("bench", *arguments)
        assert code == expected and message in " ".join(text.split()), (arguments, text)


def test_runs_of_another_version_are_not_appended():
    old = results([0.2])
    for what, changed in (("commit", {"commit": "ffffffffffff"}), ("cores", {"machine": {**MACHINE, "cores": 64}}),
                          ("repeat", {"settings": {"repeat": 1}})):
        new = Results(**{**vars(old), **changed})
        with pytest.raises(console.Failure, match=f"--append a.json: its runs have {what}"):
            bench_results.check_same(old, new, pathlib.Path("a.json"))


# --- Measuring --------------------------------------------------------------------------------------------------------


def measured(monkeypatch, *arguments):
    """Runs `./ur bench` without programs: the n-th run measures n."""
    count = iter(range(1, 100))
    monkeypatch.setattr(bench.ports, "check", lambda _address: None)
    monkeypatch.setattr(bench, "_measure_default", lambda *_: ({LATENCY: {"p50": float(next(count))}}, {}))
    options = bench.parse([str(argument) for argument in arguments])
    bench.check(options)
    return bench.run(options, Layout.of_environment())


def test_all_runs_are_written_and_appended(tmp_path, monkeypatch, capsys):
    file = tmp_path / "runs.json"
    assert measured(monkeypatch, "--runs", 3, "--output", file) == 0
    assert "2.000" in capsys.readouterr().out  # the median
    assert measured(monkeypatch, "--append", "--output", file) == 0
    found = bench_results.load(file, "--input")
    assert bench_rows.values(found.runs, bench_rows.ROWS[0]) == [1.0, 2.0, 3.0, 1.0]
    assert set(bench_machine.SAME_MACHINE) <= set(found.machine) and found.machine["cores"] >= 1
    assert all(run["load"]["load average"] >= 0.0 for run in found.runs)


def test_without_append_the_file_is_replaced(tmp_path, monkeypatch):
    file = tmp_path / "runs.json"
    for _ in range(2):
        assert measured(monkeypatch, "--output", file) == 0
    assert len(bench_results.load(file, "--input").runs) == 1


def test_saved_runs_are_compared_without_measuring(tmp_path, monkeypatch, capsys):
    old, new = tmp_path / "old.json", tmp_path / "new.json"
    bench_results.save(old, results([0.2] * 5))
    bench_results.save(new, results([0.9] * 5, begin=1.0))
    assert measured(monkeypatch, "--input", new, "--compare", old) == 0
    assert "WORSE" in capsys.readouterr().out


# --- Report -----------------------------------------------------------------------------------------------------------


def test_the_report_is_one_page_with_its_figures(tmp_path):
    new = results([0.4] * 5, begin=1.0)
    new.runs[-1]["samples"]["processes"] = {"command_server": [[0.5 * n, 4.0, 75.0] for n in range(20)]}
    bench_report.write(tmp_path / "report", Layout.of_environment(), new, results([0.2] * 5))
    page = (tmp_path / "report" / "bench.html").read_text()
    for title in ("Latencies", "Intervals", "Processor time", "Memory", "Compared with 0123456789ab", "Machine and load"):
        assert f"<h2>{title}</h2>" in page
    assert page.count("<svg") == 4 and "WORSE" in page
    assert "<img" not in page and "src=" not in page and "<script" not in page  # nothing outside the page


def test_rows_have_unique_titles():
    titles = [row.title for row in bench_rows.ROWS]
    assert len(titles) == len(set(titles))


