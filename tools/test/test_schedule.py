"""The scheduling of parallel tests."""

import json

import pytest
from ur_tools import schedule
from ur_tools.layout import ROOT
from ur_tools.reference_times import REFERENCE
from ur_tools.schedule import Cost, Job, Schedule, Times


class Simulation:
    """Runs a schedule in simulated time. The duration of each job is given by its cost."""

    def __init__(self, jobs, cores=2, most=0):
        self.now = 0.0
        self.begins = {}
        self.peak = 0.0
        running = []
        timetable = Schedule(jobs, cores, most, lambda: self.now)
        while timetable:
            job = timetable.take()
            if job is not None:
                self.begins[job.what] = self.now
                running.append((self.now + job.cost.seconds, job))
                self.peak = max(self.peak, sum(one.cost.load for _, one in running))
                continue
            self.now, job = min(running, key=lambda entry: entry[0])
            running.remove((self.now, job))
            timetable.end(job)


def jobs(*costs, exclusive=(), background=(), last=()):
    return [Job(number, Cost(*cost), number in exclusive, number in (*background, *last), number in last)
            for number, cost in enumerate(costs)]


def test_the_longest_test_starts_first():
    assert Simulation(jobs((1.0, 1.0), (9.0, 1.0), (5.0, 1.0)), cores=1).begins == {1: 0.0, 2: 9.0, 0: 14.0}


def test_tests_with_low_load_run_in_parallel():
    simulation = Simulation(jobs(*[(10.0, 0.2 * schedule.BUSY)] * 8))
    assert simulation.now == 10.0


def test_the_cores_are_not_overcommitted():
    simulation = Simulation(jobs(*[(10.0, 0.5)] * 9, (3.0, 1.0), (2.0, 0.7)))
    assert simulation.peak <= 2 * schedule.BUSY


def test_a_test_with_more_load_than_cores_runs_alone():
    simulation = Simulation(jobs((5.0, 4.0), (9.0, 0.1)))
    assert sorted(simulation.begins.values()) == [0.0, 9.0]


def test_an_exclusive_test_runs_alone():
    simulation = Simulation(jobs((5.0, 0.1), (4.0, 0.1), (3.0, 0.1), exclusive=[1]))
    begin = simulation.begins[1]
    assert simulation.begins[0] + 5.0 <= begin and simulation.begins[2] in (0.0, begin + 4.0)


def test_short_tests_run_early_only_if_they_do_not_delay_a_long_one():
    # The second test requires the cores of the first. Tests that end before the first may run next to it.
    loads = [schedule.BUSY * load for load in (1.05, 1.26, 0.79, 0.63)]
    simulation = Simulation(jobs((10.0, loads[0]), (9.0, loads[1]), (4.0, loads[2]), (7.0, loads[3])))
    assert simulation.begins[1] == 10.0
    assert simulation.begins[3] == 0.0 and simulation.begins[2] >= 10.0


def test_the_number_of_tests_at_a_time_can_be_limited():
    assert Simulation(jobs(*[(1.0, 0.1)] * 6), most=1).now == pytest.approx(6.0)


def test_background_tests_run_beside_the_others_as_many_as_there_are_cores():
    simulation = Simulation(jobs((10.0, 1.8), (4.0, 1.0), (3.0, 1.0), (2.0, 1.0), background=[1, 2, 3]))
    assert simulation.begins == {0: 0.0, 1: 0.0, 2: 0.0, 3: 3.0}


def test_the_background_test_that_takes_longest_starts_first_even_if_it_mostly_waits():
    simulation = Simulation(jobs((10.0, 1.8), (4.0, 1.0), (9.0, 0.1), (3.0, 1.0), background=[1, 2, 3]))
    assert (simulation.begins[2], simulation.begins[1], simulation.begins[3]) == (0.0, 0.0, 4.0)


def test_no_background_test_runs_beside_an_exclusive_one():
    simulation = Simulation(jobs((5.0, 0.1), (6.0, 0.1), (3.0, 0.5), (4.0, 0.5), exclusive=[0], background=[2, 3]))
    begin = simulation.begins[0]
    assert all(simulation.begins[number] >= begin + 5.0 or simulation.begins[number] + duration <= begin
               for number, duration in ((1, 6.0), (2, 3.0), (3, 4.0)))


def test_the_last_tests_start_when_no_other_waits():
    simulation = Simulation(jobs((10.0, 1.8), (4.0, 1.8), (20.0, 1.0), (12.0, 1.0), last=[2], background=[3]))
    assert simulation.begins == {0: 0.0, 3: 0.0, 1: 10.0, 2: 10.0}


def test_background_tests_count_among_the_tests_at_a_time():
    assert Simulation(jobs((2.0, 0.1), (3.0, 0.1), background=[1]), most=1).now == pytest.approx(5.0)


def test_measured_times_are_stored_and_reference_times_are_the_default(tmp_path, monkeypatch):
    monkeypatch.setattr(schedule, "REFERENCE", {"known": (7.0, 0.3)})
    file = tmp_path / "durations.json"
    times = Times(file)
    assert times.cost("known", True) == Cost(7.0, 0.3) and times.cost("unknown", False) == schedule.UNKNOWN_PROGRAM
    times.record("known", 4.0, 2.0)
    times.write()
    assert Times(file).cost("known", True) == Cost(4.0, 0.5)


def test_an_unreadable_file_of_times_is_ignored(tmp_path, monkeypatch):
    monkeypatch.setattr(schedule, "REFERENCE", {"known": (7.0, 0.3)})
    for text in ("", "{", json.dumps({"known": 3.0})):
        (tmp_path / "durations.json").write_text(text)
        assert Times(tmp_path / "durations.json").cost("known", True) == Cost(7.0, 0.3), text


def test_every_reference_time_belongs_to_a_test_file_a_group_or_a_fuzz_target():
    for name in REFERENCE:
        package, _, file = name.partition(": ")
        if file.startswith("fuzz."):
            assert (ROOT / package / "fuzz" / f"fuzz_{file[5:]}.cpp").is_file(), name
            continue
        path = ROOT / package / "test" / f"{file}.py"
        assert path.is_file() or any(f'GROUP = "{path.stem}"' in other.read_text() for other in path.parent.glob("test_*.py")), name


def test_short_tests_run_beside_one_that_is_late():
    now = 0.0
    late, alone, short = jobs((10.0, 0.5), (9.0, 4.0), (8.0, 1.2))
    timetable = Schedule([late, alone, short], 2, clock=lambda: now)
    assert timetable.take() is late and timetable.take() is None  # the short one does not fit
    short.cost = Cost(8.0, 0.5)
    now = 15.0
    assert timetable.take() is None  # late by 5 s: the other one could begin in 5 s
    now = 20.0
    assert timetable.take() is short
