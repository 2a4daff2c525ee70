"""./ur build: forecast, progress, and a disk that is full or not writable."""

import errno
import os
from collections import namedtuple

import pytest
from ur_tools import build, build_times, console, disk, lock, main, system_packages, venv
from ur_tools.layout import Layout

Usage = namedtuple("Usage", "total used free")


class Clock:
    def __init__(self):
        self.now = 0.0

    def __call__(self):
        return self.now


@pytest.fixture
def layout(tmp_path, monkeypatch):
    """A checkout without any generated files."""
    monkeypatch.setattr("ur_tools.layout.STATE", tmp_path)
    return Layout("kilted")


@pytest.fixture
def times(tmp_path, monkeypatch):
    monkeypatch.setattr(build_times, "REFERENCE", {"messages": (300.0, 300.0), "driver": (100.0, 200.0)})
    return build_times.BuildTimes(tmp_path / "times.json", 2)


def test_durations_are_rounded():
    assert [build_times.rounded(seconds) for seconds in (0, 12, 55, 56, 89, 200)] == ["5 s", "15 s", "55 s", "1 min", "1 min", "3 min"]


# --- Forecast ---------------------------------------------------------------------------------------------------------


def test_the_first_forecast_is_the_reference_for_the_number_of_cores(tmp_path, times):
    for cores, seconds in ((2, 400.0), (1, 800.0), (4, 212.0), (64, 35.75)):  # more cores do not accelerate the configuration
        forecast = build_times.Forecast(build_times.BuildTimes(tmp_path / "times.json", cores), {"messages": True, "driver": True}, False,
                                        Clock())
        assert forecast.remaining() == pytest.approx(seconds)


def test_the_remaining_time_follows_the_measured_speed(times):
    clock = Clock()
    forecast = build_times.Forecast(times, {"messages": True}, False, clock)
    remaining = []
    for step in range(1, 11):  # ten times as fast as the reference
        clock.now += 3.0
        forecast.update(["messages"])
        forecast.step("messages", step * 40, 400)
        remaining.append(forecast.remaining())
    assert remaining == sorted(remaining, reverse=True)
    assert remaining[4] < 60.0  # 150 according to the reference
    assert remaining[-1] == 0.0


def test_the_total_number_of_files_is_an_estimate_until_all_packages_have_started(times):
    forecast = build_times.Forecast(times, {"messages": True, "driver": True}, False, Clock())
    forecast.step("messages", 30, 400)
    assert forecast.files() == (30, 400 + 130, False)
    assert "30 of about 530 files" in forecast.text()
    forecast.step("driver", 0, 50)
    assert forecast.files() == (30, 450, True)
    assert "30 of 450 files" in forecast.text()


def test_a_finished_package_is_recorded_with_its_share_of_the_time(tmp_path, times):
    clock = Clock()
    forecast = build_times.Forecast(times, {"messages": True, "driver": True}, False, clock)
    clock.now = 10.0
    forecast.update(["messages", "driver"])
    forecast.step("messages", 400, 400)
    forecast.finish("messages")
    clock.now = 16.0
    forecast.update(["driver"])
    forecast.step("driver", 50, 50)
    forecast.finish("driver")
    times.write()
    again = build_times.BuildTimes(tmp_path / "times.json", 2)
    assert again.first("messages", False) == (5.0, 400)
    assert again.first("driver", False) == (11.0, 50)
    assert again.first("driver", True) == (200.0, 0)  # never built with its tests


def test_a_rebuild_of_a_few_files_is_not_forecast_as_a_first_build(times):
    times.record("messages", False, 300.0, 400, is_first=True)
    forecast = build_times.Forecast(times, {"messages": False}, False, Clock())
    forecast.step("messages", 0, 4)
    assert forecast.remaining() < 5.0
    times.record("messages", False, 2.0, 4, is_first=False)
    assert times.first("messages", False) == (300.0, 400)
    assert times.last("messages", False) == (2.0, 4)


def test_a_damaged_file_of_times_is_ignored(tmp_path):
    (tmp_path / "times.json").write_text("{")
    assert build_times.BuildTimes(tmp_path / "times.json", 2).last("messages", False) is None


# --- First line ---------------------------------------------------------------------------------------------------------


def test_the_first_run_reports_downloads_packages_and_duration(layout):
    names = list(build.discover_with_interfaces())
    pending = build.Pending([], True, True, names, False)
    text = pending.text(build.Options(layout, jobs=2))
    megabytes = venv.MEGABYTES + 4
    packages = sum(first for first, _ in build_times.REFERENCE.values())
    minutes = build_times.span(venv.SECONDS + packages, venv.SECONDS + build_times.SLOW_HOST * packages)
    assert text == f"First run: downloads about {megabytes} MB, builds {len(names)} packages, about {minutes} on 2 cores"


def test_system_packages_have_a_share_of_the_duration(layout):
    layout.venv.mkdir(parents=True)
    text = build.Pending(["g++", "libboost-dev"], False, False, []).text(build.Options(layout, jobs=2))
    assert text == "Installs 2 system packages, about 1 min"


