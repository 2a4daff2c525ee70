"""./ur chaos: a short run, and the detection of violations."""

import contextlib
import itertools
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import time
import types

ROOT = pathlib.Path(__file__).resolve().parents[2]
PATIENCE = float(os.environ.get("UR_TEST_PATIENCE", "1"))  # programs with a sanitizer are slower
ADDRESS = os.environ.get("UR_TEST_ADDRESS", "127.0.1.202")
for folder in ("chaos", "demo", "ur_ros_rtde_commands/test/system", "ur_ros_rtde_commands/test/every_command"):
    sys.path.insert(0, str(ROOT / folder))

import clients  # noqa: E402
import faults  # noqa: E402
import goals  # noqa: E402
import journal  # noqa: E402
import monitor  # noqa: E402
from stops.cases import LATE_THREADS  # noqa: E402
from ur_tools import chaos as command  # noqa: E402


@contextlib.contextmanager
def chaos(*arguments):
    """A run, which ends with the block."""
    env = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT / "tools"), os.environ.get("PYTHONPATH", "")])}
    with subprocess.Popen([sys.executable, "-m", "ur_tools.chaos", *arguments], env=env, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True) as process:
        try:
            yield process
        finally:
            process.send_signal(signal.SIGINT)  # does nothing after its end


def test_a_short_run_finds_no_violation():
    with chaos("--address", ADDRESS, "--faults", "20", "--seed", "3") as process:
        output, _ = process.communicate(timeout=240 * PATIENCE)
    assert process.returncode == 0, output
    assert "every goal had one result" in output
    assert re.search(r"fault +count +recovery p50 +max", output) and re.search(r"succeeded +\d+", output)


def driver_pid(process, log):
    """Returns the process id of the driver from the journal."""
    deadline = time.monotonic() + 60.0 * PATIENCE
    while True:
        found = re.search(r"the driver is process (\d+)", log.read_text() if log.exists() else "")
        if found:
            return int(found.group(1))
        assert time.monotonic() < deadline and process.poll() is None
        time.sleep(0.05)


def test_a_violation_ends_the_run_and_reports_seed_and_logs(tmp_path):
    with chaos("--address", ADDRESS, "--faults", "1000", "--seed", "11", "--log", str(tmp_path)) as process:
        os.kill(driver_pid(process, tmp_path / "journal.log"), signal.SIGKILL)
        output, _ = process.communicate(timeout=120 * PATIENCE)
    assert process.returncode == 1
    assert "VIOLATED: " in output and "seed 11" in output and str(tmp_path / "journal.log") in output
    assert "./ur chaos --faults 1000 --seed 11" in output


def test_options_out_of_range_are_rejected(run_without_build):
    for option in ("--faults=-1", "--clients=0", "--minutes=-2"):
        code, output = run_without_build("chaos", option)
        assert code == 2 and "cannot be negative" in output, output


def test_each_case_of_a_late_thread_can_be_repeated():
    assert command.LATE_THREADS == len(LATE_THREADS)


def test_an_address_that_is_a_name_is_rejected(run_without_build):
    for options in (("--faults", "1"), ("--stops", "3"), ("--case", "7")):
        code, output = run_without_build("chaos", *options, "--address", "localhost")
        assert code == 1 and "--address localhost: not an IPv4 address" in output, output


def draw(seed):
    mix = goals.Mix(random.Random(seed))
    sequence = faults.sequence(random.Random(seed))
    return [mix.next().text() for _ in range(50)], [fault.text() for fault in itertools.islice(sequence, 50)]


def test_the_same_seed_gives_the_same_goals_and_faults():
    assert draw(5) == draw(5)
    assert draw(5) != draw(6)


def test_random_goals_match_their_action_types():
    mix = goals.Mix(random.Random(1))
    for _ in range(300):
        mix.next().message()


def test_resources_that_grow_after_the_warm_up_are_reported():
    resources = monitor.ResourceMonitor(os.getpid())
    resources.samples = [(0.0, 50 + 2 * number, 20, 60.0) for number in range(40)]
    assert resources.find_growth() == ["descriptors grew from 80 to 110"]
    resources.samples = [(0.0, 50, 20, 60.0)] * 10 + [(0.0, 80, 30, 90.0)] * 30  # the warm-up
    assert resources.find_growth() == []
    resources.samples = [(0.0, 44, 27, 80.0)] * 3 + [(0.0, 24, 25, 80.0)] + [(0.0, 44, 27, 80.0)] * 6  # a reconnection
    assert resources.find_growth() == []


def test_a_short_run_makes_no_claim_about_resources():
    resources = monitor.ResourceMonitor(os.getpid())
    for samples, text in (([(0.0, 50, 20, 60.0)] * 7, "too short to compare"), ([(0.0, 50, 20, 60.0)] * 8, "did not grow"),
                          ([(0.0, 50 + 9 * number, 20, 60.0) for number in range(8)], "they grew")):
        resources.samples = samples
        assert text in resources.text()


def test_memory_is_not_compared_with_a_sanitizer():
    samples = [(0.0, 50, 20, 60.0 + 5.0 * number) for number in range(40)]
    for sanitizer, grown in ((False, ["memory (MB) grew from 135 to 210"]), (True, [])):
        resources = monitor.ResourceMonitor(os.getpid(), keeps_freed_memory=sanitizer)
        resources.samples = samples
        assert resources.find_growth() == grown


def test_a_motion_without_a_goal_is_a_violation(tmp_path, monkeypatch):
    for speed, idle, violated in ((0.5, 5.0, True), (0.5, 0.0, False), (0.0, 5.0, False)):
        gate, log = clients.Gate(), journal.Journal(tmp_path / "journal.log")
        monkeypatch.setattr(gate, "idle_for", lambda idle=idle: idle)
        arm_monitor = monitor.ArmMonitor(None, gate, log)
        arm_monitor._check_state({"actual": {"velocity": [0.0, -speed, 0.0, 0.0, 0.0, 0.0]}})
        assert bool(log.violation) == violated, (speed, idle)
        log.close()


def test_a_client_that_ends_early_is_a_violation(tmp_path, monkeypatch):
    class WrongMix:
        def next(self):
            raise KeyError(-1)

    monkeypatch.setattr(clients, "StatusTrackingClient", lambda name: types.SimpleNamespace(close=lambda: None))
    monkeypatch.setattr(clients, "Mix", lambda random: WrongMix())
    log = journal.Journal(tmp_path / "journal.log")
    sender = clients.GoalSender("client 0", None, clients.Gate(), log)
    sender.start()
    sender.join()
    assert "client 0: KeyError: -1" in log.violation
    log.close()


def test_results_of_all_types_are_described():
    assert clients.describe(types.SimpleNamespace(success=False, error_code=0, message="no")) == (False, "NONE: no")
    assert clients.describe(types.SimpleNamespace(error_code=-1, error_string="late", SUCCESSFUL=0)) == (False, "-1: late")
    assert clients.describe(types.SimpleNamespace(error_code=0, error_string="", SUCCESSFUL=0)) == (True, "0: ")