def test_the_estimate_is_one_duration_once_it_was_measured(layout):
    layout.venv.mkdir(parents=True)
    options = build.Options(layout, jobs=2)
    times = build._times(options)
    times.record("rcl_cxx", True, 90.0, 40, is_first=True)
    times.write()
    assert build.Pending([], False, False, ["rcl_cxx"], True).text(options) == "Builds 1 package, about 2 min on 2 cores"


def test_a_rebuild_reports_the_maximum_and_the_last_duration(layout):
    (layout.build / "rcl_cxx").mkdir(parents=True)
    (layout.build / "rcl_cxx" / ".ninja_log").write_text("")
    layout.venv.mkdir()
    options = build.Options(layout, jobs=2)
    times = build._times(options)
    times.record("rcl_cxx", False, 62.0, 40, is_first=True)
    times.record("rcl_cxx", False, 11.0, 3, is_first=False)
    times.write()
    text = build.Pending([], False, False, ["rcl_cxx"], False).text(options)
    assert text == "Builds 1 package, at most 1 min on 2 cores (last time 15 s)"


def test_there_is_no_output_when_everything_is_built(layout, monkeypatch, capsys):
    monkeypatch.setattr(build, "_pending", lambda *_: (build.Pending([], False, False, []), None))
    build.build(build.Options(layout))
    assert capsys.readouterr().out == ""


def test_an_unknown_package_is_rejected_before_the_setup(layout, monkeypatch):
    monkeypatch.setattr(system_packages, "ensure", lambda: pytest.fail("set up"))
    with pytest.raises(console.Failure, match="no package ur_simulater"):
        build.build(build.Options(layout, ["ur_simulater"]))


# --- Progress -----------------------------------------------------------------------------------------------------------


class Stamps:
    def __init__(self):
        self.written = []

    def write(self, name, tests):
        self.written.append((name, tests))


def test_the_progress_line_shows_packages_files_and_the_remaining_time(layout, times, monkeypatch):
    shown, stamps = [], Stamps()
    monkeypatch.setattr(console.Status, "show", lambda self, text: shown.append(text))
    output = layout.log / "colcon.txt"
    for name, text in (("messages", "[0/2] Re-checking\n[1/393] Building a\n[22/393] Building b\nwarning: c\n"),
                       ("driver", "-- Configuring\n[0/1] Re-running CMake...\n")):
        folder = layout.log / "latest_build" / name
        folder.mkdir(parents=True)
        (folder / "stdout.log").write_text(text)
    output.write_text("Starting >>> messages\nStarting >>> driver\n")
    forecast = build_times.Forecast(times, {"messages": True, "driver": True}, False, lambda: 0.0)
    progress = build.Progress(layout, output, stamps, forecast, False)
    progress.update()
    progress.update()
    assert shown[-1] == "22 of about 523 files, about 5 min left: messages 22/393, driver configuring"
    output.write_text("Starting >>> messages\nStarting >>> driver\nFinished <<< messages [3s]\nFailed   <<< driver [1s]\n")
    progress.end()
    assert stamps.written == [("messages", False)] and progress.done == {"messages"} and progress.failed == ["driver"]


# --- Disk ---------------------------------------------------------------------------------------------------------------


def test_a_first_run_without_disk_space_is_rejected_at_the_start(layout, tmp_path, monkeypatch):
    monkeypatch.setattr(disk.shutil, "disk_usage", lambda _: Usage(10**10, 10**10, 10**8))
    monkeypatch.setattr(build, "STATE", tmp_path)
    monkeypatch.setattr(build, "Lock", lambda name: lock.Lock(name, tmp_path))
    monkeypatch.setattr(system_packages, "ensure", lambda: pytest.fail("set up"))
    with pytest.raises(console.Failure, match="0.1 GB free, 2.5 GB needed"):
        build.build(build.Options(layout))


def test_what_was_never_built_needs_space(layout, monkeypatch):
    monkeypatch.setattr(venv, "is_current", lambda _: True)
    names = list(build.discover_with_interfaces())
    needed = []
    for built in (names[:0], names[:len(names) // 2], names):
        for name in built:
            (layout.build / name).mkdir(parents=True, exist_ok=True)
            (layout.build / name / ".ninja_log").touch()
        needed.append(build.needed_space(layout, names))
    assert needed == pytest.approx([1.6e9, 0.95e9, 0.3e9])
    variant = Layout(layout.ros, "thread")
    assert build.needed_space(variant, names) == pytest.approx(1.6e9)
    assert build.needed_space(variant, []) == pytest.approx(0.3e9)


def test_free_space_of_a_missing_folder_is_that_of_its_parent(tmp_path):
    assert disk.free(tmp_path / "not" / "there") == pytest.approx(disk.free(tmp_path), rel=0.5)


def test_errors_of_the_file_system_are_explained(monkeypatch, capsys):
    for number, text in ((errno.ENOSPC, "is full"), (errno.EROFS, "./ur writes its files to"), (errno.ENOENT, os.strerror(errno.ENOENT))):
        def fail(_options, number=number):
            raise OSError(number, os.strerror(number), "a_file")

        monkeypatch.setattr(main, "command_clean", fail)
        assert main.main(["clean"]) == 1
        assert text in capsys.readouterr().err
